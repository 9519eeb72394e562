//! Proofs in floating point: contraction rates of the closed loop, with everything rounded outwards.
//!
//! Trusted base: the interval type, the core, and this module; it imports neither `sim` nor `io`.

pub mod direct;
pub mod matrix;
pub mod verdict;

pub use verdict::{Undecided, Verdict};
