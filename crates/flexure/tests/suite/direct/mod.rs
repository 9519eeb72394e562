//! The direct engine of the prover: the full matrix.

mod agreement;
mod arm;
mod other_laws;
mod rates;
mod soundness;
mod three_joints;
