//! Linear algebra of sizes known at run time: one dense matrix, one symmetric matrix, one eigenvalue solver, one
//! factorisation in floats and one elimination in intervals.
//!
//! | part | what for |
//! | --- | --- |
//! | [`Dense`] | any matrix: rows of numbers |
//! | [`Symmetric`] | quadratic forms: the lower triangle, and in intervals whether every matrix inside is positive definite |
//! | [`eigenvalues`], [`eigenvectors`] | Jacobi rotations, in place in the leading block of any storage |
//! | [`spectral_radius`], [`dominant_mode`] | eigenvalues of matrices that are not symmetric |
//! | [`exponential`] | of a matrix |
//! | [`lyapunov`], [`stein`] | A X + X Aᵀ + Q = 0, X = A X Aᵀ + Q |
//! | [`cholesky`], [`solved`], [`lower_inverse`], [`direction_of_descent`], [`weakest`] | floats that suggest, and never prove |
//!
//! Kernels that a robot's controller runs have sizes known at compile time and are in
//! [`flexure_core::linalg`]. `verify` has an elimination of its own: a checker shares nothing with what it checks but the
//! number type.

mod complex;
mod dense;
mod eigen;
mod exponential;
mod factor;
mod francis;
mod leading;
mod lyapunov;
mod spectrum;
mod symmetric;

pub use complex::Complex;
pub use dense::Dense;
pub use eigen::{eigenvalues, eigenvectors};
pub use exponential::exponential;
pub use factor::{cholesky, direction_of_descent, lower_inverse, solved, weakest};
pub use leading::Leading;
pub use lyapunov::{lyapunov, stein};
pub use spectrum::{Mode, dominant_mode, spectral_radius};
pub use symmetric::Symmetric;
