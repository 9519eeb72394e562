//! What a guard says of a control instant.

use super::faults::Faults;
use super::{Fault, Phase, Place};
use crate::linalg::Vector;

/// What a guard reports of a control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status<const N: usize> {
    /// Who decided the torque.
    pub phase: Phase,
    /// Joints at their torque limit.
    pub torque_limited: Vector<bool, N>,
    /// Joints at their torque-rate limit.
    pub rate_limited: Vector<bool, N>,
    /// Joints whose links are farther from the reference than [`region`](super::Settings::region).
    pub outside: Vector<bool, N>,
    /// What is wrong with the readings of the links.
    pub link_fault: Vector<Option<Fault>, N>,
    /// What is wrong with the readings of the motors.
    pub motor_fault: Vector<Option<Fault>, N>,
    /// What is wrong with the controller: its law, or its time.
    pub controller_fault: Option<Fault>,
    /// Whether the torque goes over from that of a stop to the law's.
    pub joining: bool,
    /// Whether the stop lasts until [`reset`](super::Guard::reset).
    pub latched: bool,
}

/// Whether what is proved of the closed loop can hold at this instant. A certificate speaks of the law without limits, on
/// true states: a guard sees when the torque was not the law's. What it can not see (delay, estimation errors, a wrong
/// model) is not in here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certificate {
    /// It can: the torque is the law's.
    Holds,
    /// It cannot: the torque is not the law's, for these reasons.
    Suspended(Suspension),
}

/// Why a certificate does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "reasons that do not exclude each other")]
pub struct Suspension {
    /// A joint is at its torque limit.
    pub torque_limited: bool,
    /// A joint is at its torque-rate limit.
    pub rate_limited: bool,
    /// A link is outside of the region that a proof speaks of.
    pub outside: bool,
    /// The law went by a motion that in part was predicted.
    pub coasting: bool,
    /// The torque goes over from that of a stop to the law's.
    pub joining: bool,
    /// The guard decides the torque, not the law.
    pub stopped: bool,
}

impl Suspension {
    /// No reason.
    pub const NONE: Self = Self {
        torque_limited: false,
        rate_limited: false,
        outside: false,
        coasting: false,
        joining: false,
        stopped: false,
    };
}

impl<const N: usize> Status<N> {
    /// The first thing that is wrong, and where; none if nothing is.
    #[inline]
    pub fn fault(&self) -> Option<(Fault, Place)> {
        let Self { link_fault: link, motor_fault: motor, controller_fault: controller, .. } = *self;
        Faults { link, motor, controller }.first()
    }

    /// Whether a certificate of the closed loop can hold at this instant.
    #[inline]
    pub fn certificate(&self) -> Certificate {
        let any = |joints: &Vector<bool, N>| joints.iter().any(|active| active);
        let suspension = Suspension {
            torque_limited: any(&self.torque_limited),
            rate_limited: any(&self.rate_limited),
            outside: any(&self.outside),
            coasting: self.phase == Phase::Coasting,
            joining: self.joining,
            stopped: !self.phase.is_law_s(),
        };
        if suspension == Suspension::NONE { Certificate::Holds } else { Certificate::Suspended(suspension) }
    }
}
