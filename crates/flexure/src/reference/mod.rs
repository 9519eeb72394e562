//! Reference trajectories that need memory: what an array on a controller cannot hold.
//!
//! The others are in [`flexure_core::reference`], with the trait.

mod clock;
mod samples;
mod septic;

pub use clock::when;
pub use samples::{Samples, SamplesError};
