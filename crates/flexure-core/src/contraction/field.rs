//! Matrices that depend on the state: weights Θ and metrics Π.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

/// A square matrix at every state: a weight Θ(x, t), or a metric Π(x, t), symmetric positive definite.
///
/// A [`Matrix`] of constants is one that is the same everywhere.
pub trait MatrixField<C: Scalar, const N: usize> {
    /// The matrix at `x` and `t`.
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N>;
}

impl<C: Scalar, const N: usize> MatrixField<C, N> for Matrix<C, N, N> {
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, _: &Vector<T, N>, _: T) -> Matrix<T, N, N> {
        self.map(T::constant)
    }
}

impl<C: Scalar, F: MatrixField<C, N>, const N: usize> MatrixField<C, N> for &F {
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        (*self).at(x, t)
    }
}
