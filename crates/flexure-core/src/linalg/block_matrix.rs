//! Square matrices of blocks.

use core::ops::{AddAssign, Mul, SubAssign};

use super::{Matrix, Vector};
use crate::scalar::{Float, Piecewise, Scalar};

/// A square matrix of `K` × `K` blocks of `N` × `N` numbers: what acts on a state of `K` vectors of `N`. Stored by rows of K N numbers, the `N` rows
/// of a row of blocks together. Large: what is computed with stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockMatrix<S, const N: usize, const K: usize>([[[[S; N]; K]; N]; K]);

impl<S: Scalar, const N: usize, const K: usize> BlockMatrix<S, N, K> {
    /// The zero matrix.
    pub const ZERO: Self = Self([[[[S::ZERO; N]; K]; N]; K]);

    #[inline]
    fn from_blocks(f: impl Fn(usize, usize) -> Matrix<S, N, N>) -> Self {
        let mut matrix = Self::ZERO;
        for row in 0..K {
            for column in 0..K {
                for (i, entries) in f(row, column).0.into_iter().enumerate() {
                    matrix.0[row][i][column] = entries;
                }
            }
        }
        matrix
    }

    /// The matrix of these columns of blocks.
    #[inline]
    pub fn from_columns(columns: &[[Matrix<S, N, N>; K]; K]) -> Self {
        Self::from_blocks(|row, column| columns[column][row])
    }

    /// The matrix whose block `(row, column)` is the product of these: of a column of blocks and a row of blocks.
    #[inline]
    pub fn outer(column: &[Matrix<S, N, N>; K], row: &[Matrix<S, N, N>; K]) -> Self {
        Self::from_blocks(|i, j| column[i] * row[j])
    }

    /// `diag(d)`.
    #[inline]
    pub fn diagonal(d: &[Vector<S, N>; K]) -> Self {
        Self::from_blocks(|row, column| if row == column { Matrix::diagonal(&d[row]) } else { Matrix::ZERO })
    }

    /// The identity.
    #[inline]
    pub fn identity() -> Self {
        Self::diagonal(&[Vector([S::ONE; N]); K])
    }

    /// Becomes `self · s`.
    #[inline]
    pub fn scale(&mut self, s: S) {
        for x in self.entries_mut() {
            *x *= s;
        }
    }

    /// Block `(row, column)`.
    #[inline]
    pub fn block(&self, row: usize, column: usize) -> Matrix<S, N, N> {
        Matrix::from_fn(|i, j| self.0[row][i][column][j])
    }

    /// The transpose.
    #[inline]
    pub fn transpose(&self) -> Self {
        Self::from_blocks(|row, column| self.block(column, row).transpose())
    }

    /// Becomes its symmetric part, ½ (A + Aᵀ).
    #[inline]
    pub fn symmetrize(&mut self) {
        let half = S::from_ratio(1, 2);
        for i in 0..K * N {
            for j in 0..i {
                let mean = (self.entry(i, j) + self.entry(j, i)) * half;
                *self.entry_mut(i, j) = mean;
                *self.entry_mut(j, i) = mean;
            }
        }
    }

    /// Whether a symmetric matrix is positive definite: all pivots of elimination are positive.
    #[inline]
    pub fn is_positive_definite(mut self) -> bool
    where
        S: Float,
    {
        (0..K * N).all(|p| {
            let (above, below) = self.0.as_flattened_mut().split_at_mut(p + 1);
            let row = above[p].as_flattened();
            for other in below {
                let other = other.as_flattened_mut();
                subtract(other, other[p] / row[p], row);
            }
            row[p] > S::ZERO
        })
    }

    /// The rows.
    #[inline]
    pub fn rows(&self) -> impl Iterator<Item = &[S]> {
        self.0.as_flattened().iter().map(|row| row.as_flattened())
    }

    /// The largest sum of magnitudes in a row: the norm that goes with the largest entry of a vector.
    #[inline]
    pub fn norm(&self) -> S
    where
        S: Piecewise,
    {
        let sum = |row: &[S]| row.iter().fold(S::ZERO, |sum, x| sum + x.abs());
        self.rows().map(sum).fold(S::ZERO, S::max)
    }

    /// The entries of the diagonal.
    #[inline]
    pub fn diagonal_entries(&self) -> impl Iterator<Item = S> {
        self.rows().enumerate().map(|(i, row)| row[i])
    }

