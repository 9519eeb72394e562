//! Joining a moving reference from rest.

use super::{Reference, Smoothstep};
use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

/// Any reference r, joined from rest at q_0: q_d(t) = q_0 + s(t / T) (r(t) − q_0) with the nonic [`Smoothstep`].
///
/// A robot at rest that is asked to be on a sine at once answers with torques of thousands of N m. This reference starts
/// where the robot is and is r, exactly, from t = T on.
///
/// It is C⁴ wherever r is. By Leibniz, derivative k of q_d is Σ_j C(k, j) s⁽ʲ⁾(t / T) T⁻ʲ (r − q_0)⁽ᵏ⁻ʲ⁾(t). At t = 0
/// every s⁽ʲ⁾ with j ≤ 4 is zero, so (q_d, q̇_d, …, q_d⁗) = (q_0, 0, …, 0); at t = T all are zero but s = 1, so the first
/// four derivatives are those of r. The fifth jumps at both ends, by 15120 (r(0) − q_0) / T⁵ and
/// 15120 (r(T) − q_0) / T⁵; there it is that of the transition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStart<C, R, const N: usize> {
    /// Posture at rest up to t = 0 in rad.
    pub from: Vector<C, N>,
    /// Time T that the transition takes in s; `duration` > 0 is the caller's duty.
    pub duration: C,
    /// The reference r to join; it must be finite at every t, before the start too.
    pub then: R,
}

impl<C: Scalar, R: Reference<C, N>, const N: usize> Reference<C, N> for SmoothStart<C, R, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let tau = t.scale(self.duration.recip());
        let (progress, r) = (Smoothstep::Nonic.at(tau), self.then.on(t));
        Vector::from_fn(|i| progress.between(T::constant(self.from[i]), r[i]))
    }
}
