//! Coming to rest from any motion.

use super::Reference;
use super::argument::{Argument, Line, fraction};
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

impl<C: Scalar, const N: usize> Stop<C, N> {
    /// Where the links are when so much of the time is over.
    #[inline]
    fn when<T: Over<C> + Piecewise, X: Argument<T>>(&self, done: X) -> Vector<T, N> {
        let tau = done.within_unit();
        let left = tau.rest_to_one();
        let is_early = left.number() - tau.number();
        let carried = |way: [T; 3]| {
            Vector::from_fn(|i| {
                let mut power = C::ONE;
                let mut q = T::constant(self.from[i].coefficient(0));
                for (k, way) in (1..).zip(way) {
                    power *= self.duration;
                    q += way.scale(self.from[i].coefficient(k) * power);
                }
                q
            })
        };
        let select = |is: T, then: Vector<T, N>, otherwise: Vector<T, N>| {
            Vector::from_fn(|i| is.select(then[i], otherwise[i]))
        };
        let moving = || {
            is_early.select_of(|| carried(begun::<C, T, X>(tau)), || carried(ended::<C, T, X>(left)), select)
        };
        (done.number() - T::ONE).select_of(|| carried(reached()), moving, select)
    }
}

impl<C: Scalar, const N: usize> Reference<C, N> for Stop<C, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        self.when(fraction(t, self.start, self.duration))
    }

    #[inline]
    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        self.when(Line::fraction(t, self.start, self.duration))
    }
}

/// Where the Taylor coefficients of orders 1, 2, 3 have carried the joint at τ, as polynomials in τ: τᵏ + τ⁵ (…).
#[inline]
fn begun<C: Scalar, T: Over<C> + Piecewise, X: Argument<T>>(tau: X) -> [T; 3] {
    let tails = [[-98.0, 196.0, -140.0, 35.0], [-112.0, 210.0, -144.0, 35.0], [-84.0, 140.0, -90.0, 21.0]]
        .map(|coefficients| fifth::<C, T, X>(coefficients, tau));
    let square = tau.polynomial(&[0.0, 0.0, 1.0]);
    [tau.number() + tails[0], square + tails[1], tau.polynomial(&[0.0, 0.0, 0.0, 1.0]) + tails[2]]
}

/// The same polynomials in 1 − τ, which do not cancel near the end: what is reached at last + (1 − τ)⁵ (…).
#[inline]
fn ended<C: Scalar, T: Over<C> + Piecewise, X: Argument<T>>(left: X) -> [T; 3] {
    let tails = [[-98.0, 196.0, -140.0, 35.0], [-84.0, 182.0, -136.0, 35.0], [-42.0, 98.0, -78.0, 21.0]]
        .map(|coefficients| fifth::<C, T, X>(coefficients, left));
    let reached = reached::<T>();
    [reached[0] + tails[0], reached[1] + tails[1], reached[2] + tails[2]]
}

/// What they have carried it in the end.
#[inline]
fn reached<T: Scalar>() -> [T; 3] {
    [(1, 2), (3, 14), (1, 14)].map(|(numerator, denominator)| T::from_ratio(numerator, denominator))
}

/// x⁵ (a + b x + c x² + d x³) / 14: over 14 the coefficients are integers.
#[inline]
fn fifth<C: Scalar, T: Over<C>, X: Argument<T>>([a, b, c, d]: [f64; 4], x: X) -> T {
    x.polynomial(&[0.0, 0.0, 0.0, 0.0, 0.0, a, b, c, d]).scale(C::from_ratio(1, 14))
}