    #[inline]
    fn entries_mut(&mut self) -> impl Iterator<Item = &mut S> {
        self.0.as_flattened_mut().as_flattened_mut().as_flattened_mut().iter_mut()
    }

    #[inline]
    fn entry(&self, i: usize, j: usize) -> S {
        self.0.as_flattened()[i].as_flattened()[j]
    }

    #[inline]
    fn entry_mut(&mut self, i: usize, j: usize) -> &mut S {
        &mut self.0.as_flattened_mut()[i].as_flattened_mut()[j]
    }
}

impl<S: Float, const N: usize, const K: usize> BlockMatrix<S, N, K> {
    /// Each B of `rhs` becomes A⁻¹ B, by elimination with partial pivoting, which leaves nothing of A. What a singular matrix gives is not finite.
    pub fn solve(&mut self, rhs: &mut [Self]) {
        for p in 0..K * N {
            let mut pivot = p;
            for i in p + 1..K * N {
                if self.entry(i, p).abs() > self.entry(pivot, p).abs() {
                    pivot = i;
                }
            }
            self.0.as_flattened_mut().swap(p, pivot);
            let (above, below) = self.0.as_flattened_mut().split_at_mut(p + 1);
            let row = above[p].as_flattened();
            for other in below {
                let (_, rest) = other.as_flattened_mut().split_at_mut(p);
                rest[0] = rest[0] / row[p];
                let factor = rest[0];
                subtract(&mut rest[1..], factor, &row[p + 1..]);
            }
            for b in &mut *rhs {
                b.0.as_flattened_mut().swap(p, pivot);
                let (above, below) = b.0.as_flattened_mut().split_at_mut(p + 1);
                for (i, other) in below.iter_mut().enumerate() {
                    subtract(other.as_flattened_mut(), self.entry(p + 1 + i, p), above[p].as_flattened());
                }
            }
        }
        for b in rhs {
            for p in (0..K * N).rev() {
                let (above, below) = b.0.as_flattened_mut().split_at_mut(p);
                let row = below[0].as_flattened_mut();
                for x in &mut *row {
                    *x = *x / self.entry(p, p);
                }
                for (i, other) in above.iter_mut().enumerate() {
                    subtract(other.as_flattened_mut(), self.entry(i, p), row);
                }
            }
        }
    }
}

/// `x` less `factor` times `y`.
#[inline]
fn subtract<S: Scalar>(x: &mut [S], factor: S, y: &[S]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= factor * *y;
    }
}

impl<S: Scalar, const N: usize, const K: usize> AddAssign<&Self> for BlockMatrix<S, N, K> {
    #[inline]
    fn add_assign(&mut self, rhs: &Self) {
        for (x, y) in self.entries_mut().zip(rhs.rows().flatten()) {
            *x += *y;
        }
    }
}

impl<S: Scalar, const N: usize, const K: usize> SubAssign<&Self> for BlockMatrix<S, N, K> {
    #[inline]
    fn sub_assign(&mut self, rhs: &Self) {
        for (x, y) in self.entries_mut().zip(rhs.rows().flatten()) {
            *x -= *y;
        }
    }
}

impl<S: Scalar, const N: usize, const K: usize> Mul for &BlockMatrix<S, N, K> {
    type Output = BlockMatrix<S, N, K>;
    #[inline]
    fn mul(self, rhs: Self) -> BlockMatrix<S, N, K> {
        let mut product = BlockMatrix::ZERO;
        for (sum, row) in product.0.as_flattened_mut().iter_mut().zip(self.rows()) {
            for (x, y) in row.iter().zip(rhs.rows()) {
                subtract(sum.as_flattened_mut(), -*x, y);
            }
        }
        product
    }
}

impl<S: Scalar, const N: usize, const K: usize> Mul<&[Matrix<S, N, N>; K]> for &BlockMatrix<S, N, K> {
    type Output = [Matrix<S, N, N>; K];
    #[inline]
    fn mul(self, x: &[Matrix<S, N, N>; K]) -> [Matrix<S, N, N>; K] {
        core::array::from_fn(|row| {
            x.iter().enumerate().fold(Matrix::ZERO, |sum, (column, x)| sum + self.block(row, column) * *x)
        })
    }
}
