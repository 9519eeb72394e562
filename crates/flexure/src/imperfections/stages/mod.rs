//! What sensors, computer and drives do to a control loop: one stage each, none of them there unless asked for.
//!
//! Once a control period [`Sensors`] turn the true motion into what is measured, if the [`Computer`] runs, and an [`Actuator`] turns
//! the commanded torque into what acts on the motors. Stages work on slices with an entry for each joint that the robot has; joints that
//! only fill the capacity of a vector are never touched, and no random number is drawn for them. All memory is taken when
//! stages are made.

mod actuator;
mod computer;
mod held;
mod late;
mod pieces;
mod random;
mod sensors;

pub use actuator::{Actuating, Actuator};
pub use computer::{Computer, Missing};
pub(crate) use held::Held;
pub(crate) use late::split;
pub use pieces::Pieces;
pub use random::Random;
pub use sensors::{Measured, Readings, Sensing, Sensors};

/// Links first, motors second: the order of everything that is given per side.
pub type PerSide<T> = [T; 2];

/// A control instant. Instants come one after the other from k = 0 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Which one.
    pub k: u64,
    /// When \[s\].
    pub t: f64,
    /// Until the next one \[s\].
    pub period: f64,
}

/// Part of a control period by which an instant may be early: times of instants are products, and rounded.
const EARLY: f64 = 1e-9;

impl Tick {
    /// Whether it is in [`from`, `until`) \[s\].
    pub(crate) fn is_within(&self, from: f64, until: f64) -> bool {
        let t = self.t + EARLY * self.period;
        from <= t && t < until
    }

    /// Instant `k` of a loop with control periods of `period` \[s\].
    pub fn new(k: u64, period: f64) -> Self {
        Self { k, t: k as f64 * period, period }
    }
}
