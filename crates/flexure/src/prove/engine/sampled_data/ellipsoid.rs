//! Ellipsoids of states of a sampled loop.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, lower_inverse};
use crate::prove::engine::sampled_data::norm::frobenius;

/// c + L y, |y| ≤ 1.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    /// c: motion, then torques on their way, the first to act first.
    pub center: Vec<f64>,
    /// L, lower triangular.
    pub lower: Dense<f64>,
}

impl Ellipsoid {
    /// How far each number reaches, from above.
    pub fn extents(&self) -> Vec<f64> {
        self.lower.rows().map(|row| frobenius(row.iter().map(|&x| Interval::point(x)))).collect()
    }

    /// How far number `i` may be off alone, from below: 1/|L⁻¹ e_i|.
    pub fn alone(&self, i: usize) -> f64 {
        let (root, inverse) = inverse_of(&self.lower);
        let column = frobenius((0..self.center.len()).map(|k| root[(k, i)]));
        (inverse * Interval::point(column)).recip().lo()
    }

    /// |y| of a state, from above.
    pub fn reach(&self, state: &[Interval]) -> f64 {
        let (root, inverse) = inverse_of(&self.lower);
        let off: Vec<_> = state.iter().zip(&self.center).map(|(&x, &c)| x - Interval::point(c)).collect();
        (inverse * Interval::point(frobenius(root.apply(&off).into_iter()))).hi()
    }

    /// |y| of a state, or of the first numbers of one, then of as many numbers of y, which depend on no others; but for rounding.
    pub fn distance(&self, state: &[f64]) -> f64 {
        let root = lower_inverse(&self.lower);
        let off: Vec<f64> = state.iter().zip(&self.center).map(|(x, c)| x - c).collect();
        root.apply(&off).into_iter().take(state.len()).map(|y| y * y).sum::<f64>().sqrt()
    }
}

/// R near the inverse of `lower`, and a bound of ‖(R L)⁻¹‖: 1/(1 − ‖1 − R L‖), so that |L⁻¹ x| ≤ ‖(R L)⁻¹‖ |R x|; infinite where R is not near.
pub(super) fn inverse_of(lower: &Dense<f64>) -> (Dense<Interval>, Interval) {
    let size = lower.columns();
    let root = lower_inverse(lower).map(Interval::point);
    let product = &root * &lower.map(Interval::point);
    let off = (0..size)
        .flat_map(|i| (0..size).map(move |j| (i, j)))
        .map(|(i, j)| if i == j { product[(i, j)] - Interval::ONE } else { product[(i, j)] });
    let left = Interval::ONE - Interval::point(frobenius(off));
    let bound = if left.lo() > 0.0 { left.recip() } else { Interval::point(f64::INFINITY) };
    (root, bound)
}
