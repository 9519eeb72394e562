//! How the slopes of the links' accelerations change over a box.

use flexure_core::scalar::{Interval, Jet, Scalar};
use rayon::prelude::*;

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::{Slope, TrackingLoop};

/// Second derivatives of a_l by x = (q_l, q_m, q̇_l) over a box.
#[derive(Clone, Debug)]
pub struct Curvature {
    /// The box.
    over: Vec<Interval>,
    /// |∂²a_i/∂x_j ∂x_k| from above, entry (j, k) of matrix i.
    bounds: Vec<Dense<f64>>,
}

impl Curvature {
    /// Over the box `x` of (q_l, q_m, q̇_l).
    ///
    /// a_i has ½ H_jj along x_j, ½ (H_jj + 2 H_jk + H_kk) along x_j + x_k.
    pub fn over(system: &dyn TrackingLoop, x: Vec<Interval>) -> Self {
        let (size, n) = (x.len(), x.len() / 3);
        let along = |j: usize, k: usize| -> Vec<Interval> {
            let slope = |(i, &x): (usize, &Interval)| {
                let rate = if i == j || i == k { Interval::ONE } else { Interval::ZERO };
                Jet::new([x, rate, Interval::ZERO])
            };
            let x: Vec<Slope> = x.iter().enumerate().map(slope).collect();
            let accelerations = system.link_accelerations(&x[..n], &x[n..2 * n], &x[2 * n..]);
            accelerations.iter().map(|a| a.coefficient(2)).collect()
        };
        let pairs: Vec<_> = (0..size).flat_map(|j| (0..=j).map(move |k| (j, k))).collect();
        let found: Vec<_> = pairs.par_iter().map(|&(j, k)| along(j, k)).collect();
        let at = |j: usize, k: usize| &found[j * (j + 1) / 2 + k];
        let bound = |i: usize, j: usize, k: usize| {
            let (j, k) = (j.max(k), j.min(k));
            let all =
                if j == k { at(j, j)[i] + at(j, j)[i] } else { at(j, k)[i] - at(j, j)[i] - at(k, k)[i] };
            all.magnitude()
        };
        let bounds = (0..n).map(|i| Dense::from_fn(size, size, |j, k| bound(i, j, k))).collect();
        Self { over: x, bounds }
    }

    /// Whether the box has all of `x`.
    pub fn covers(&self, x: &[Interval]) -> bool {
        self.over.iter().zip(x).all(|(over, x)| over.contains_interval(*x))
    }

    /// What the slopes `rates` at the middles of `x`, a box in this one, are anywhere in it.
    pub fn around(&self, rates: &Dense<Interval>, x: &[Interval]) -> Dense<Interval> {
        let off: Vec<_> = x.iter().map(|&x| (x - Interval::point(x.midpoint())).magnitude()).collect();
        Dense::from_fn(rates.rows().len(), rates.columns(), |i, j| {
            let change = self.bounds[i]
                .row(j)
                .iter()
                .zip(&off)
                .fold(Interval::ZERO, |sum, (&h, &off)| sum + Interval::point(h) * Interval::point(off));
            let change = change.hi();
            rates[(i, j)] + Interval::new(-change, change).unwrap_or(Interval::ENTIRE)
        })
    }
}
