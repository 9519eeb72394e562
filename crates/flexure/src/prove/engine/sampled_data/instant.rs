//! What the law asks for at an instant, over an ellipsoid of states.

use flexure_core::scalar::{Interval, Scalar};
use rayon::prelude::*;

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::bends::{Bends, Order, along, columns, reference, second};
use crate::prove::engine::sampled_data::frame::Frame;
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
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

/// The law at the middle of what is seen: its torques [N m] and their slopes by the coordinates of a frame.
#[derive(Clone, Debug)]
pub struct Middle {
    at: Vec<Interval>,
    frame: Frame,
    torques: Vec<Interval>,
    slopes: Dense<Interval>,
    /// ∂²u_j/∂ξ², where boxes have third derivatives; else none.
    bends: Vec<Symmetric<Interval>>,
}

impl Middle {
    /// At the time `t` in s and the motion `x`.
    pub fn of(system: &dyn TrackingLoop, t: Interval, x: &[Interval], frame: Frame, order: Order) -> Self {
        let q_ld = reference(system, t);
        let one = |directions: &[usize]| along(system, &q_ld, x, &columns(&frame.lower, directions));
        let torques: Vec<_> = one(&[]).iter().map(|u| u.coefficient(0)).collect();
        let first: Vec<_> = (0..x.len()).into_par_iter().map(|k| one(&[k])).collect();
        let slopes = Dense::from_fn(torques.len(), x.len(), |j, k| first[k][j].coefficient(1));
        let bends = match order {
            Order::Second => Vec::new(),
            Order::Third => second(system, &q_ld, x, &frame),
        };
        Self { at: x.to_vec(), frame, torques, slopes, bends }
    }

    /// Over all that is `seen`, c + A y + B z, |z_i| ≤ r_i of `sizes.most`: u(c) + J (A y + B z) + η with
    ///
    /// |η_j| ≤ s_j |y| + o_j, s_j = ‖Aᵀ H_j A‖ + | |Aᵀ H_j| β |, o_j = ½ βᵀ |G_j| β, β = |B| r,
    ///
    /// and those of the same z differ by s_j |Δy| at most. With w = A y + B z, ∂η_j/∂y is wᵀ H_j A, H_j = ∫ u_j''(c + t w) dt, and η_j for y = 0 is
    /// ½ wᵀ G_j w, G_j = 2 ∫ (1 − t) u_j''(c + t w) dt: t is ½ in the mean there, and ⅓.
    pub fn over(&self, seen: &Spread, sizes: &Sizes, bends: &Bends) -> Instant {
        let (n, ball) = (self.torques.len(), sizes.ball);
        let by = bends.coordinates(&seen.deviations);
        let of_ball = Dense::from_fn(seen.center.len(), ball, |i, j| by[(i, j)]);
        let across = of_ball.transposed();
        let by_others = |row: &[Interval]| {
            let each = row[ball..].iter().zip(&sizes.most);
            each.fold(Interval::ZERO, |sum, (x, &r)| {
                sum + Interval::point(x.magnitude()) * Interval::point(r)
            })
        };
        let others: Vec<_> = by.rows().map(by_others).collect();
        let both = of_ball.rows().map(|row| Interval::point(frobenius(row.iter().copied())));
        let both: Vec<_> = both.zip(&others).map(|(ball, &others)| ball + others).collect();
        let [one, two, three] = [1.0, 2.0, 3.0].map(Interval::point);
        let slopes = bends.mean(&self.bends, &both, one / two);
        let values = bends.mean(&self.bends, &others, one / three);
        let sized = |all: Dense<Interval>| all.map(|x| Interval::point(x.magnitude()));
        let dot = |a: &[Interval]| a.iter().zip(&others).fold(Interval::ZERO, |sum, (&a, &b)| sum + a * b);
        let beside = |(slopes, values): (&Symmetric<Interval>, &Symmetric<Interval>)| {
            let half = &across * &Dense::from(slopes);
            let slope = Interval::point(spectral(&(&half * &of_ball)))
                + Interval::point(frobenius(sized(half).apply(&others).into_iter()));
            let twice = dot(&sized(Dense::from(values)).apply(&others));
            [slope.hi(), (twice / two).hi()]
        };
        let beside: Vec<_> = slopes.par_iter().zip(&values).map(beside).collect();
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
        let Middle { at, frame, torques, slopes, .. } = &self.middle;
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
