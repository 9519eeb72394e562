//! One control instant of a guard.

use super::inputs::Faults;
use super::limits::allowed;
use super::{Age, Phase, Settings, Status};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::Motion;
use crate::scalar::{Float, Piecewise};

/// What leaves the controller at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision<C, const N: usize> {
    /// Motor torque [N m]: finite and inside the limits.
    pub torque: Vector<C, N>,
    /// Where it comes from.
    pub status: Status<N>,
}

/// Stands between a law and the motors.
///
/// The laws have no state, so that a limit that is hit winds nothing up: the torque is the law's again as soon as the
/// limits allow it, and it never jumps by more than the rate limit times the period, neither on release nor into a stop nor
/// out of it. Estimators are fed the torque that leaves here.
#[derive(Clone, Copy, Debug)]
pub struct Guard<C, const N: usize> {
    settings: Settings<C, N>,
    /// The torque that left last [N m].
    last: Vector<C, N>,
    /// Link positions of the last good reading in rad.
    posture: Option<Vector<C, N>>,
    /// Good readings still wanted before the law takes over; 0 while it decides.
    awaited: u32,
}

/// The last `torque` [N m]; `good`, whether there was a good reading; its link positions `posture` in rad; good readings
/// still `awaited`. Whatever is restored, the torque is brought inside the limits, and no more is awaited than the settings ask.
impl<C: Float, const N: usize> Memory<C> for Guard<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        let mut last = self.last;
        port.joints("torque", "N m", &mut last.0);
        port.optional("good", &mut self.posture, Vector::ZERO, |posture, port| {
            port.joints("posture", "rad", &mut posture.0);
        });
        port.word("awaited", &mut self.awaited);
        self.awaited = self.awaited.min(self.settings.rejoin_after);
        *self = self.applying(&last);
    }
}

impl<C: Float, const N: usize> Guard<C, N> {
    /// Following, at zero torque. `None` for settings that are not [sound](Settings::are_sound).
    pub fn new(settings: Settings<C, N>) -> Option<Self> {
        settings.are_sound().then_some(Self { settings, last: Vector::ZERO, posture: None, awaited: 0 })
    }

    /// As if `torque` [N m] were what left it last: the rate limit counts from there. What is not finite counts as zero, what is
    /// beyond the torque limit as the limit.
    #[must_use]
    pub fn applying(mut self, torque: &Vector<C, N>) -> Self {
        let limit = &self.settings.torque_limit;
        let finite = |x: C| if x.is_finite() { x } else { C::ZERO };
        self.last = Vector::from_fn(|i| Piecewise::clamp(finite(torque[i]), -limit[i], limit[i]));
        self
    }

    /// What it allows.
    #[inline]
    pub fn settings(&self) -> &Settings<C, N> {
        &self.settings
    }

    /// One control instant. `x` is the estimated motion, NaN where there is none; `age` says how old the readings are that it
    /// comes from. `law` gives the motor torque at `x` [N m] and is called only if the law is to decide; its result may be anything.
    /// `holding` gives the torque that holds the robot at a posture against gravity [N m]; called only during a stop.
    ///
    /// A bad reading or a law that fails stops the robot in the same instant: holding torque of the last good posture
    /// (none before the first), less damping on the motors whose velocity is still good, within the limits.
    #[inline]
    pub fn step(
        &mut self,
        x: &Motion<C, N>,
        age: Age,
        law: impl FnOnce(&Motion<C, N>) -> Vector<C, N>,
        holding: impl FnOnce(&Vector<C, N>) -> Vector<C, N>,
    ) -> Decision<C, N> {
        let faults = Faults::of(&self.settings, x, age);
        let good = !faults.any();
        if good {
            self.posture = Some(x.q_l);
        }
        let asked = (good && self.awaited == 0).then(|| law(x));
        let law_failed = asked.is_some_and(|torque| !torque.iter().all(C::is_finite));
        let phase = self.phase(good && !law_failed);
        let asked = match asked {
            Some(torque) if !law_failed => torque,
            _ => self.stopping(x, &faults, holding),
        };
        let allowed = allowed(&self.settings, &self.last, &asked);
        self.last = allowed.torque;
        let status = Status {
            phase,
            torque_limited: allowed.torque_limited,
            rate_limited: allowed.rate_limited,
            link_fault: faults.link,
            motor_fault: faults.motor,
            law_failed,
        };
        Decision { torque: allowed.torque, status }
    }

    /// Counts good instants: one that is not starts the count over.
    #[inline]
    fn phase(&mut self, good: bool) -> Phase {
        match (good, self.awaited) {
            (false, _) => {
                self.awaited = self.settings.rejoin_after;
                Phase::Stopped
            }
            (true, 0) => Phase::Following,
            (true, 1) => {
                self.awaited = 0;
                Phase::Rejoined
            }
            (true, _) => {
                self.awaited = self.awaited.saturating_sub(1);
                Phase::Stopped
            }
        }
    }

    /// Torque that brings the robot to rest: whatever is not finite counts as 0.
    #[inline]
    fn stopping(
        &self,
        x: &Motion<C, N>,
        faults: &Faults<N>,
        holding: impl FnOnce(&Vector<C, N>) -> Vector<C, N>,
    ) -> Vector<C, N> {
        let finite = |x: C| if x.is_finite() { x } else { C::ZERO };
        let held = self.posture.map_or(Vector::ZERO, |q| holding(&q)).map(finite);
        Vector::from_fn(|i| match faults.motor[i] {
            None => finite(held[i] - self.settings.stop_damping[i] * x.v_m[i]),
            Some(_) => held[i],
        })
    }
}
