//! Robots: closed forms, and trees of joints built from data.

mod pendulum;
mod planar_two_link;
mod tree;

pub use pendulum::Pendulum;
pub use planar_two_link::PlanarTwoLink;
pub use tree::{Articulated, Body, Dense, JointKind, Tree, TreeFactor};
