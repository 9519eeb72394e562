//! A tree of joints: `kind = "tree"`.

use std::collections::HashMap;

use flexure_core::linalg::Vector;

use super::joint::{self, Joint};
use super::rigid::{Pose, Rigid};
use super::{Body, JointKind, Links};
use crate::io::suggest;
use crate::io::table::Table;

/// Where the frame of a joint ended up: fixed in a moving body, or in the base.
struct Placed {
    body: Option<usize>,
    pose: Pose,
}

/// The moving bodies so far, and what fixed joints have added to them.
#[derive(Default)]
struct Assembly<'a> {
    bodies: Vec<(Body, Rigid, Pose)>,
    sources: Vec<Joint<'a>>,
    placed: HashMap<&'a str, Placed>,
}

pub(super) fn read(table: &Table<'_>) -> Option<Links> {
    let fields = table.required("joint", "[[links.joint]], once for each joint")?.tables()?;
    let joints: Vec<_> = fields.iter().map(joint::read).collect();
    let mut assembly = Assembly::default();
    for joint in joints.into_iter().collect::<Option<Vec<_>>>()? {
        assembly.add(joint)?;
    }
    if assembly.bodies.is_empty() {
        table.error(
            "immovable",
            "links.joint: no joint moves",
            "at least one joint must be revolute or prismatic",
        );
        return None;
    }
    assembly.check()?;
    Some(Links::Tree(assembly.bodies.into_iter().map(|(body, rigid, _)| carrying(body, &rigid)).collect()))
}

impl<'a> Assembly<'a> {
    fn add(&mut self, joint: Joint<'a>) -> Option<()> {
        let (parent, outer) = match &joint.parent {
            None => (None, Pose::identity()),
            Some((name, field)) => {
                let Some(placed) = self.placed.get(name) else {
                    let message =
                        format!("{} is {}, which is no joint above", field.path, suggest::quoted(name));
                    let mut known: Vec<_> = self.placed.keys().copied().collect();
                    known.sort_unstable();
                    let help = suggest::hint(name, known.into_iter());
                    field.error("parent", message, format!("parents stand before their children; {help}"));
                    return None;
                };
                (placed.body, placed.pose)
            }
        };
        let pose = outer.then(&joint.pose);
        let placed = if let Some((kind, axis)) = joint.motion {
            self.bodies.push((moving(parent, kind, axis, &pose), joint.body, pose));
            Placed { body: Some(self.bodies.len() - 1), pose: Pose::identity() }
        } else {
            // What is fixed in the base never moves: only what is fixed in a body counts.
            if let Some((_, rigid, _)) = parent.and_then(|index| self.bodies.get_mut(index)) {
                *rigid = rigid.joined(&joint.body.seen_from(&pose));
            }
            Placed { body: parent, pose }
        };
        if self.placed.insert(joint.name, placed).is_some() {
            let message =
                format!("{}: a second joint is called {}", joint.field.path, suggest::quoted(joint.name));
            joint.field.error("duplicate", message, "every joint has a name of its own");
            return None;
        }
        if joint.motion.is_some() {
            self.sources.push(joint);
        }
        Some(())
    }

    /// Notes an error at each joint that moves no inertia: the mass matrix at q = 0 would be singular.
    fn check(&self) -> Option<()> {
        let mut composites: Vec<Rigid> = self.bodies.iter().map(|(_, rigid, _)| *rigid).collect();
        let mut sound = Some(());
        for (i, ((body, _, pose), joint)) in self.bodies.iter().zip(&self.sources).enumerate().rev() {
            let Some(outer) = composites.get(i).copied() else { continue };
            let axis = Vector(body.axis);
            let (moved, unit) = match body.kind {
                JointKind::Revolute => (axis.dot(&(outer.inertia_about(&Vector::ZERO) * axis)), "kg m^2"),
                JointKind::Prismatic => (outer.mass, "kg"),
            };
            if moved <= 1e-15 {
                let message =
                    format!("{} ({}) moves {moved:e} {unit}, must be > 0", joint.field.path, joint.name);
                joint.field.error(
                    "massless",
                    message,
                    "give it, or what it carries, mass away from its axis or inertia",
                );
                sound = None;
            }
            if let Some(parent) = body.parent.and_then(|index| composites.get_mut(index)) {
                *parent = parent.joined(&outer.seen_from(pose));
            }
        }
        sound
    }
}

/// The moving joint, with a body that nothing is known of yet.
fn moving(parent: Option<usize>, kind: JointKind, axis: [f64; 3], pose: &Pose) -> Body {
    let (rotation, translation) = (pose.rotation.0, pose.translation.0);
    Body { parent, kind, axis, rotation, translation, mass: 0.0, com: [0.0; 3], inertia: [[0.0; 3]; 3] }
}

fn carrying(body: Body, rigid: &Rigid) -> Body {
    Body { mass: rigid.mass, com: rigid.com.0, inertia: rigid.inertia.0, ..body }
}
