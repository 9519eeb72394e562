//! What a guard allows.

use crate::estimate::positive;
use crate::linalg::Vector;
use crate::scalar::Float;

/// Limits of a [`Guard`](super::Guard).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<C, const N: usize> {
    /// Control period in s.
    pub period: C,
    /// Largest motor torque [N m]; infinite for none.
    pub torque_limit: Vector<C, N>,
    /// Fastest change of the motor torque [N m/s]; infinite for none.
    pub torque_rate_limit: Vector<C, N>,
    /// Damping on the motors during a stop [N m s/rad].
    pub stop_damping: Vector<C, N>,
    /// Age in control periods up to which a reading counts as fresh.
    pub allowed_age: u32,
    /// Consecutive good readings after which the law takes over again, at least 1.
    pub rejoin_after: u32,
    /// Largest believable position of links and motors in rad; infinite for none.
    pub position_bound: Vector<C, N>,
    /// Largest believable speed of links and motors [rad/s]; infinite for none.
    pub speed_bound: Vector<C, N>,
}

impl<C: Float, const N: usize> Settings<C, N> {
    /// Whether a guard can keep to them: nothing NaN or negative, the period finite and positive, limits positive,
    /// damping finite.
    pub fn are_sound(&self) -> bool {
        let above_zero = |x: C| x > C::ZERO;
        positive(self.period)
            && self.torque_limit.iter().all(above_zero)
            && self.torque_rate_limit.iter().all(above_zero)
            && self.stop_damping.iter().all(|d| d.is_finite() && d >= C::ZERO)
            && self.rejoin_after > 0
            && self.position_bound.iter().all(above_zero)
            && self.speed_bound.iter().all(above_zero)
    }
}
