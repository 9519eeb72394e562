//! Coming to rest from any motion.

use super::Reference;
use crate::linalg::Vector;
use crate::scalar::{Float, Jet, Over, Piecewise, Scalar};

/// From a motion to rest: position, velocity, acceleration and jerk at `start` are those of `from`, its fourth derivative
/// is zero there, and from `start + duration` on everything stands still.
///
/// The velocity is the polynomial of degree 7 that these eight conditions fix, so that the position is C⁴ at the end; its
/// fifth derivative jumps there. With T the duration, a velocity q̇ carries the joint on by T q̇ / 2, an acceleration q̈ by
/// 3 T² q̈ / 28 and a jerk q⃛ by T³ q⃛ / 84, and nowhere farther: a long T lets jerks run far, a short one stops
/// hard. At and before `start` the posture is that of `from`; before it, it stands still there.
///
/// A flexible-joint robot's state decides its `from`: [`Fjr::link_motion`](crate::model::Fjr::link_motion).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop<C, const N: usize> {
    /// Link motion at the start, to the jerk: rad, rad/s, rad/s², rad/s³.
    pub from: Vector<Jet<C, 4>, N>,
    /// Time at which the robot moves like that in s.
    pub start: C,
    /// Time T in which it comes to rest in s; `duration` > 0 is the caller's duty.
    pub duration: C,
}

impl<C: Float, const N: usize> Stop<C, N> {
    /// The same with accelerations and jerks cut so that neither carries a joint on by more than `farthest` > 0 in rad. A light link
    /// that swings on its spring has large ones, which say nothing of where it goes within T.
    #[must_use]
    pub fn within(self, farthest: C) -> Self {
        let square = self.duration * self.duration;
        // Of the Taylor coefficients q̈/2 and q⃛/6.
        let acceleration = farthest * C::from_ratio(14, 3) / square;
        let jerk = farthest * C::from_ratio(14, 1) / (square * self.duration);
        let cut = |x: C, most: C| Piecewise::clamp(x, -most, most);
        let from = self.from.map(|jet| {
            let [q, v, a, j] = [0, 1, 2, 3].map(|k| jet.coefficient(k));
            Jet::new([q, v, cut(a, acceleration), cut(j, jerk)])
        });
        Self { from, ..self }
    }
}

impl<C: Scalar, const N: usize> Reference<C, N> for Stop<C, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let tau = (t - T::constant(self.start)).scale(self.duration.recip()).clamp(T::ZERO, T::ONE);
        let left = T::ONE - tau;
        let (early, late) = (begun(tau), ended(left));
        let sum = |way: &[T; 3], taylor: [C; 3]| {
            way[0].scale(taylor[0]) + way[1].scale(taylor[1]) + way[2].scale(taylor[2])
        };
        Vector::from_fn(|i| {
            let mut power = C::ONE;
            let taylor = [1, 2, 3].map(|k| {
                power *= self.duration;
                self.from[i].coefficient(k) * power
            });
            let q = T::constant(self.from[i].coefficient(0));
            (left - tau).select(q + sum(&early, taylor), q + sum(&late, taylor))
        })
    }
}

/// Where the Taylor coefficients of orders 1, 2, 3 have carried the joint at τ, as polynomials in τ: τᵏ + τ⁵ (…).
#[inline]
fn begun<T: Scalar>(tau: T) -> [T; 3] {
    let (square, fifth) = (tau * tau, fifth_of_14(tau));
    let tails = [[-98, 196, -140, 35], [-112, 210, -144, 35], [-84, 140, -90, 21]]
        .map(|coefficients| fifth * cubic(coefficients, tau));
    [tau + tails[0], square + tails[1], square * tau + tails[2]]
}

/// The same polynomials in 1 − τ, which do not cancel near the end: what is reached at last + (1 − τ)⁵ (…).
#[inline]
fn ended<T: Scalar>(left: T) -> [T; 3] {
    let fifth = fifth_of_14(left);
    let tails = [[-98, 196, -140, 35], [-84, 182, -136, 35], [-42, 98, -78, 21]]
        .map(|coefficients| fifth * cubic(coefficients, left));
    let reached =
        [(1, 2), (3, 14), (1, 14)].map(|(numerator, denominator)| T::from_ratio(numerator, denominator));
    [reached[0] + tails[0], reached[1] + tails[1], reached[2] + tails[2]]
}

/// x⁵ / 14: times this the coefficients of the cubics are integers.
#[inline]
fn fifth_of_14<T: Scalar>(x: T) -> T {
    let square = x * x;
    square * square * x * T::from_ratio(1, 14)
}

/// The cubic with these coefficients, lowest order first.
#[inline]
fn cubic<T: Scalar>(coefficients: [i32; 4], x: T) -> T {
    let mut sum = T::ZERO;
    for c in coefficients.into_iter().rev() {
        sum = sum * x + T::from_f64(f64::from(c));
    }
    sum
}
