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

/// The weight Θ of a metric, upper triangular with ΘᵀΘ = Π: the Riemannian length √(δxᵀ Π δx) is the 2-norm of Θ δx.
#[derive(Clone, Copy, Debug)]
pub struct Root<F>(pub F);

impl<C: Scalar, F: MatrixField<C, N>, const N: usize> MatrixField<C, N> for Root<F> {
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        self.0.at(x, t).ldl().root()
    }
}
