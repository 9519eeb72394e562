//! Robots by their links, and the one place that turns a joint count read from a file into a type.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::robots::{Body, Pendulum, PlanarTwoLink, Tree};

use crate::io;

/// Something to do with a robot whose links and joint count are known only when it runs.
pub trait RobotVisitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output;
}

/// Largest joint count of a tree. To raise it, add the numbers to the list in [`with_robot`] and build again.
pub const MAX_JOINTS: usize = 10;

/// Calls `visitor` with the robot that `data` describes.
///
/// # Errors
/// For a tree with more than [`MAX_JOINTS`] moving joints.
pub fn with_robot<V: RobotVisitor>(data: &io::Robot, visitor: V) -> Result<V::Output, io::Problems> {
    macro_rules! tree {
        ($bodies:expr, $($n:literal)*) => {
            match $bodies.len() {
                $($n => visitor.visit(robot(data, tree::<$n>($bodies, data.gravity))),)*
                joints => return Err(too_many(data, joints)),
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
            visitor
                .visit::<_, 1>(robot(data, Pendulum { inertia: inertia + mass * com * com, weight_moment }))
        }
        io::Links::Tree(bodies) => tree!(bodies, 1 2 3 4 5 6 7 8 9 10),
    })
}

/// Whether this program is built for the robot's joint count.
///
/// # Errors
/// For a robot with more than [`MAX_JOINTS`] moving joints.
pub fn supported(data: &io::Robot) -> Result<(), io::Problems> {
    if data.joint_count() > MAX_JOINTS { Err(too_many(data, data.joint_count())) } else { Ok(()) }
}

fn too_many(data: &io::Robot, joints: usize) -> io::Problems {
    let message = format!(
        "robot {} has {joints} moving joints; this program is built for at most {MAX_JOINTS}",
        data.name
    );
    let help = "lock joints, or add the number to the list in registry/robot.rs and build again";
    data.places.problem("links", "joints", message, help).into()
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

fn tree<const N: usize>(bodies: &[Body], gravity: [f64; 3]) -> Tree<f64, N> {
    Tree::new(&std::array::from_fn(|i| bodies[i]), gravity).expect("the reader puts parents before children")
}

/// Per-joint data, whose length the reader has checked.
pub(crate) fn vector<const N: usize>(values: &[f64]) -> Vector<f64, N> {
    Vector::from_fn(|i| values[i])
}
