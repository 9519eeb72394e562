//! Rest to rest.

use super::argument::{Argument, Line, fraction};
use super::{Reference, Smoothstep};
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// A straight line in joint space, from rest to rest: from + s((t − start) / duration) (to − from).
///
/// At rest before `start` and after `start + duration`; continuous up to derivative m of the [`Smoothstep`], with
/// q_d = `from` and q_d = `to` exactly outside. The derivative of order m + 1 jumps at both ends; there it is that of
/// the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointToPoint<C, const N: usize> {
    /// Posture before the motion in rad.
    pub from: Vector<C, N>,
    /// Posture after the motion in rad.
    pub to: Vector<C, N>,
    /// Time of departure in s.
    pub start: C,
    /// Time that the motion takes in s; `duration` > 0 is the caller's duty.
    pub duration: C,
    /// The function s between 0 and 1 that the motion follows.
    pub step: Smoothstep,
}

impl<C: Scalar, const N: usize> PointToPoint<C, N> {
    /// Where the links are when so much of the time is over.
    #[inline]
    fn when<T: Over<C> + Piecewise>(&self, done: impl Argument<T>) -> Vector<T, N> {
        self.step.blend_all(&self.from.lift(), &self.to.lift(), done)
    }
}

impl<C: Scalar, const N: usize> Reference<C, N> for PointToPoint<C, N> {
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
