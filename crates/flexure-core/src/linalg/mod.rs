//! Small fixed-size linear algebra over any [`Scalar`](crate::scalar::Scalar), on the stack.
#![expect(
    clippy::indexing_slicing,
    reason = "indices run over const dimensions; the no-panic check covers them"
)]

mod blocks;
mod ldl;
mod matrix;
mod series;
mod vector;

pub use blocks::{eliminate, eliminate_each};
pub use ldl::Ldl;
pub use matrix::Matrix;
pub use vector::Vector;
