//! Matrices of `R` rows and `C` columns.

use core::ops::{Add, Index, IndexMut, Mul, Neg, Sub};

use super::{Ldl, Vector};
use crate::array::mapped;
use crate::scalar::{Over, Scalar};

/// A matrix of `R` rows and `C` columns, stored by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix<S, const R: usize, const C: usize>(pub [[S; C]; R]);

impl<S: Copy, const R: usize, const C: usize> Matrix<S, R, C> {
    /// The matrix whose entry `(i, j)` is `f(i, j)`.
    #[inline]
    pub fn from_fn(mut f: impl FnMut(usize, usize) -> S) -> Self {
        // Not by loops as the rest: with them the optimiser does not see that large ones cannot panic.
        Self(core::array::from_fn(|i| core::array::from_fn(|j| f(i, j))))
    }

    /// Every entry through `f`.
    #[inline]
    pub fn map<T: Copy>(&self, mut f: impl FnMut(S) -> T) -> Matrix<T, R, C> {
        Matrix(mapped(&self.0, |row| mapped(&row, &mut f)))
    }

    /// The transpose.
    #[inline]
    pub fn transpose(&self) -> Matrix<S, C, R> {
        Matrix::from_fn(|i, j| self[(j, i)])
    }

    /// Row `i`.
    #[inline]
    pub fn row(&self, i: usize) -> Vector<S, C> {
        Vector(self.0[i])
    }

    /// Column `j`.
    #[inline]
    pub fn column(&self, j: usize) -> Vector<S, R> {
        Vector::from_fn(|i| self[(i, j)])
    }
}

impl<S: Scalar, const R: usize, const C: usize> Matrix<S, R, C> {
    /// The zero matrix.
    pub const ZERO: Self = Self([[S::ZERO; C]; R]);

    /// `self · s`.
    #[inline]
    pub fn scaled(&self, s: S) -> Self {
        self.map(|x| x * s)
    }

    /// The matrix of constants `self` times numbers over them.
    #[inline]
    pub fn weigh<T: Over<S>>(&self, x: &Vector<T, C>) -> Vector<T, R> {
        Vector::from_fn(|i| self.row(i).weigh(x))
    }
}

impl<S: Scalar, const N: usize> Matrix<S, N, N> {
    /// The identity.
    #[inline]
    pub fn identity() -> Self {
        Self::from_fn(|i, j| if i == j { S::ONE } else { S::ZERO })
    }

    /// `diag(d)`.
    #[inline]
    pub fn diagonal(d: &Vector<S, N>) -> Self {
        Self::from_fn(|i, j| if i == j { d[i] } else { S::ZERO })
    }

    /// The factorisation `L D Lᵀ` of a symmetric matrix; only the lower triangle is read.
    #[inline]
    pub fn ldl(&self) -> Ldl<S, N> {
        Ldl::new(self)
    }
}

impl<S, const R: usize, const C: usize> Index<(usize, usize)> for Matrix<S, R, C> {
    type Output = S;
    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &S {
        &self.0[i][j]
    }
}

impl<S, const R: usize, const C: usize> IndexMut<(usize, usize)> for Matrix<S, R, C> {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut S {
        &mut self.0[i][j]
    }
}

impl<S: Scalar, const R: usize, const C: usize> Add for Matrix<S, R, C> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        Self::from_fn(|i, j| self[(i, j)] + rhs[(i, j)])
    }
}

impl<S: Scalar, const R: usize, const C: usize> Sub for Matrix<S, R, C> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        Self::from_fn(|i, j| self[(i, j)] - rhs[(i, j)])
    }
}

impl<S: Scalar, const R: usize, const C: usize> Neg for Matrix<S, R, C> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<S: Scalar, const R: usize, const C: usize> Mul<Vector<S, C>> for Matrix<S, R, C> {
    type Output = Vector<S, R>;
    #[inline]
    fn mul(self, x: Vector<S, C>) -> Vector<S, R> {
        Vector::from_fn(|i| self.row(i).dot(&x))
    }
}

impl<S: Scalar, const R: usize, const C: usize, const D: usize> Mul<Matrix<S, C, D>> for Matrix<S, R, C> {
    type Output = Matrix<S, R, D>;
    #[inline]
    fn mul(self, rhs: Matrix<S, C, D>) -> Matrix<S, R, D> {
        Matrix::from_fn(|i, j| self.row(i).dot(&rhs.column(j)))
    }
}
