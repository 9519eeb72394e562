//! Where states of a sampled loop are at an instant.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, lower_inverse};
use crate::prove::engine::sampled_data::norm::frobenius;

/// c + L y + P z, |y| ≤ 1, |z_i| ≤ 1: an ellipsoid, and what readings before may have moved it by.
#[derive(Clone, Debug)]
pub struct Section {
    /// c: motion, what filters remember, then torques on their way, the first to act first.
    pub center: Vec<f64>,
    /// L, lower triangular.
    pub lower: Dense<f64>,
    /// P: a column for each reading that is kept, the oldest first.
    pub past: Dense<f64>,
}

impl Section {
    /// How far each number of L y reaches, from above.
    pub fn extents(&self) -> Vec<f64> {
        self.lower.rows().map(|row| frobenius(row.iter().map(|&x| Interval::point(x)))).collect()
    }

    /// How far each number of P z reaches, from above.
    pub fn moved(&self) -> Vec<f64> {
        let reach =
            |row: &[f64]| row.iter().fold(Interval::ZERO, |sum, x| sum + Interval::point(x.abs())).hi();
        (0..self.center.len()).map(|i| reach(self.past.row(i))).collect()
    }

    /// How far each number reaches along with `ball` times L y, from above.
    pub fn reaches(&self, ball: Interval) -> Vec<f64> {
        let both = self.extents().into_iter().zip(self.moved());
        both.map(|(e, p)| (Interval::point(e) * ball + Interval::point(p)).hi()).collect()
    }

    /// How many times `direction` a state may be off, from below: 1/|L⁻¹ d|.
    pub fn alone(&self, direction: &[Interval]) -> f64 {
        let (root, inverse) = inverse_of(&self.lower);
        let length = frobenius(root.apply(direction).into_iter());
        (inverse * Interval::point(length)).recip().lo()
    }

    /// |y| of a state with z = 0, from above.
    pub fn reach(&self, state: &[Interval]) -> f64 {
        let (root, inverse) = inverse_of(&self.lower);
        let off: Vec<_> = state.iter().zip(&self.center).map(|(&x, &c)| x - Interval::point(c)).collect();
        (inverse * Interval::point(frobenius(root.apply(&off).into_iter()))).hi()
    }

    /// |y| of a state with z = 0, or of the first numbers of one, then of as many numbers of y, which depend on no others; but for rounding.
    pub fn distance(&self, state: &[f64]) -> f64 {
        let root = lower_inverse(&self.lower);
        let off: Vec<f64> = state.iter().zip(&self.center).map(|(x, c)| x - c).collect();
        root.apply(&off).into_iter().take(state.len()).map(|y| y * y).sum::<f64>().sqrt()
    }
}

/// R near the inverse of `lower`, and a bound of ‖(R L)⁻¹‖: 1/(1 − ‖1 − R L‖), so that |L⁻¹ x| ≤ ‖(R L)⁻¹‖ |R x|; infinite where R is not near.
pub(super) fn inverse_of(lower: &Dense<f64>) -> (Dense<Interval>, Interval) {
    let (root, off) = near_inverse(lower);
    (root, Interval::ONE + off)
}

/// R near the inverse of `lower`, and ‖(R L)⁻¹ − 1‖ from above, d/(1 − d) with d = ‖1 − R L‖; infinite where R is not near.
pub(super) fn near_inverse(lower: &Dense<f64>) -> (Dense<Interval>, Interval) {
    let size = lower.columns();
    let root = lower_inverse(lower).map(Interval::point);
    let product = &root * &lower.map(Interval::point);
    let off = (0..size)
        .flat_map(|i| (0..size).map(move |j| (i, j)))
        .map(|(i, j)| if i == j { product[(i, j)] - Interval::ONE } else { product[(i, j)] });
    let off = Interval::point(frobenius(off));
    let left = Interval::ONE - off;
    let bound = if left.lo() > 0.0 { (off / left).hi() } else { f64::INFINITY };
    (root, Interval::point(bound))
}
