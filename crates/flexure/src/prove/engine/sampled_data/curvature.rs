//! How the slopes of the links' accelerations change over a box.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::links::{Links, springs};
use crate::prove::engine::sampled_data::norm::around_zero;

/// Second derivatives of a_l by x = (q_l, δ, q̇_l) over a box.
#[derive(Clone, Debug)]
pub struct Curvature {
    /// The box.
    over: Vec<Interval>,
    /// ∂²a_i/∂x².
    of: Vec<Symmetric<Interval>>,
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
            let bend = |k: usize| Interval::point(self.of[i].at(j, k).magnitude());
            let change = off
                .iter()
                .enumerate()
                .fold(Interval::ZERO, |sum, (k, &off)| sum + bend(k) * Interval::point(off));
            at[(i, j)] + around_zero(change.hi())
        })
    }

    /// How the slopes change where a motion does by `by`, as intervals of second derivatives have it.
    pub fn along(&self, by: &[Interval]) -> Dense<Interval> {
        Dense::from_fn(self.of.len(), by.len(), |i, j| {
            by.iter().enumerate().fold(Interval::ZERO, |sum, (k, &by)| sum + self.of[i].at(j, k) * by)
        })
    }
}
