//! Ellipsoids of errors, and what lies between two of them.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, lower_inverse};
use crate::prove::engine::envelope::tube::{Tube, ball};

/// The errors L y with |y| ≤ 1, L lower triangular with a positive diagonal: x̃ᵀ X⁻¹ x̃ ≤ 1 with X = L Lᵀ.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// L in rad and rad/s, rows in the order q̃_l, q̃_m, s_l, s_m.
    pub lower: Dense<f64>,
}

/// All errors on the way along ellipsoids: between two of them X is a mean of theirs.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage(pub Vec<Shape>);

/// The times of part `k` of `parts` of `time`, evenly spaced.
pub fn part(time: Interval, k: usize, parts: usize) -> Interval {
    let at = |k: usize| {
        if k == parts { time.hi() } else { time.lo() + (time.hi() - time.lo()) * (k as f64 / parts as f64) }
    };
    Interval::new(at(k), at(k + 1)).unwrap_or(Interval::ENTIRE)
}

impl Shape {
    /// As large in every direction, times `factor`.
    pub fn times(&self, factor: f64) -> Self {
        Self { lower: self.lower.scaled(factor) }
    }

    /// Number of errors.
    pub fn size(&self) -> usize {
        self.lower.columns()
    }

    /// √X_ii, from above.
    pub fn extents(&self) -> Vec<f64> {
        let square =
            |row: &[f64]| row.iter().fold(Interval::ZERO, |sum, &x| sum + Interval::point(x).square());
        self.lower.rows().map(|row| square(row).sqrt().hi()).collect()
    }

    /// X.
    pub fn square(&self) -> Symmetric<Interval> {
        square(&self.lower)
    }

    /// Whether it is known to lie in `other`.
    pub fn lies_in(&self, other: &Self) -> bool {
        self.widened_lies_in(Interval::ONE, other)
    }

    /// Whether what is `times` as wide in every direction is known to lie in `other`.
    pub fn widened_lies_in(&self, times: Interval, other: &Self) -> bool {
        let root = lower_inverse(&other.lower);
        let difference = other.square().minus(&self.square(), times.square());
        congruent(&root, &difference).smallest_pivot() > 0.0
    }

    /// Whether the error `x` is known to lie in it: 1 − xᵀ X⁻¹ x > 0, the last pivot of X bordered by x and 1.
    pub fn holds(&self, x: &[Interval]) -> bool {
        let (n, square, root) = (self.size(), self.square(), lower_inverse(&self.lower));
        let scaled = congruent(&root, &square);
        let row =
            |i: usize| (0..=i).fold(Interval::ZERO, |sum, k| sum + Interval::point(root[(i, k)]) * x[k]);
        let bordered = Symmetric::from_fn(n + 1, |i, j| match (i, j) {
            (i, j) if i == n && j == n => Interval::ONE,
            (i, j) if i == n => row(j),
            (i, j) => scaled.at(i, j),
        });
        bordered.smallest_pivot() > 0.0
    }

    /// gᵀ X g, from above.
    fn reach_square(&self, gradient: &[Interval]) -> Interval {
        let n = self.size();
        let column = |k: usize| {
            let sum = (k..n).fold(Interval::ZERO, |sum, i| {
                if self.lower[(i, k)] == 0.0 {
                    sum
                } else {
                    sum + gradient[i] * Interval::point(self.lower[(i, k)])
                }
            });
            sum.square()
        };
        (0..n).map(column).fold(Interval::ZERO, |a, b| a + b)
    }
}

impl Tube for Passage {
    fn errors(&self) -> Vec<Interval> {
        let larger = |a: Vec<f64>, b: Vec<f64>| a.into_iter().zip(b).map(|(a, b)| a.max(b)).collect();
        let largest = self.0.iter().map(Shape::extents).reduce(larger).unwrap_or_default();
        largest.into_iter().map(|e| Interval::new(-e, e).unwrap_or(Interval::ENTIRE)).collect()
    }

    /// gᵀ X g is linear in X: it is largest at one of the ellipsoids.
    fn reach(&self, gradient: &[Interval]) -> Interval {
        let reaches = self.0.iter().map(|shape| ball(shape.reach_square(gradient)));
        reaches.fold(Interval::ZERO, Interval::hull)
    }

    /// X g / √(gᵀ X g), of the ellipsoid where that reaches farthest.
    fn farthest(&self, gradient: &[f64]) -> Vec<f64> {
        let at = |shape: &Shape| {
            let l = &shape.lower;
            let n = shape.size();
            let pulled: Vec<f64> = (0..n).map(|k| (k..n).map(|i| l[(i, k)] * gradient[i]).sum()).collect();
            let length = pulled.iter().map(|x| x * x).sum::<f64>().sqrt();
            let scale = if length > 0.0 { length.recip() } else { 0.0 };
            let point = (0..n).map(|i| (0..=i).map(|k| l[(i, k)] * pulled[k]).sum::<f64>() * scale);
            (length, point.collect())
        };
        let farther = |a: (f64, Vec<f64>), b: (f64, Vec<f64>)| if a.0 > b.0 { a } else { b };
        self.0.iter().map(at).reduce(farther).map_or_else(Vec::new, |(_, point)| point)
    }
}

/// L Lᵀ of a lower triangular L.
pub(super) fn square(lower: &Dense<f64>) -> Symmetric<Interval> {
    let entry = |i: usize, j: usize| {
        let row = lower.row(i).iter().zip(lower.row(j)).take(i.min(j) + 1);
        row.fold(Interval::ZERO, |sum, (&a, &b)| sum + Interval::point(a) * Interval::point(b))
    };
    Symmetric::from_fn(lower.columns(), entry)
}

/// R A Rᵀ.
pub(super) fn congruent(r: &Dense<f64>, a: &Symmetric<Interval>) -> Symmetric<Interval> {
    let n = a.size();
    let half = Dense::from_fn(n, n, |i, j| {
        (0..=i).fold(Interval::ZERO, |sum, k| sum + Interval::point(r[(i, k)]) * a.at(k, j))
    });
    Symmetric::from_fn(n, |i, j| {
        (0..=j).fold(Interval::ZERO, |sum, k| sum + half[(i, k)] * Interval::point(r[(j, k)]))
    })
}
