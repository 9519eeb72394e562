//! Numbers that move in one direction.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Dual, Scalar};

/// `x` moving in the direction `dx`: what is computed from it has its derivative in that direction as gradient.
#[inline]
pub(super) fn moving<T: Scalar, const N: usize>(
    x: &Vector<T, N>,
    dx: &Vector<T, N>,
) -> Vector<Dual<T, 1>, N> {
    Vector::from_fn(|i| Dual { value: x[i], gradient: [dx[i]] })
}

/// The direction in which `x` moves.
#[inline]
pub(super) fn direction<T: Scalar, const N: usize>(x: &Vector<Dual<T, 1>, N>) -> Vector<T, N> {
    x.map(|x| x.gradient[0])
}

/// [`direction`] of every entry of a matrix.
#[inline]
pub(super) fn matrix_direction<T: Scalar, const R: usize, const K: usize>(
    x: &Matrix<Dual<T, 1>, R, K>,
) -> Matrix<T, R, K> {
    x.map(|x| x.gradient[0])
}

/// Time that passes.
#[inline]
pub(super) fn passing<T: Scalar>(t: T) -> Dual<T, 1> {
    Dual::variable(t, 0)
}
