//! Pivot-free `L D Lᵀ`: the same arithmetic for every symmetric positive definite matrix, so it runs on intervals,
//! lanes and jets as it runs on `f64`.

use core::cmp::Ordering;

use super::{Matrix, Vector};
use crate::scalar::Scalar;

/// The factorisation `A = L D Lᵀ` of a symmetric positive definite matrix.
///
/// Nothing is tested on the way: a matrix that is not positive definite shows in [`pivots`](Self::pivots).
#[derive(Clone, Copy, Debug)]
pub struct Ldl<S, const N: usize> {
    /// Unit lower triangular; the diagonal and what is above it are not used.
    lower: Matrix<S, N, N>,
    pivots: Vector<S, N>,
    reciprocals: Vector<S, N>,
}

impl<S: Scalar, const N: usize> Ldl<S, N> {
    /// Factorises `a`, reading its lower triangle.
    #[inline]
    pub fn new(a: &Matrix<S, N, N>) -> Self {
        let mut lower = Matrix::ZERO;
        let mut pivots = Vector::ZERO;
        let mut reciprocals = Vector::ZERO;
        for j in 0..N {
            // Row j of L D and its pivot, from the rows before it.
            let mut row = [S::ZERO; N];
            let mut pivot = a[(j, j)];
            for k in 0..j {
                let l: S = lower[(j, k)];
                pivot -= l.square() * pivots[k];
                row[k] = l * pivots[k];
            }
            pivots[j] = pivot;
            reciprocals[j] = pivot.recip();
            for i in j + 1..N {
                let mut sum = a[(i, j)];
                for k in 0..j {
                    sum -= lower[(i, k)] * row[k];
                }
                lower[(i, j)] = sum * reciprocals[j];
            }
        }
        Self { lower, pivots, reciprocals }
    }

    /// The diagonal of D: all positive if and only if the matrix is positive definite.
    #[inline]
    pub fn pivots(&self) -> &Vector<S, N> {
        &self.pivots
    }

    /// The upper triangular matrix `R = √D Lᵀ`, with `A = Rᵀ R`.
    #[inline]
    pub fn root(&self) -> Matrix<S, N, N> {
        Matrix::from_fn(|i, j| match i.cmp(&j) {
            Ordering::Less => self.pivots[i].sqrt() * self.lower[(j, i)],
            Ordering::Equal => self.pivots[i].sqrt(),
            Ordering::Greater => S::ZERO,
        })
    }

    /// `A⁻¹ b`, by substitution with L, D and Lᵀ.
    #[inline]
    pub fn solve(&self, b: &Vector<S, N>) -> Vector<S, N> {
        let mut x = *b;
        for i in 0..N {
            for k in 0..i {
                x.0[i] -= self.lower[(i, k)] * x.0[k];
            }
        }
        for i in (0..N).rev() {
            x[i] *= self.reciprocals[i];
            for k in i + 1..N {
                x.0[i] -= self.lower[(k, i)] * x.0[k];
            }
        }
        x
    }
}
