//! Sets of numbers around a middle.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::norm::{around_zero, frobenius};

/// Numbers that are in `center` for y = 0 and z = 0, |y| ≤ 1 and z as [`Sizes`] says; those of two y and the same z differ by some M Δy, those of y = 0 with z and without by some M z, M in
/// `deviations`.
#[derive(Clone, Debug)]
pub struct Spread {
    /// c.
    pub center: Vec<Interval>,
    /// M: columns of y, then of z.
    pub deviations: Dense<Interval>,
}

/// What y and z are: |z_j| ≤ slopes_j |y| + most_j, and two z_j of the same readings differ by slopes_j |Δy| at most.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Numbers in y.
    pub ball: usize,
    /// For each z_j, from above.
    pub slopes: Vec<f64>,
    /// For each z_j, from above.
    pub most: Vec<f64>,
}

impl Sizes {
    /// How far row·(y, z) goes, from above.
    pub fn reach(&self, row: &[Interval]) -> f64 {
        let by_ball = Interval::point(frobenius(row[..self.ball].iter().copied()));
        let of_ball = Self::sum(&row[self.ball..], &self.slopes);
        (by_ball + of_ball + Self::sum(&row[self.ball..], &self.most)).hi()
    }

    /// How far `part` of row·(0, z) goes, from above.
    pub fn reach_of_others(&self, row: &[Interval], part: f64) -> f64 {
        (Interval::point(part) * Self::sum(&row[self.ball..], &self.most)).hi()
    }

    fn sum(row: &[Interval], sizes: &[f64]) -> Interval {
        let each = row.iter().zip(sizes);
        each.fold(Interval::ZERO, |sum, (x, &size)| {
            sum + Interval::point(x.magnitude()) * Interval::point(size)
        })
    }
}

impl Spread {
    /// The box around all of it.
    pub fn ranges(&self, sizes: &Sizes) -> Vec<Interval> {
        let range = |(&c, row): (&Interval, &[Interval])| c + around_zero(sizes.reach(row));
        self.center.iter().zip(self.deviations.rows()).map(range).collect()
    }

    /// The box around those of y = 0.
    pub fn ranges_of_others(&self, sizes: &Sizes) -> Vec<Interval> {
        let range = |(&c, row): (&Interval, &[Interval])| c + around_zero(sizes.reach_of_others(row, 1.0));
        self.center.iter().zip(self.deviations.rows()).map(range).collect()
    }

    /// `count` of the numbers.
    pub fn part(&self, from: usize, count: usize) -> Self {
        let deviations =
            Dense::from_fn(count, self.deviations.columns(), |i, j| self.deviations[(from + i, j)]);
        Self { center: self.center[from..from + count].to_vec(), deviations }
    }

    /// The same with so many columns more, which do nothing.
    #[must_use]
    pub fn widened(&self, count: usize) -> Self {
        let all = &self.deviations;
        let deviations = Dense::from_fn(self.center.len(), all.columns() + count, |i, j| {
            if j < all.columns() { all[(i, j)] } else { Interval::ZERO }
        });
        Self { center: self.center.clone(), deviations }
    }

    /// These numbers, then others.
    #[must_use]
    pub fn followed_by(&self, others: &Self) -> Self {
        let rows: Vec<_> = self.deviations.rows().chain(others.deviations.rows()).collect();
        let deviations = Dense::from_fn(rows.len(), self.deviations.columns(), |i, j| rows[i][j]);
        Self { center: [&self.center[..], &others.center].concat(), deviations }
    }

    /// Number by number, the sum of the parts, each times its factor.
    pub fn sum(parts: &[(Interval, &Self)]) -> Self {
        let of = |at: &dyn Fn(&Self) -> Interval| {
            parts.iter().fold(Interval::ZERO, |sum, &(factor, part)| sum + factor * at(part))
        };
        let all = &parts[0].1.deviations;
        Self {
            center: (0..parts[0].1.center.len()).map(|i| of(&|part| part.center[i])).collect(),
            deviations: Dense::from_fn(all.rows().len(), all.columns(), |i, j| {
                of(&|part| part.deviations[(i, j)])
            }),
        }
    }
}
