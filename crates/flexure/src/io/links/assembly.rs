//! From joints as a file gives them to moving bodies: fixed joints merged, what cannot move found.

use flexure_core::linalg::Vector;

use super::rigid::{Pose, Rigid};
use super::{Assembled, Body, JointKind, Links, MovingJoint};
use crate::io::site::Site;

/// A joint, with the body that it carries.
pub(in crate::io) struct Joint<'a> {
    /// For what is wrong with the joint as such.
    pub site: Site<'a>,
    /// Index of the joint that carries it, smaller than its own; none for the base.
    pub parent: Option<usize>,
    /// How it moves and about what; none if it is fixed.
    pub motion: Option<(MovingJoint, [f64; 3])>,
    /// Joint frame in the parent's frame.
    pub pose: Pose,
    pub body: Rigid,
}

/// Where the frame of a joint ended up: fixed in a moving body, or in the base.
#[derive(Clone, Copy)]
struct Placed {
    body: Option<usize>,
    pose: Pose,
}

/// A moving joint, and what fixed joints have added to its body.
struct Moving<'a> {
    site: Site<'a>,
    joint: MovingJoint,
    parent: Option<usize>,
    axis: [f64; 3],
    pose: Pose,
    rigid: Rigid,
}

/// The moving bodies of `joints`. None if some joint moves nothing, which is noted; `none_moves` says that none moves.
pub(in crate::io) fn assemble(joints: Vec<Joint<'_>>, none_moves: impl FnOnce()) -> Option<Assembled> {
    let mut placed: Vec<Placed> = Vec::new();
    let mut bodies: Vec<Moving<'_>> = Vec::new();
    for Joint { site, parent, motion, pose, body } in joints {
        let carrier = parent.map_or(Placed { body: None, pose: Pose::identity() }, |index| placed[index]);
        let pose = carrier.pose.then(&pose);
        if let Some((joint, axis)) = motion {
            placed.push(Placed { body: Some(bodies.len()), pose: Pose::identity() });
            bodies.push(Moving { site, joint, parent: carrier.body, axis, pose, rigid: body });
        } else {
            // What is fixed in the base never moves: only what is fixed in a body counts.
            if let Some(index) = carrier.body {
                bodies[index].rigid = bodies[index].rigid.joined(&body.seen_from(&pose));
            }
            placed.push(Placed { body: carrier.body, pose });
        }
    }
    if bodies.is_empty() {
        none_moves();
        return None;
    }
    check(&bodies)?;
    let links = Links::Tree(bodies.iter().map(Moving::body).collect());
    Some(Assembled { links, joints: bodies.into_iter().map(|moving| moving.joint).collect() })
}

/// Notes an error at each joint that moves no inertia, the outermost of several in a row: the mass matrix at q = 0 would
/// be singular.
fn check(bodies: &[Moving<'_>]) -> Option<()> {
    let mut composites: Vec<Rigid> = bodies.iter().map(|moving| moving.rigid).collect();
    let mut faulty = vec![false; bodies.len()];
    for (i, Moving { site, joint, parent, axis, pose, .. }) in bodies.iter().enumerate().rev() {
        let outer = composites[i];
        let axis = Vector(*axis);
        let (moved, unit) = match joint.kind {
            JointKind::Revolute => (axis.dot(&(outer.inertia_about(&Vector::ZERO) * axis)), "kg m^2"),
            JointKind::Prismatic => (outer.mass, "kg"),
        };
        let massless = moved <= 1e-15;
        if massless && !faulty[i] {
            let message = format!("{} moves {moved:e} {unit}, must be > 0", site.path);
            site.error(
                "massless",
                message,
                "give it, or what it carries, mass away from its axis or inertia",
            );
        }
        faulty[i] |= massless;
        if let Some(parent) = *parent {
            faulty[parent] |= faulty[i];
            composites[parent] = composites[parent].joined(&outer.seen_from(pose));
        }
    }
    faulty.iter().all(|faulty| !faulty).then_some(())
}

impl Moving<'_> {
    fn body(&self) -> Body {
        Body {
            parent: self.parent,
            kind: self.joint.kind,
            axis: self.axis,
            rotation: self.pose.rotation.0,
            translation: self.pose.translation.0,
            mass: self.rigid.mass,
            com: self.rigid.com.0,
            inertia: self.rigid.inertia.0,
        }
    }
}
