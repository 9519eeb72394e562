//! Sets of numbers around a middle.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::norm::{around_zero, frobenius};

/// Numbers c + M (y, η) with |y| ≤ 1 and |η_j| ≤ s_j; of another y and η, they differ by some N (Δy, Δη), N in the same intervals.
#[derive(Clone, Debug)]
pub struct Spread {
    /// c.
    pub center: Vec<Interval>,
    /// M: columns of y, then of η.
    pub deviations: Dense<Interval>,
}

/// What the y and η are.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Numbers in y.
    pub ball: usize,
    /// s_j, from above.
    pub others: Vec<f64>,
}

impl Sizes {
    /// How far |row·(y, η)| goes, from above.
    pub fn reach(&self, row: &[Interval]) -> f64 {
        let (y, others) = row.split_at(self.ball);
        let others = others.iter().zip(&self.others).fold(Interval::ZERO, |sum, (x, &size)| {
            sum + Interval::point(x.magnitude()) * Interval::point(size)
        });
        (Interval::point(frobenius(y.iter().copied())) + others).hi()
    }
}

impl Spread {
    /// The box around all of it.
    pub fn ranges(&self, sizes: &Sizes) -> Vec<Interval> {
        let range = |(&c, row): (&Interval, &[Interval])| c + around_zero(sizes.reach(row));
        self.center.iter().zip(self.deviations.rows()).map(range).collect()
    }
}
