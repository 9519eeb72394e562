//! Quadratic forms over any number, and the two that a contraction rate compares.

use flexure_core::scalar::{Interval, Scalar};

use crate::prove::engine::matrix::Symmetric;

/// A quadratic form: the lower triangle of its symmetric matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Form<T> {
    size: usize,
    lower: Vec<T>,
}

impl<T: Copy> Form<T> {
    /// The form whose entries on and below the diagonal are `entry(i, j)`, `j ≤ i`.
    pub fn from_fn(size: usize, mut entry: impl FnMut(usize, usize) -> T) -> Self {
        let lower = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        Self { size, lower }
    }

    /// Number of variables.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Entry (i, j), whichever triangle it is in.
    pub fn at(&self, i: usize, j: usize) -> T {
        let (i, j) = if i < j { (j, i) } else { (i, j) };
        self.lower[i * (i + 1) / 2 + j]
    }
}

impl<T: Scalar> Form<T> {
    /// xᵀ A x.
    pub fn value(&self, x: &[T]) -> T {
        let mut sum = T::ZERO;
        for i in 0..self.size {
            sum += self.at(i, i) * x[i].square();
            for j in 0..i {
                let product = self.at(i, j) * x[i] * x[j];
                sum += product + product;
            }
        }
        sum
    }
}

impl Form<Interval> {
    /// The same entries, as the type that decides definiteness.
    pub fn symmetric(&self) -> Symmetric {
        Symmetric::from_fn(self.size, |i, j| self.at(i, j))
    }
}

/// How a quadratic storage W = ½ δzᵀ `weight` δz balances: Ẇ = −δzᵀ `dissipation` δz.
///
/// √W decays at least at the rate β where `dissipation − β weight` and `weight` are positive definite.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance<T> {
    /// What is lost.
    pub dissipation: Form<T>,
    /// The metric P.
    pub weight: Form<T>,
}
