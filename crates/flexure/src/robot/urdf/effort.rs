//! Torque limits where a URDF names none.

use crate::robot::{Body, JointKind};

/// Acceleration of gravity [m/s²].
const GRAVITY: f64 = 9.81;

/// The drive of an arm holds so many times what it carries: it also moves it, and a load.
const RESERVE: f64 = 2.0;

/// Smallest limit [N m or N]: of joints that carry next to nothing.
const LEAST: f64 = 0.1;

/// Where such a limit is from.
pub(super) const SOURCE: &str = "the URDF names no effort: twice what would hold the joint's bodies at their full reach against \
                                 gravity, at least 0.1";

/// A torque limit for the joint that carries `bodies[joint]` [N m], or a force limit [N] for one that slides: a multiple of what
/// holds all that it carries with every joint stretched out. Joints about vertical axes count alike: they accelerate the same
/// bodies.
pub(super) fn assumed(bodies: &[Body], joint: usize) -> f64 {
    let length = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    // How far from the joint the frame of a body can be, for those that it carries; parents come before children.
    let mut reach: Vec<Option<f64>> = vec![None; bodies.len()];
    let mut held = 0.0;
    for (i, body) in bodies.iter().enumerate().skip(joint) {
        reach[i] = if i == joint {
            Some(0.0)
        } else {
            let carried = body.parent.and_then(|parent| reach[parent]);
            carried.map(|reach| reach + length(&body.translation))
        };
        if let Some(reach) = reach[i] {
            held += match bodies[joint].kind {
                JointKind::Revolute => body.mass * GRAVITY * (reach + length(&body.com)),
                JointKind::Prismatic => body.mass * GRAVITY,
            };
        }
    }
    (RESERVE * held).max(LEAST)
}

#[cfg(test)]
mod tests {
    use super::{Body, GRAVITY, JointKind, RESERVE, assumed};

    fn body(parent: Option<usize>, kind: JointKind, distance: f64, mass: f64, com: f64) -> Body {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Body {
            parent,
            kind,
            axis: [0.0, 0.0, 1.0],
            rotation: identity,
            translation: [0.0, distance, 0.0],
            mass,
            com: [com, 0.0, 0.0],
            inertia: [[0.0; 3]; 3],
        }
    }

    /// Two bodies in a row, one beside them that the first joint does not carry.
    #[test]
    fn holds_what_it_carries() {
        let bodies = [
            body(None, JointKind::Revolute, 9.0, 2.0, 0.1),
            body(Some(0), JointKind::Prismatic, 0.5, 1.0, 0.2),
            body(None, JointKind::Revolute, 0.0, 50.0, 1.0),
        ];
        let expected = [2.0 * 0.1 + 1.0 * (0.5 + 0.2), 1.0, 50.0];
        for (joint, expected) in expected.iter().enumerate() {
            assert!((assumed(&bodies, joint) / (RESERVE * GRAVITY * expected) - 1.0).abs() < 1e-14);
        }
    }
}
