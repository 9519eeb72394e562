//! How the slopes of the links' accelerations change over a box.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::links::{Links, springs};
use crate::prove::engine::sampled_data::norm::{around_zero, radius};

/// Second derivatives of a_l by x = (q_l, δ, q̇_l) over a box.
#[derive(Clone, Debug)]
pub struct Curvature {
    /// The box.
    over: Vec<Interval>,
    /// ∂²a_i/∂x².
    of: Vec<Symmetric<Interval>>,
}

/// How far motions are off another: D z, and a little beside.
pub struct Off<'a> {
    /// D, a row for each number.
    pub columns: &'a Dense<Interval>,
    /// Of a row, how far its product with z gets, from above.
    pub reach: &'a dyn Fn(&[Interval]) -> f64,
    /// What is beside D z, number by number, from above.
    pub beside: &'a [f64],
    /// Both together, number by number, from above.
    pub all: &'a [f64],
}

impl Curvature {
    /// Over the box `x` of (q_l, δ, q̇_l); none where masses are not known there.
    pub fn over(system: &dyn TrackingLoop, x: Vec<Interval>) -> Option<Self> {
        let n = x.len() / 3;
        let links = Links::over(system, &x[..n])?;
        let spring = springs(system, &x[n..2 * n]);
        let a_l = links.accelerations(system, &x[..n], &x[2 * n..], &spring);
        Some(Self { of: links.bends(system, &x[..n], &x[2 * n..], &a_l), over: x })
    }

    /// Whether the box has all of `x`.
    pub fn covers(&self, x: &[Interval]) -> bool {
        self.over.iter().zip(x).all(|(over, x)| over.contains_interval(*x))
    }

    /// What the slopes `at` a motion are wherever motions are off it by `off` at most, from above.
    pub fn around(&self, at: &Dense<Interval>, off: &[f64]) -> Dense<Interval> {
        Dense::from_fn(at.rows().len(), at.columns(), |i, j| {
            let change = self.sum(i, j, off, Interval::magnitude);
            at[(i, j)] + around_zero(change.hi())
        })
    }

    /// The same, where motions are off it by D z and a little beside: |Σ_k H_k (D z)_k| with the middles of second derivatives H, column by column, and what is beside those by the box.
    pub fn around_columns(&self, at: &Dense<Interval>, off: &Off<'_>) -> Dense<Interval> {
        Dense::from_fn(at.rows().len(), at.columns(), |i, j| {
            let along = |column: usize| {
                let each = off.columns.rows().enumerate();
                each.fold(Interval::ZERO, |sum, (k, row)| {
                    sum + Interval::point(self.of[i].at(j, k).midpoint()) * row[column]
                })
            };
            let row: Vec<_> = (0..off.columns.columns()).map(along).collect();
            let known =
                Interval::point((off.reach)(&row)) + self.sum(i, j, off.beside, |bend| bend.midpoint().abs());
            let change = known + self.sum(i, j, off.all, |bend| radius(bend).hi());
            at[(i, j)] + around_zero(change.hi())
        })
    }

    /// Σ_k of the second derivative of a_i by x_j and x_k, `sized`, times `off`_k.
    fn sum(&self, i: usize, j: usize, off: &[f64], sized: impl Fn(Interval) -> f64) -> Interval {
        let each = off.iter().enumerate();
        each.fold(Interval::ZERO, |sum, (k, &off)| {
            sum + Interval::point(sized(self.of[i].at(j, k))) * Interval::point(off)
        })
    }

    /// How the slopes change where a motion does by `by`, as intervals of second derivatives have it.
    pub fn along(&self, by: &[Interval]) -> Dense<Interval> {
        Dense::from_fn(self.of.len(), by.len(), |i, j| {
            by.iter().enumerate().fold(Interval::ZERO, |sum, (k, &by)| sum + self.of[i].at(j, k) * by)
        })
    }
}
