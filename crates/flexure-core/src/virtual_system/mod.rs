//! The virtual system, its error coordinates and the structure of its closed loop: what the theorems speak about.
//!
//! The virtual system copies the state of the robot but keeps mass, Coriolis and damping matrices of the real motion.
//! Under the law its error x̃ = (q̃_l, q̃_m, σ_l, σ_m) obeys [`closed_loop`], whose variation is
//! δx̃̇ = (Ξ − Υ) Π δx̃ + Ψ δω with the matrices of [`Structure`].

mod dynamics;
mod error;
mod structure;

pub use dynamics::virtual_dynamics;
pub use error::{ErrorState, VelocityErrors, closed_loop, error_coordinates, velocity_error_rates};
pub use structure::{Blocks, Structure};
