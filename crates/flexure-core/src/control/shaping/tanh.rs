//! The shaping function that saturates.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// φ_1 = Λ tanh q̃, entry by entry: bounded, so that far errors do not ask for high speeds. Keeps the variational
/// structure; its contraction rate tends to 0 far from the reference. Paper, corollary controller-tanh.
#[derive(Clone, Copy, Debug)]
pub struct Tanh<C, const N: usize> {
    /// Diagonal of Λ [rad/s].
    pub gain: Vector<C, N>,
}

impl<C: Scalar, const N: usize> Shaping<C, N> for Tanh<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        self.gain.diag_mul(&error.map(T::tanh))
    }
}
