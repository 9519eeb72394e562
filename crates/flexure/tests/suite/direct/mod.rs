//! The direct engine of the prover: full matrix, no reduction by hand.

mod agreement;
mod arm;
mod other_laws;
mod rates;
mod soundness;
mod three_joints;
