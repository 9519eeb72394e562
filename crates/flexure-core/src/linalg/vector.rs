//! Vectors of `N` numbers.

use core::ops::{Add, AddAssign, Index, IndexMut, Neg, Sub, SubAssign};

use crate::array::{filled, mapped};
use crate::scalar::{Over, Scalar};

/// A column vector of `N` numbers.
///
/// A vector of constants also stands for a diagonal matrix: see [`diag_mul`](Self::diag_mul).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<S, const N: usize>(pub [S; N]);

impl<S: Copy, const N: usize> Vector<S, N> {
    /// The vector whose entry `i` is `f(i)`.
    #[inline]
    pub fn from_fn(f: impl FnMut(usize) -> S) -> Self {
        Self(filled(f))
    }

    /// Every entry through `f`.
    #[inline]
    pub fn map<T: Copy>(&self, f: impl FnMut(S) -> T) -> Vector<T, N> {
        Vector(mapped(&self.0, f))
    }

    /// The entries.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = S> + '_ {
        self.0.iter().copied()
    }
}

impl<S: Scalar, const N: usize> Vector<S, N> {
    /// The zero vector.
    pub const ZERO: Self = Self([S::ZERO; N]);

    /// Inner product.
    #[inline]
    pub fn dot(&self, other: &Self) -> S {
        let mut sum = S::ZERO;
        for i in 0..N {
            sum += self[i] * other[i];
        }
        sum
    }

    /// `self · s`.
    #[inline]
    pub fn scaled(&self, s: S) -> Self {
        self.map(|x| x * s)
    }

    /// `diag(self) x`, for a vector of constants that stands for a diagonal matrix.
    #[inline]
    pub fn diag_mul<T: Over<S>>(&self, x: &Vector<T, N>) -> Vector<T, N> {
        Vector::from_fn(|i| x[i].scale(self[i]))
    }

    /// Inner product of the constants `self` with numbers over them.
    #[inline]
    pub fn weigh<T: Over<S>>(&self, x: &Vector<T, N>) -> T {
        let mut sum = T::ZERO;
        for i in 0..N {
            sum += x[i].scale(self[i]);
        }
        sum
    }

    /// The vector of constants `self` as numbers of type `T`.
    #[inline]
    pub fn lift<T: Over<S>>(&self) -> Vector<T, N> {
        self.map(T::constant)
    }
}

impl<S, const N: usize> Index<usize> for Vector<S, N> {
    type Output = S;
    #[inline]
    fn index(&self, i: usize) -> &S {
        &self.0[i]
    }
}

impl<S, const N: usize> IndexMut<usize> for Vector<S, N> {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut S {
        &mut self.0[i]
    }
}

impl<S: Scalar, const N: usize> Add for Vector<S, N> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        Self::from_fn(|i| self[i] + rhs[i])
    }
}

impl<S: Scalar, const N: usize> Sub for Vector<S, N> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        Self::from_fn(|i| self[i] - rhs[i])
    }
}

impl<S: Scalar, const N: usize> Neg for Vector<S, N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<S: Scalar, const N: usize> AddAssign for Vector<S, N> {
    #[inline]
    fn add_assign(&mut self, rhs: Self) {
        *self = *self + rhs;
    }
}

impl<S: Scalar, const N: usize> SubAssign for Vector<S, N> {
    #[inline]
    fn sub_assign(&mut self, rhs: Self) {
        *self = *self - rhs;
    }
}
