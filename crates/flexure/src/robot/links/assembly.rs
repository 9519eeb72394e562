//! From joints as a file gives them to moving bodies: fixed joints merged, what cannot move found.
//!
//! What is checked is checked on floats, once. The bodies are assembled twice by the same code: in floats, and in intervals
//! that enclose what the decimals of the file make exactly.

use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::decimals::Decimals;
use crate::files::site::Site;
use crate::robot::links::rigid::{Pose, Rigid};
use crate::robot::links::written::{Axis, Frame, Hold, Matter};
use crate::robot::links::{Assembled, Body, JointKind, Links, MovingJoint};
use crate::robot::looks::Looks;
use crate::units;

/// A joint, with the body that it carries.
pub(crate) struct Joint<'a> {
    /// For what is wrong with the joint as such.
    pub site: Site<'a>,
    /// Index of the joint that carries it, smaller than its own; none for the base.
    pub parent: Option<usize>,
    pub motion: Motion,
    /// Joint frame in the parent's frame.
    pub frame: Frame,
    pub matter: Matter,
}

/// Whether a joint moves, and about or along what.
pub(crate) enum Motion {
    Fixed,
    Held(JointKind, Axis, Hold),
    Moving(MovingJoint, Axis),
}

/// Where the frame of a joint ended up: fixed in a moving body, or in the base.
#[derive(Clone, Copy)]
pub(crate) struct Fixed<S> {
    pub body: Option<usize>,
    pub pose: Pose<S>,
}

/// A moving joint, and what fixed joints have added to its body.
struct Moving<S> {
    /// Index of the joint among all joints of the file.
    joint: usize,
    kind: JointKind,
    parent: Option<usize>,
    axis: [S; 3],
    pose: Pose<S>,
    rigid: Rigid<S>,
}

/// The moving bodies of `joints`, whose numbers are `decimals`. None if some joint moves nothing, which is noted;
/// `none_moves` says that none moves.
pub(crate) fn assemble(
    joints: &[Joint<'_>],
    decimals: Decimals,
    none_moves: impl FnOnce(),
) -> Option<Assembled> {
    let (bodies, frames) = merged(joints, |x| x);
    if bodies.is_empty() {
        none_moves();
        return None;
    }
    check(joints, &bodies)?;
    let (enclosed, _) = merged(joints, |x| decimals.enclose(x));
    let moving = joints.iter().filter_map(|joint| match &joint.motion {
        Motion::Moving(moving, _) => Some(moving.clone()),
        Motion::Fixed | Motion::Held(..) => None,
    });
    Some(Assembled {
        links: Links::Tree(bodies.iter().map(Moving::body).collect()),
        enclosed: Links::Tree(enclosed.iter().map(Moving::body).collect()),
        joints: moving.collect(),
        frames,
        looks: Looks::default(),
    })
}

/// The moving bodies, with what is fixed in them, over the numbers that `number` makes of decimals, and where the frame of each joint is.
fn merged<S: Scalar>(joints: &[Joint<'_>], number: impl Fn(f64) -> S) -> (Vec<Moving<S>>, Vec<Fixed<S>>) {
    let mut placed: Vec<Fixed<S>> = Vec::new();
    let mut bodies: Vec<Moving<S>> = Vec::new();
    for (index, Joint { parent, motion, frame, matter, .. }) in joints.iter().enumerate() {
        let carrier = parent.map_or(Fixed { body: None, pose: Pose::identity() }, |index| placed[index]);
        let pose = carrier.pose.then(&frame.pose(&number));
        let rigid = matter.rigid(&number);
        let pose = match motion {
            Motion::Moving(MovingJoint { kind, .. }, axis) => {
                placed.push(Fixed { body: Some(bodies.len()), pose: Pose::identity() });
                let axis = axis.unit(&number);
                bodies.push(Moving { joint: index, kind: *kind, parent: carrier.body, axis, pose, rigid });
                continue;
            }
            Motion::Held(kind, axis, hold) => pose.then(&hold.pose(*kind, axis, &number)),
            Motion::Fixed => pose,
        };
        // What is fixed in the base never moves: only what is fixed in a body counts.
        if let Some(index) = carrier.body {
            bodies[index].rigid = bodies[index].rigid.joined(&rigid.seen_from(&pose));
        }
        placed.push(Fixed { body: carrier.body, pose });
    }
    (bodies, placed)
}

/// Notes an error at each joint that moves no inertia, the outermost of several in a row: the mass matrix at q = 0 would
/// be singular.
fn check(joints: &[Joint<'_>], bodies: &[Moving<f64>]) -> Option<()> {
    let mut composites: Vec<Rigid<f64>> = bodies.iter().map(|moving| moving.rigid).collect();
    let mut faulty = vec![false; bodies.len()];
    for (i, Moving { joint, kind, parent, axis, pose, .. }) in bodies.iter().enumerate().rev() {
        let outer = composites[i];
        let axis = Vector(*axis);
        let moved = match kind {
            JointKind::Revolute => axis.dot(&(outer.inertia_about(&Vector::ZERO) * axis)),
            JointKind::Prismatic => outer.mass(),
        };
        let massless = moved <= 1e-15;
        if massless && !faulty[i] {
            let site = &joints[*joint].site;
            let message =
                format!("{} moves {moved:e} {}, must be > 0", site.path, units::INERTIA.of(*kind).plain);
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

impl<S: Scalar> Moving<S> {
    fn body(&self) -> Body<S> {
        Body {
            parent: self.parent,
            kind: self.kind,
            axis: self.axis,
            rotation: self.pose.rotation.0,
            translation: self.pose.translation.0,
            mass: self.rigid.mass(),
            com: self.rigid.weight.map_or([S::ZERO; 3], |weight| weight.com.0),
            inertia: self.rigid.inertia.0,
        }
    }
}
