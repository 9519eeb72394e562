//! Vectors and matrices put together from parts.
//!
//! The size of the whole is a const parameter of its own, checked when the function is compiled: sums of const parameters cannot be
//! written in types.

use crate::linalg::{Matrix, Vector};
use crate::scalar::Scalar;

/// (a, b), of `N = A + B` entries.
#[inline]
pub(super) fn stack<T: Copy, const A: usize, const B: usize, const N: usize>(
    a: &Vector<T, A>,
    b: &Vector<T, B>,
) -> Vector<T, N> {
    const { assert!(A + B == N, "the parts make up the whole") }
    Vector::from_fn(|i| if i < A { a[i] } else { b[i - A] })
}

/// The `A` entries of `x` from entry `start` on.
#[inline]
pub(super) fn part<T: Copy, const A: usize, const N: usize>(x: &Vector<T, N>, start: usize) -> Vector<T, A> {
    Vector::from_fn(|i| x[start + i])
}

/// [[a, b], [c, d]].
#[inline]
pub(super) fn block<
    T: Copy,
    const R1: usize,
    const R2: usize,
    const K1: usize,
    const K2: usize,
    const R: usize,
    const K: usize,
>(
    a: &Matrix<T, R1, K1>,
    b: &Matrix<T, R1, K2>,
    c: &Matrix<T, R2, K1>,
    d: &Matrix<T, R2, K2>,
) -> Matrix<T, R, K> {
    const { assert!(R1 + R2 == R && K1 + K2 == K, "the blocks make up the whole") }
    Matrix::from_fn(|i, j| match (i < R1, j < K1) {
        (true, true) => a[(i, j)],
        (true, false) => b[(i, j - K1)],
        (false, true) => c[(i - R1, j)],
        (false, false) => d[(i - R1, j - K1)],
    })
}

/// diag(a, d).
#[inline]
pub(super) fn block_diagonal<
    T: Scalar,
    const R1: usize,
    const R2: usize,
    const K1: usize,
    const K2: usize,
    const R: usize,
    const K: usize,
>(
    a: &Matrix<T, R1, K1>,
    d: &Matrix<T, R2, K2>,
) -> Matrix<T, R, K> {
    block(a, &Matrix::ZERO, &Matrix::ZERO, d)
}

/// Four vectors of `A` entries, one after the other.
#[inline]
pub(super) fn join<T: Copy, const A: usize, const N: usize>(parts: [Vector<T, A>; 4]) -> Vector<T, N> {
    const { assert!(4 * A == N, "the parts make up the whole") }
    let parts = Vector(parts);
    Vector::from_fn(|i| parts[i / A][i % A])
}

/// A vector in four parts of `A` entries.
#[inline]
pub(super) fn quarters<T: Copy, const A: usize, const N: usize>(x: &Vector<T, N>) -> [Vector<T, A>; 4] {
    const { assert!(4 * A == N, "the parts make up the whole") }
    core::array::from_fn(|k| part(x, k * A))
}

/// A matrix of 4 × 4 blocks of `A` rows.
#[inline]
pub(super) fn squares<T: Copy, const A: usize, const N: usize>(
    blocks: [[Matrix<T, A, A>; 4]; 4],
) -> Matrix<T, N, N> {
    const { assert!(4 * A == N, "the blocks make up the whole") }
    let blocks = Matrix(blocks);
    Matrix::from_fn(|i, j| blocks[(i / A, j / A)][(i % A, j % A)])
}

/// A block-diagonal matrix of four blocks of `A` rows.
#[inline]
pub(super) fn four<T: Scalar, const A: usize, const N: usize>(
    diagonal: [Matrix<T, A, A>; 4],
) -> Matrix<T, N, N> {
    let diagonal = Vector(diagonal);
    let blocks = Matrix::<_, 4, 4>::from_fn(|i, j| if i == j { diagonal[i] } else { Matrix::ZERO });
    squares(blocks.0)
}
