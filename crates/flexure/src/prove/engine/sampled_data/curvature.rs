//! How the slopes of the links' accelerations change over a box.

use flexure_core::scalar::{Interval, Jet, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Slope, TrackingLoop};
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::second::second_derivatives;

/// Second derivatives of a_l by x = (q_l, q_m, q̇_l) over a box.
#[derive(Clone, Debug)]
pub struct Curvature {
    /// The box.
    over: Vec<Interval>,
    /// ∂²a_i/∂x².
    of: Vec<Symmetric<Interval>>,
}

impl Curvature {
    /// Over the box `x` of (q_l, q_m, q̇_l).
    pub fn over(system: &dyn TrackingLoop, x: Vec<Interval>) -> Self {
        let n = x.len() / 3;
        let along = |directions: &[usize]| -> Vec<Interval> {
            let slope = |(i, &x): (usize, &Interval)| {
                let rate = if directions.contains(&i) { Interval::ONE } else { Interval::ZERO };
                Jet::new([x, rate, Interval::ZERO])
            };
            let x: Vec<Slope> = x.iter().enumerate().map(slope).collect();
            let accelerations = system.link_accelerations(&x[..n], &x[n..2 * n], &x[2 * n..]);
            accelerations.iter().map(|a| a.coefficient(2)).collect()
        };
        Self { of: second_derivatives(x.len(), &along), over: x }
    }

    /// Whether the box has all of `x`.
    pub fn covers(&self, x: &[Interval]) -> bool {
        self.over.iter().zip(x).all(|(over, x)| over.contains_interval(*x))
    }

    /// What the slopes `rates` at the middles of `x`, a box in this one, are anywhere in it.
    pub fn around(&self, rates: &Dense<Interval>, x: &[Interval]) -> Dense<Interval> {
        let off: Vec<_> = x.iter().map(|&x| (x - Interval::point(x.midpoint())).magnitude()).collect();
        Dense::from_fn(rates.rows().len(), rates.columns(), |i, j| {
            let change = off.iter().enumerate().fold(Interval::ZERO, |sum, (k, &off)| {
                sum + Interval::point(self.of[i].at(j, k).magnitude()) * Interval::point(off)
            });
            rates[(i, j)] + around_zero(change.hi())
        })
    }
}
