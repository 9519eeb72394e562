//! The linear shaping function.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// φ_2 = Λ q̃: the linear law. Keeps the pH-like structure when Π = Λ.
#[derive(Clone, Copy, Debug)]
pub struct Linear<C, const N: usize> {
    /// Diagonal of Λ [1/s].
    pub gain: Vector<C, N>,
}

impl<C: Scalar, const N: usize> Shaping<C, N> for Linear<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        self.gain.diag_mul(error)
    }
}
