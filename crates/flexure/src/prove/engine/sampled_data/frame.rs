//! Coordinates in which all of an ellipsoid is as wide as it is long.

use flexure_core::scalar::Interval;

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::norm::{around_zero, frobenius};
use crate::prove::engine::sampled_data::section::near_inverse;

/// Rows that are shorter than this part of what they were before others were taken out are taken to be so long.
const DEPENDENT: f64 = 1e-12;

/// x = c + W ξ with a lower triangular W of floats.
#[derive(Clone, Debug)]
pub struct Frame {
    /// W.
    pub lower: Dense<f64>,
    /// R near W⁻¹.
    root: Dense<Interval>,
    /// ‖(R W)⁻¹ − 1‖, from above.
    off: Interval,
}

impl Frame {
    /// W with W Q near `by`, the rows of Q orthonormal: by Gram and Schmidt, row by row.
    pub fn of(by: &Dense<f64>) -> Self {
        let size = by.rows().len();
        let mut lower = Dense::zeros(size, size);
        let mut found: Vec<Vec<f64>> = Vec::with_capacity(size);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for (i, row) in by.rows().enumerate() {
            let (mut left, long) = (row.to_vec(), dot(row, row).sqrt());
            for (j, unit) in found.iter().enumerate() {
                let along = dot(&left, unit);
                left.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
                lower[(i, j)] = along;
            }
            let length = dot(&left, &left).sqrt();
            let unit = left.iter().map(|x| x / length.max(f64::MIN_POSITIVE));
            found.push(unit.collect());
            lower[(i, i)] = length.max(DEPENDENT * long).max(f64::MIN_POSITIVE.sqrt());
        }
        let (root, off) = near_inverse(&lower);
        Self { lower, root, off }
    }

    /// T with `by` = W T: (R W)⁻¹ R `by`.
    pub fn coordinates(&self, by: &Dense<Interval>) -> Dense<Interval> {
        let near = &self.root * by;
        let size = near.rows().len();
        let length = |j: usize| Interval::point(frobenius((0..size).map(|i| near[(i, j)])));
        let off: Vec<_> = (0..near.columns()).map(|j| around_zero((self.off * length(j)).hi())).collect();
        Dense::from_fn(size, near.columns(), |i, j| near[(i, j)] + off[j])
    }
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Dense, Frame};

    /// A thin ellipse, and one more column than rows: W T has what T is of, and T is no longer than 1.
    #[test]
    fn what_is_made_of_coordinates_is_what_they_are_of() {
        let by = Dense::from_fn(2, 3, |i, j| [[1.0, 0.5, 0.0], [1.0 + 1e-7, 0.5, 1e-7]][i][j]);
        let frame = Frame::of(&by);
        let exact = by.map(Interval::point);
        let found = frame.coordinates(&exact);
        let again = &frame.lower.map(Interval::point) * &found;
        for (again, exact) in again.rows().flatten().zip(exact.rows().flatten()) {
            // Rounding, times how thin it is: 1e7.
            assert!(again.contains_interval(*exact) && again.width() < 1e-7, "{again:?} {exact:?}");
        }
        for row in found.rows() {
            let length: f64 = row.iter().map(|x| x.midpoint().powi(2)).sum();
            assert!((length - 1.0).abs() < 1e-6, "{length}");
        }
    }
}
