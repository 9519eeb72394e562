//! What a guard allows.

use super::log::ENTRIES;
use super::{Collision, Plausible};
use crate::estimate::positive;
use crate::linalg::Vector;
use crate::scalar::Float;

/// Limits of a [`Guard`](super::Guard). [`Settings::open`] allows everything: give what matters and take the rest from
/// there.
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
    /// Age in control periods up to which a reading counts as good: that long the law goes on without one.
    pub allowed_age: u32,
    /// What is believed.
    pub plausible: Plausible<C, N>,
    /// What is done when something pushes a link; none to let it push.
    pub collision: Option<Collision<C, N>>,
    /// How far the links may be from the reference in rad for what is proved of the loop to hold; infinite where nothing is said of that.
    /// Beyond it nothing is done: the status tells.
    pub region: Vector<C, N>,
    /// When the law may take over again.
    pub rejoin: Rejoin<C, N>,
    /// Control periods of a stop after which no torque is given any more, until [`reset`](super::Guard::reset); none to hold for ever.
    pub off_after: Option<u32>,
    /// When a robot that keeps stopping stays stopped.
    pub latch: Option<Latch>,
}

/// When the law may take over from a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejoin<C, const N: usize> {
    /// Consecutive good readings that are waited for, at least 1.
    pub after: u32,
    /// Largest speed of links and motors [rad/s]; infinite for any.
    pub speed: Vector<C, N>,
    /// Largest distance of the links from where they shall be in rad; infinite for any.
    pub error: Vector<C, N>,
}

/// So many stops in so short a time need somebody to look: the last of them lasts until [`reset`](super::Guard::reset).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Latch {
    /// How many, from 1 to [`Log::CAPACITY`](super::Log::CAPACITY).
    pub stops: u32,
    /// Within how many control periods, the last one included.
    pub within: u32,
}

impl<C: Float, const N: usize> Settings<C, N> {
    /// No limits: stops for readings that are not there and a law that fails, at once, without damping, and goes on with
    /// the first good reading. `period` is the control period in s.
    pub fn open(period: C) -> Self {
        let any = Vector([C::INFINITY; N]);
        Self {
            period,
            torque_limit: any,
            torque_rate_limit: any,
            stop_damping: Vector::ZERO,
            allowed_age: 0,
            plausible: Plausible::ANYTHING,
            collision: None,
            region: any,
            rejoin: Rejoin { after: 1, speed: any, error: any },
            off_after: None,
            latch: None,
        }
    }

    /// Whether a guard can keep to them: nothing NaN or negative, the period finite and positive, limits positive,
    /// damping finite.
    pub fn are_sound(&self) -> bool {
        let above_zero = |x: C| x > C::ZERO;
        let Rejoin { after, speed, error } = &self.rejoin;
        positive(self.period)
            && self.torque_limit.iter().all(above_zero)
            && self.torque_rate_limit.iter().all(above_zero)
            && self.stop_damping.iter().all(|d| d.is_finite() && d >= C::ZERO)
            && self.region.iter().all(above_zero)
            && *after > 0
            && speed.iter().all(above_zero)
            && error.iter().all(above_zero)
            && self.plausible.is_sound()
            && self.collision.is_none_or(|collision| collision.threshold.iter().all(above_zero))
            && self.latch.is_none_or(|latch| (1..=ENTRIES).contains(&(latch.stops as usize)))
    }
}
