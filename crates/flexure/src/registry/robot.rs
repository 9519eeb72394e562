//! Robots by their links, and the one place that turns a joint count read from a file into a type.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::robots::{Body, JointKind, Pendulum, PlanarTwoLink, Tree};
use thiserror::Error;

use crate::io;

/// Something to do with a robot whose links and joint count are known only when it runs.
pub trait RobotVisitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output;
}

/// More joints than this program was built for.
#[derive(Clone, Debug, Error)]
#[error("robot {robot} has {joints} moving joints; this program is built for at most {MAX_JOINTS}")]
pub struct TooManyJoints {
    /// Name of the robot.
    pub robot: String,
    /// Its moving joints.
    pub joints: usize,
}

/// Largest joint count of a tree. To raise it, add the numbers to the list in [`with_robot`] and build again.
pub const MAX_JOINTS: usize = 8;

/// Calls `visitor` with the robot that `data` describes.
///
/// # Errors
/// [`TooManyJoints`] for a tree with more than [`MAX_JOINTS`] moving joints.
pub fn with_robot<V: RobotVisitor>(data: &io::Robot, visitor: V) -> Result<V::Output, TooManyJoints> {
    macro_rules! tree {
        ($bodies:expr, $($n:literal)*) => {
            match $bodies.len() {
                $($n => visitor.visit(robot(data, tree::<$n>($bodies, data.gravity))),)*
                joints => return Err(TooManyJoints { robot: data.name.clone(), joints }),
            }
        };
    }
    Ok(match &data.links {
        io::Links::PlanarTwoLink { mass, length, com, inertia } => {
            visitor.visit::<_, 2>(robot(data, PlanarTwoLink::new(*mass, length[0], *com, *inertia)))
        }
        io::Links::Pendulum { mass, com, inertia } => {
            let [x, y, z] = data.gravity;
            let weight_moment = mass * com * (x * x + y * y + z * z).sqrt();
            visitor.visit::<_, 1>(robot(data, Pendulum { inertia: inertia + mass * com * com, weight_moment }))
        }
        io::Links::Tree(bodies) => tree!(bodies, 1 2 3 4 5 6 7 8),
    })
}

fn robot<L, const N: usize>(data: &io::Robot, links: L) -> Fjr<f64, L, N> {
    Fjr {
        links,
        motor_inertia: vector(&data.motor_inertia),
        stiffness: vector(&data.stiffness),
        link_damping: vector(&data.link_damping),
        motor_damping: vector(&data.motor_damping),
    }
}

fn tree<const N: usize>(bodies: &[io::Body], gravity: [f64; 3]) -> Tree<f64, N> {
    let bodies = std::array::from_fn(|i| {
        let body = &bodies[i];
        Body {
            parent: body.parent,
            kind: match body.kind {
                io::JointKind::Revolute => JointKind::Revolute,
                io::JointKind::Prismatic => JointKind::Prismatic,
            },
            axis: body.axis,
            rotation: body.rotation,
            translation: body.translation,
            mass: body.mass,
            com: body.com,
            inertia: body.inertia,
        }
    });
    Tree::new(&bodies, gravity).expect("the reader puts parents before children")
}

/// Per-joint data, whose length the reader has checked.
pub(crate) fn vector<const N: usize>(values: &[f64]) -> Vector<f64, N> {
    Vector::from_fn(|i| values[i])
}
