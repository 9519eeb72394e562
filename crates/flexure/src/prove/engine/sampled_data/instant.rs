//! What the law asks for at an instant, over an ellipsoid of states.

use flexure_core::scalar::{Interval, Jet, Scalar};
use rayon::prelude::*;

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Place, Slope, TrackingLoop};
use crate::prove::engine::sampled_data::frame::Frame;
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
use crate::prove::engine::sampled_data::second::second_derivatives;
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// The torque of the law at an instant, and what that depends on.
#[derive(Clone, Debug)]
pub struct Instant {
    middle: Middle,
    /// [N m].
    pub asked: Spread,
    /// Of all numbers z of the instant: how far torques are beside the middle of their slopes [N m], then how far readings are off.
    pub sizes: Sizes,
}

/// The law's torques [N m] along a line of motions x = (q_l, q_m, q̇_l, q̇_m) that move at `rates`.
fn along(system: &dyn TrackingLoop, q_ld: &[[Slope; 5]], x: &[Interval], rates: &[Interval]) -> Vec<Slope> {
    let n = x.len() / 4;
    let slope = |i: usize| Jet::new([x[i], rates[i], Interval::ZERO]);
    let part = |k: usize| (k * n..(k + 1) * n).map(slope).collect();
    system.command(&Place { q_l: part(0), q_m: part(1), v_l: part(2), v_m: part(3) }, q_ld).u_m
}

/// The sum of so many columns.
fn columns(lower: &Dense<f64>, of: &[usize]) -> Vec<Interval> {
    let sum = |row: &[f64]| of.iter().fold(Interval::ZERO, |sum, &k| sum + Interval::point(row[k]));
    lower.rows().map(sum).collect()
}

/// Taylor coefficients of the reference over the times `t` in s.
fn reference(system: &dyn TrackingLoop, t: Interval) -> Vec<[Slope; 5]> {
    system.reference(t).iter().map(|jet| std::array::from_fn(|k| Slope::value(jet[k]))).collect()
}

/// Second derivatives of the law's torques by the coordinates of a frame, over a box of motions and some time.
#[derive(Clone, Debug)]
pub struct Bends {
    times: Interval,
    over: Vec<Interval>,
    frame: Frame,
    /// ∂²u_j/∂ξ².
    of: Vec<Symmetric<Interval>>,
}

impl Bends {
    /// Over the `times` in s and the box `over` of motions.
    pub fn over(system: &dyn TrackingLoop, times: Interval, over: Vec<Interval>, frame: &Frame) -> Self {
        let q_ld = reference(system, times);
        let of = second_derivatives(over.len(), &|_, _| false, &|directions| {
            let torques = along(system, &q_ld, &over, &columns(&frame.lower, directions));
            torques.iter().map(|u| u.coefficient(2)).collect()
        });
        Self { times, over, frame: frame.clone(), of }
    }

    /// Whether they are known at the time `t` in s over all of the box `x`.
    pub fn cover(&self, t: Interval, x: &[Interval]) -> bool {
        self.times.contains_interval(t) && self.over.iter().zip(x).all(|(over, x)| over.contains_interval(*x))
    }
}

/// The law at the middle of what is seen: its torques [N m] and their slopes by the coordinates of a frame.
#[derive(Clone, Debug)]
pub struct Middle {
    at: Vec<Interval>,
    frame: Frame,
    torques: Vec<Interval>,
    slopes: Dense<Interval>,
}

impl Middle {
    /// At the time `t` in s and the motion `x`.
    pub fn of(system: &dyn TrackingLoop, t: Interval, x: &[Interval], frame: Frame) -> Self {
        let q_ld = reference(system, t);
        let one = |directions: &[usize]| along(system, &q_ld, x, &columns(&frame.lower, directions));
        let torques: Vec<_> = one(&[]).iter().map(|u| u.coefficient(0)).collect();
        let first: Vec<_> = (0..x.len()).into_par_iter().map(|k| one(&[k])).collect();
        let slopes = Dense::from_fn(torques.len(), x.len(), |j, k| first[k][j].coefficient(1));
        Self { at: x.to_vec(), frame, torques, slopes }
    }

    /// Over all that is `seen`, c + A y + B z, |z_i| ≤ r_i of `sizes.most`: u(c) + J (A y + B z) + η with
    ///
    /// |η_j| ≤ s_j |y| + o_j, s_j = ‖Aᵀ H_j A‖ + | |Aᵀ H_j| β |, o_j = ½ βᵀ |H_j| β, β = |B| r,
    ///
    /// and those of the same z differ by s_j |Δy| at most: ∂η_j/∂y is ∫ (A y + B z)ᵀ H_j A over a way from c, the second derivatives H_j in `bends`.
    pub fn over(&self, seen: &Spread, sizes: &Sizes, bends: &Bends) -> Instant {
        let (n, ball) = (self.torques.len(), sizes.ball);
        let by = bends.frame.coordinates(&seen.deviations);
        let of_ball = Dense::from_fn(seen.center.len(), ball, |i, j| by[(i, j)]);
        let across = of_ball.transposed();
        let by_others = |row: &[Interval]| {
            let each = row[ball..].iter().zip(&sizes.most);
            each.fold(Interval::ZERO, |sum, (x, &r)| {
                sum + Interval::point(x.magnitude()) * Interval::point(r)
            })
        };
        let others: Vec<_> = by.rows().map(by_others).collect();
        let sized = |all: Dense<Interval>| all.map(|x| Interval::point(x.magnitude()));
        let dot = |a: &[Interval]| a.iter().zip(&others).fold(Interval::ZERO, |sum, (&a, &b)| sum + a * b);
        let beside = |bend: &Symmetric<Interval>| {
            let bend = Dense::from(bend);
            let half = &across * &bend;
            let slope = Interval::point(spectral(&(&half * &of_ball)))
                + Interval::point(frobenius(sized(half).apply(&others).into_iter()));
            let twice = dot(&sized(bend).apply(&others));
            [slope.hi(), (twice * Interval::point(0.5)).hi()]
        };
        let beside: Vec<_> = bends.of.par_iter().map(beside).collect();
        let mut sizes = sizes.clone();
        for (j, [slope, most]) in beside.into_iter().enumerate() {
            (sizes.slopes[j], sizes.most[j]) = (slope, most);
        }
        let mut deviations = &self.slopes * &self.frame.coordinates(&seen.deviations);
        for j in 0..n {
            deviations[(j, ball + j)] = Interval::ONE;
        }
        let asked = Spread { center: self.torques.clone(), deviations };
        Instant { middle: self.clone(), asked, sizes }
    }
}

impl Instant {
    /// The torques for what is `seen`, in other columns than those of `asked`, but for η.
    pub fn at(&self, seen: &Spread) -> Spread {
        let Middle { at, frame, torques, slopes } = &self.middle;
        let off = Dense::from_fn(at.len(), 1, |i, _| seen.center[i] - at[i]);
        let moved = slopes * &frame.coordinates(&off);
        Spread {
            center: torques.iter().zip(moved.rows()).map(|(&u, row)| u + row[0]).collect(),
            deviations: slopes * &frame.coordinates(&seen.deviations),
        }
    }

    /// The largest |u_j| of all those motions [N m], from above.
    pub fn largest(&self) -> Vec<f64> {
        self.asked.ranges(&self.sizes).iter().map(|u| u.magnitude()).collect()
    }
}
