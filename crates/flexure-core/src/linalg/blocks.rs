//! Linear systems in blocks.
#![expect(clippy::needless_range_loop, reason = "rows and columns of one matrix at a time")]

use super::{Matrix, Vector};
use crate::scalar::Scalar;

/// A⁻¹ b for a matrix of `K` × `K` blocks, by elimination without pivoting: for matrices near enough to the identity, or dominated by their
/// diagonal, such as those of implicit steps.
#[inline]
pub fn eliminate<S: Scalar, const N: usize, const K: usize>(
    mut a: [[Matrix<S, N, N>; K]; K],
    mut b: [Vector<S, N>; K],
) -> [Vector<S, N>; K] {
    for p in 0..K {
        for i in 0..N {
            let reciprocal = a[p][p][(i, i)].recip();
            // Row i of block row p over its pivot, taken from every row below.
            for row in p..K {
                let from = if row == p { i + 1 } else { 0 };
                for j in from..N {
                    let factor = a[row][p][(j, i)] * reciprocal;
                    for column in p..K {
                        let first = if column == p { i } else { 0 };
                        for k in first..N {
                            let entry = a[p][column][(i, k)];
                            a[row][column][(j, k)] -= factor * entry;
                        }
                    }
                    let entry = b[p][i];
                    b[row][j] -= factor * entry;
                }
            }
        }
    }
    for p in (0..K).rev() {
        for i in (0..N).rev() {
            let mut sum = b[p][i];
            for k in i + 1..N {
                sum -= a[p][p][(i, k)] * b[p][k];
            }
            for column in p + 1..K {
                for k in 0..N {
                    sum -= a[p][column][(i, k)] * b[column][k];
                }
            }
            b[p][i] = sum / a[p][p][(i, i)];
        }
    }
    b
}

/// A⁻¹ b for `N` systems of `K` equations side by side: entry i of every vector is of system i. Without pivoting, as [`eliminate`].
#[inline]
pub fn eliminate_each<S: Scalar, const N: usize, const K: usize>(
    mut a: [[Vector<S, N>; K]; K],
    mut b: [Vector<S, N>; K],
) -> [Vector<S, N>; K] {
    let product = |x: &Vector<S, N>, y: &Vector<S, N>| Vector::from_fn(|i| x[i] * y[i]);
    for p in 0..K {
        let reciprocal = a[p][p].map(S::recip);
        for row in p + 1..K {
            let factor = product(&a[row][p], &reciprocal);
            for column in p..K {
                let entry = product(&factor, &a[p][column]);
                a[row][column] -= entry;
            }
            let entry = product(&factor, &b[p]);
            b[row] -= entry;
        }
    }
    for p in (0..K).rev() {
        for column in p + 1..K {
            let entry = product(&a[p][column], &b[column]);
            b[p] -= entry;
        }
        b[p] = Vector::from_fn(|i| b[p][i] / a[p][p][i]);
    }
    b
}
