//! Spatial vectors and rigid-body inertias in link coordinates.
//!
//! Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapter 2: Plücker coordinates, angular part first.
#![expect(clippy::inline_always, reason = "measured: τ with two rates takes 0.68 of the time, the law 0.89")]

mod carried;
mod fixed;
mod inertia;
mod sym3;
mod twist;
mod vec3;

pub(crate) use carried::Carried;
pub(crate) use fixed::{Fixed, Rotation};
pub use inertia::{ArticulatedInertia, RigidInertia};
pub(crate) use sym3::Sym3;
pub use twist::{Twist, Wrench};
pub use vec3::Vec3;
