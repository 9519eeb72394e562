//! Spatial vectors and rigid-body inertias in link coordinates.
//!
//! Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapter 2: Plücker coordinates, angular part first.

mod carried;
mod inertia;
mod twist;
mod vec3;

pub(crate) use carried::Carried;
pub use inertia::{ArticulatedInertia, RigidInertia};
pub use twist::{Twist, Wrench};
pub(crate) use vec3::Rotation;
pub use vec3::Vec3;
