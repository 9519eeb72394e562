//! Reference trajectories: functions of time, written once, whose derivatives come from the number they run on.
//!
//! A trajectory is one function t ↦ q_d(t) in rad, written over a number type. On `f64` it is the position; on a
//! [`Jet`] the position with its exact time derivatives, which is what a control law asks for; on a
//! [`Dual`](crate::scalar::Dual) a sensitivity; on an interval of time an enclosure of every position taken in it.
//!
//! | reference | is | continuous up to derivative |
//! | --- | --- | --- |
//! | [`Vector`] | a set point | all |
//! | [`Sine`], [`Multisine`] | oscillation about an offset | all |
//! | [`PointToPoint`] | rest to rest between two postures | 2, 3 or 4 ([`Smoothstep`]) |
//! | [`Stop`] | to rest from any motion | 4 |
//! | [`SmoothStart`] | any other, joined from the robot's motion | 4, or those of the other |
//! | [`Retimed`] | any other, along a [`Clock`] | 4 or all, or those of the other |
//!
//! The laws on flexible joints use four derivatives: a reference that is C⁴ asks for a continuous motor torque, one
//! that is C³ for a torque with steps, anything less for infinite torque.

mod argument;
mod multisine;
mod point_to_point;
mod retimed;
mod set_point;
mod sine;
mod smooth_start;
mod smoothstep;
mod stop;

pub use multisine::{Multisine, Term};
pub use point_to_point::PointToPoint;
pub use retimed::{Clock, Retimed};
pub use sine::Sine;
pub use smooth_start::SmoothStart;
pub use smoothstep::Smoothstep;
pub use stop::Stop;

use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// A trajectory of `N` joints, with constants of type `C`.
///
/// ```
/// use flexure_core::linalg::Vector;
/// use flexure_core::reference::{Reference, Sine};
///
/// // sin t for one joint: at t = 0 position 0, velocity 1, acceleration 0, jerk −1.
/// let q_d = Sine { amplitude: Vector([1.0]), frequency: Vector([1.0]), ..Sine::ZERO };
/// let [jet] = q_d.at::<4>(0.0).0;
/// assert_eq!([0, 1, 2, 3].map(|k| jet.derivative(k)), [0.0, 1.0, 0.0, -1.0]);
/// ```
///
/// A reference of one's own, whose derivatives come of themselves:
///
/// ```
/// use flexure_core::linalg::Vector;
/// use flexure_core::reference::Reference;
/// use flexure_core::scalar::{Over, Piecewise, Scalar};
///
/// /// q_d = rate t², joint by joint.
/// struct Parabola<C, const N: usize> {
///     /// Half the acceleration [rad/s²].
///     rate: Vector<C, N>,
/// }
///
/// impl<C: Scalar, const N: usize> Reference<C, N> for Parabola<C, N> {
///     fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
///         Vector::from_fn(|i| t.square().scale(self.rate[i]))
///     }
/// }
///
/// let [jet] = Parabola { rate: Vector([2.0]) }.at::<4>(3.0).0;
/// assert_eq!([0, 1, 2, 3].map(|k| jet.derivative(k)), [18.0, 12.0, 4.0, 0.0]);
/// ```
pub trait Reference<C: Scalar, const N: usize> {
    /// Position in rad at time `t` in s.
    ///
    /// Written over every number that can choose between pieces: where two pieces meet, a derivative that they do not
    /// share is that of one of them, and the documentation of the reference says which.
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N>;

    /// Position in rad and its time derivatives in rad/sᵏ at time `t` in s, as jets of `K` coefficients.
    ///
    /// This is [`on`](Self::on) evaluated at the time variable. Override it only to find the same numbers faster.
    #[inline]
    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        self.on(Jet::variable(t))
    }
}

impl<C: Scalar, R: Reference<C, N>, const N: usize> Reference<C, N> for &R {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        (*self).on(t)
    }
    #[inline]
    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        (*self).at(t)
    }
}
