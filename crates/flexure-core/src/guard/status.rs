//! What a guard says of a control instant.

use super::Fault;
use crate::linalg::Vector;

/// Who decides the motor torque of a control instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The law decides.
    Following,
    /// The guard decides: the robot is being stopped.
    Stopped,
    /// The guard decides for the last time: from the next instant on it is the law again. Now is when the loop starts its
    /// estimator over and joins the reference smoothly from where the robot is.
    Rejoined,
}

/// What a guard reports of a control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status<const N: usize> {
    /// Who decided the torque.
    pub phase: Phase,
    /// Joints at their torque limit.
    pub torque_limited: Vector<bool, N>,
    /// Joints at their torque-rate limit.
    pub rate_limited: Vector<bool, N>,
    /// What is wrong with the readings of the links.
    pub link_fault: Vector<Option<Fault>, N>,
    /// What is wrong with the readings of the motors.
    pub motor_fault: Vector<Option<Fault>, N>,
    /// Whether the law gave a torque that is not finite.
    pub law_failed: bool,
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
pub struct Suspension {
    /// A joint is at its torque limit.
    pub torque_limited: bool,
    /// A joint is at its torque-rate limit.
    pub rate_limited: bool,
    /// The guard decides the torque, not the law.
    pub stopped: bool,
}

impl<const N: usize> Status<N> {
    /// Whether a certificate of the closed loop can hold at this instant.
    #[inline]
    pub fn certificate(&self) -> Certificate {
        let any = |joints: &Vector<bool, N>| joints.iter().any(|active| active);
        let suspension = Suspension {
            torque_limited: any(&self.torque_limited),
            rate_limited: any(&self.rate_limited),
            stopped: self.phase != Phase::Following,
        };
        if suspension == (Suspension { torque_limited: false, rate_limited: false, stopped: false }) {
            Certificate::Holds
        } else {
            Certificate::Suspended(suspension)
        }
    }
}
