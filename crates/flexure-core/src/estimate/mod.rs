//! From encoder readings to the motion that a law needs: velocities, positions that no encoder sees, torques that no
//! model knows. docs/estimators.md.
//!
//! These run on plain floats ([`Float`]), between sensors and law. A reading that is not a number makes the estimate not a
//! number where it would have been used, so that a [`Guard`](crate::guard::Guard) sees it in the same step; the estimator's
//! own state stays finite and goes on with the next good reading.

mod difference;
mod disturbance;
mod low_pass;
mod motor_observer;
mod observer;
mod placement;
mod prediction;
mod reading;

pub use difference::FilteredDifference;
pub use disturbance::{Disturbance, DisturbanceObserver};
pub use low_pass::LowPass;
pub use motor_observer::MotorObserver;
pub use observer::Observer;

use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Where the robot is and how it moves, from encoders: called once per control period.
pub trait Estimator<C: Float, const N: usize> {
    /// Starts over, as if the robot had been seen to move like `x`: positions in rad, velocities [rad/s].
    fn start(&mut self, x: &Motion<C, N>);

    /// The estimated motion at a control instant, from encoder readings in rad (an estimator that does not use one
    /// ignores it) and the motor torque that was applied since the last instant [N m]: after all limits, which is why a
    /// limit that is hit disturbs no estimate.
    fn update<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        q_l: &Vector<C, N>,
        q_m: &Vector<C, N>,
        u_m: &Vector<C, N>,
    ) -> Motion<C, N>;
}

/// The robot a control period of `period` in s after it moved as `x`, under the motor torque `u_m` [N m]: by the trapezoidal rule, as
/// the observers predict, with an error of the third order in the period.
#[inline]
pub fn ahead<C: Float, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    x: &Motion<C, N>,
    u_m: &Vector<C, N>,
    period: C,
) -> Motion<C, N> {
    prediction::predict(robot, x, u_m, period, None)
}

/// Whether `x` is a finite number above 0.
#[inline]
pub(crate) fn positive<C: Float>(x: C) -> bool {
    x.is_finite() && x > C::ZERO
}
