//! Proofs in floating point: contraction rates of the closed loop, with everything rounded outwards.
//!
//! Two engines. [`structural`] uses that the coupling between the blocks cancels ([`coupling`]) and needs finitely many small
//! matrices; its proof is a [`certificate`] that others can check. The direct one knows nothing of that: it takes the whole
//! inequality from the closed loop's Jacobian, by branch and bound.
//!

//! Trusted base: the interval type, the core, [`Symmetric`](crate::linalg::Symmetric) and this module; it knows of no files and no
//! simulation.

pub mod certificate;
pub mod chain;
pub mod coupling;
pub mod direct;
pub mod envelope;
pub mod momentum;
pub mod number;
pub mod position;
pub mod rate;
pub mod region;
pub mod reserve;
pub mod sampled_data;
#[cfg(test)]
mod schema;
pub mod shaping;
pub mod stretched;
pub mod structural;
pub mod structure;
pub mod verdict;
pub mod witness;

pub use certificate::Certificate;
pub use number::Number;
pub use region::RequestedRegion;
pub use reserve::Reserve;
pub use structural::{Proposition, certify};
pub use verdict::{Undecided, Verdict};
pub use witness::{RateWitness, WitnessState};
