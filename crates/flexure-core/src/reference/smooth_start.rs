//! Joining a moving reference from where the robot is and how it moves.

use super::argument::{Line, fraction};
use super::{Reference, Smoothstep, Stop};
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// Any reference r, joined from a motion of the robot: q_d(t) = p(t) + s((t − t_0) / T) (r(t) − p(t)) with the nonic
/// [`Smoothstep`] s, where p is the [`Stop`] that brings the robot to rest.
///
/// A robot that is asked to be on a sine at once answers with torques of thousands of N m. This reference starts where
/// the robot is and moves as it does, and is r, exactly, from t = t_0 + T on. With `from` the link motion of the robot's
/// state, to the jerk ([`Fjr::link_motion`](crate::model::Fjr::link_motion)), every error of a law on flexible joints
/// starts at zero: motor positions and velocities follow from q_d, …, q⃛_d.
///
/// By Leibniz, derivative k of q_d is that of p plus Σ_j C(k, j) s⁽ʲ⁾((t − t_0) / T) T⁻ʲ (r − p)⁽ᵏ⁻ʲ⁾(t). At t_0 every s⁽ʲ⁾
/// with j ≤ 4 is zero, so the first four derivatives are those of p; at t_0 + T all are zero but s = 1, so they are those of
/// r, and q_d is C⁴ there where r is. The fifth jumps at both ends, by 15120 (r − p) / T⁵ more than those of p and r; there
/// it is that of the transition.
///
/// Why two times: blending the Taylor polynomial of the state itself into r would have T decide both how fast r is
/// reached, seconds, and how long the springs swing on, q⃛ T³ far, where the springs of a robot know milliseconds. `Stop`
/// has its own. A robot at rest has p = q_0, and nothing of it is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStart<C, R, const N: usize> {
    /// How the robot moves at t_0, and how it would come to rest.
    pub from: Stop<C, N>,
    /// Time T that the transition takes in s, from t_0 = `from.start` on; `duration` > 0 is the caller's duty.
    pub duration: C,
    /// The reference r to join; it must be finite at every t, before the start too.
    pub then: R,
}

impl<C: Scalar, R, const N: usize> SmoothStart<C, R, N> {
    /// From rest at `q_0` in rad at t = 0, reaching `then` after `duration` in s.
    #[inline]
    pub fn from_rest(q_0: Vector<C, N>, duration: C, then: R) -> Self {
        let from = Stop { from: q_0.map(Jet::value), start: C::ZERO, duration };
        Self { from, duration, then }
    }
}

impl<C: Scalar, R: Reference<C, N>, const N: usize> Reference<C, N> for SmoothStart<C, R, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let done = fraction(t, self.from.start, self.duration);
        Smoothstep::Nonic.blend_all(&self.from.on(t), &self.then.on(t), done)
    }

    /// With the derivatives of r as it finds them fastest.
    #[inline]
    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        let done = Line::fraction(t, self.from.start, self.duration);
        Smoothstep::Nonic.blend_all(&self.from.at(t), &self.then.at(t), done)
    }
}
