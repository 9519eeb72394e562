//! A path run along at another speed.

use super::{Reference, Smoothstep};
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// Another clock: how far along a reference the motion is, s(t) in s of the reference's own time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock<C> {
    /// At a constant speed: s = ρ t.
    Steady {
        /// ρ, seconds of the reference per second.
        speed: C,
    },
    /// At rest at s = 0 up to t = 0, then faster and faster until ṡ = ρ at t = T, and so on: ṡ = ρ s_7(t / T) with the septic
    /// [`Smoothstep`], s its exact integral, ρ (t − T / 2) in the end. C⁴; the fifth derivative jumps at 0 and T.
    FromRest {
        /// ρ, seconds of the reference per second, reached in the end.
        speed: C,
        /// T, the time that takes in s; `rise` > 0 is the caller's duty.
        rise: C,
    },
}

impl<C: Scalar> Clock<C> {
    /// s(t), the time of the reference in s, at time `t` in s.
    #[inline]
    pub fn on<T: Over<C> + Piecewise>(&self, t: T) -> T {
        match *self {
            Self::Steady { speed } => t.scale(speed),
            Self::FromRest { speed, rise } => {
                Smoothstep::Septic.integral(t.scale(rise.recip())).scale(speed * rise)
            }
        }
    }
}

/// The reference r along a [`Clock`]: q_d(t) = r(s(t)). It passes the same postures, at other times.
///
/// By the chain rule q̇_d = ṡ r', q̈_d = ṡ² r'' + s̈ r', and so on: at half the speed a sixteenth of the fourth derivative.
/// As smooth as the less smooth of r and the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retimed<C, R> {
    /// The clock: s(t), how far along the reference the motion is at time t.
    pub clock: Clock<C>,
    /// The reference r, in its own time.
    pub path: R,
}

impl<C: Scalar, R: Reference<C, N>, const N: usize> Reference<C, N> for Retimed<C, R> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        self.path.on(self.clock.on(t))
    }

    /// The jet of r, as it finds it fastest, composed with that of the clock.
    #[inline]
    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        let s = self.clock.on(Jet::<C, K>::variable(t));
        self.path.at(s.coefficient(0)).map(|r| r.compose(&s))
    }
}
