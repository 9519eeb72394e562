//! Vectors of Taylor series from and to plain derivatives.

use super::Vector;
use crate::array::filled;
use crate::scalar::{Jet, Scalar};

impl<S: Scalar, const K: usize, const N: usize> Vector<Jet<S, K>, N> {
    /// The series with the derivatives `[x, ẋ, ẍ, …]`.
    #[inline]
    pub fn from_derivatives(derivatives: &[Vector<S, N>; K]) -> Self {
        Self::from_fn(|i| Jet::from_derivatives(derivatives.map(|x| x[i])))
    }

    /// The derivatives `[x, ẋ, ẍ, …]` of the series.
    #[inline]
    pub fn derivatives(&self) -> [Vector<S, N>; K] {
        filled(|k| self.map(|x| x.derivative(k)))
    }
}
