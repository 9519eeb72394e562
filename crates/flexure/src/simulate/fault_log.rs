//! What a guard kept of a run, in words and SI units.

use flexure_core::guard::{Entry, Log, Place, Step};
use flexure_core::linalg::Vector;
use serde::Serialize;

/// Why and when the guard stopped the robot: `faults` of `run --json`.
#[derive(Clone, Debug, Serialize)]
pub struct FaultLog {
    /// How many stops there were; the last 16 are kept.
    pub count: u32,
    /// The last stops, the oldest first.
    pub stops: Vec<Stopped>,
    /// The last control instants up to the first stop, that one included; up to now without one.
    pub steps: Vec<LoggedStep>,
}

/// A stop.
#[derive(Clone, Debug, Serialize)]
pub struct Stopped {
    /// When in s.
    pub time: f64,
    /// The first thing that was wrong.
    pub cause: &'static str,
    /// `link` or `motor`; none for the controller itself.
    pub side: Option<&'static str>,
    /// Index of the joint; none for the controller itself.
    pub joint: Option<u32>,
}

/// A control instant, a number per joint each.
#[derive(Clone, Debug, Serialize)]
pub struct LoggedStep {
    /// When in s.
    pub time: f64,
    /// What the guard did.
    pub phase: &'static str,
    /// Link positions as the controller saw them, in rad; NaN (null in JSON) where it saw nothing.
    pub q_l: Vec<f64>,
    /// Motor positions in rad.
    pub q_m: Vec<f64>,
    /// Link velocities [rad/s].
    pub dq_l: Vec<f64>,
    /// Motor velocities [rad/s].
    pub dq_m: Vec<f64>,
    /// Torque that left the guard [N m].
    pub u_command: Vec<f64>,
}

impl FaultLog {
    /// Of a robot with so many `joints`, with control periods of `period` in s.
    pub(crate) fn new<const N: usize>(log: &Log<f64, N>, joints: usize, period: f64) -> Self {
        let seconds = |time: u64| time as f64 * period;
        let stop = |Entry { time, cause, place }: Entry| {
            let (side, joint) = match place {
                Place::Controller => (None, None),
                Place::Link(joint) => (Some("link"), Some(joint)),
                Place::Motor(joint) => (Some("motor"), Some(joint)),
            };
            Stopped { time: seconds(time), cause: cause.name(), side, joint }
        };
        let list = |v: &Vector<f64, N>| v.iter().take(joints).collect();
        let step = |Step { time, phase, x, torque }: Step<f64, N>| LoggedStep {
            time: seconds(time),
            phase: phase.name(),
            q_l: list(&x.q_l),
            q_m: list(&x.q_m),
            dq_l: list(&x.v_l),
            dq_m: list(&x.v_m),
            u_command: list(&torque),
        };
        Self {
            count: log.count(),
            stops: log.entries().map(stop).collect(),
            steps: log.steps().map(step).collect(),
        }
    }
}
