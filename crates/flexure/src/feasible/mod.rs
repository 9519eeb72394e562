//! Does a reference keep the limits of the robot, and how fast may it be run along?
//!
//! A flexible-joint robot is flat: the trajectory of its links decides motor torques, their rates, deflections and
//! velocities, by exact inverse dynamics on Taylor series. They are looked at every control period and at least a thousand
//! times a run, and once more at the top of each hump between. That is a dense sample, not a proof: bounds over
//! whole spans of time are those of [`along`](crate::prove::along). And it is the reference that is asked, not the loop: a robot that starts off its
//! reference needs more than the reference does.

mod bounds;
mod effort;
mod peaks;
mod reference;
mod search;
mod track;

use serde::Serialize;

use crate::feasible::bounds::bounds;
use crate::feasible::peaks::{PacedReference, peaks};
use crate::feasible::track::with_track;
use crate::files::number::short;
use crate::files::{Problem, Problems};
use crate::references::Speed;
use crate::scenario::Scenario;

pub(crate) use crate::feasible::bounds::limit_words;
pub use crate::feasible::effort::{effort, peak_torque};
pub(crate) use crate::feasible::reference::at_speed;
pub use crate::feasible::reference::{enclosed_reference, reference};
pub use crate::feasible::search::speed;

/// The largest share of a limit that is used along the reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Usage {
    /// Index of the joint, from 0.
    pub joint: usize,
    /// The limit's key in robot files.
    pub key: &'static str,
    /// The limit from the robot file, in the unit of the quantity.
    pub limit: f64,
    /// What comes closest to it, or is farthest beyond: N m, N m/s, rad or rad/s.
    pub value: f64,
    /// Part of the limit that this is: above 1 the limit is exceeded. Of a position, the distance from the middle of its
    /// range over half of that; where the range is open on one side, 0 inside and infinite outside.
    pub share: f64,
    /// Time of the largest value in s.
    pub time: f64,
}

/// What the reference of `scenario` uses of each limit in the robot's file, joint by joint; nothing for a robot without
/// limits. Torques that jump, or are infinite, because the reference is not smooth enough have an infinite rate or value.
///
/// # Errors
/// If the robot has too many joints, the samples of the reference make no path, or no speed keeps it inside the limits.
pub fn usage(scenario: &Scenario) -> Result<Vec<Usage>, Problems> {
    let speed = speed(scenario)?;
    with_track(scenario, |track| {
        let bounds = bounds(&scenario.robot);
        let peaks = peaks(&PacedReference::new(scenario, track, speed), &bounds, search::fine(scenario));
        bounds.iter().zip(peaks).map(|(bound, peak)| bound.usage(&peak)).collect()
    })
}

/// What to say of each limit that the reference exceeds.
pub fn exceeded(scenario: &Scenario, usage: &[Usage]) -> Vec<Problem> {
    let beyond = usage.iter().filter(|usage| usage.share > 1.0 || usage.share.is_nan());
    beyond
        .map(|usage| {
            let message = format!("the reference exceeds a limit: {}", described(scenario, usage));
            let help = if bounds::is_position(usage.key) {
                "no speed mends that: choose another path, or end points inside the limits"
            } else {
                "run along it slower, [reference.time_scaling] with margin = 0.9 finds a speed; or join it in a longer \
                 smooth_start.duration, a moving robot with a shorter smooth_start.settle"
            };
            scenario.places.problem("reference", "limits", message, help)
        })
        .collect()
}

/// Part of its own speed below which a reference is hardly a motion.
const SLOW: f64 = 0.2;

/// What to say of a reference that a time scaling makes so slow that a loop which follows it has shown little.
///
/// # Errors
/// As [`speed`].
pub fn slowed(scenario: &Scenario) -> Result<Option<Problem>, Problems> {
    let scenario = &pinned(scenario)?;
    let speed = speed(scenario)?;
    if speed >= SLOW {
        return Ok(None);
    }
    let usage = usage(scenario)?;
    let tightest = usage.iter().max_by(|a, b| a.share.total_cmp(&b.share));
    let what = tightest.map_or_else(String::new, |usage| format!(": {}", described(scenario, usage)));
    let message = format!(
        "the reference is run along at {} of its own speed, to keep the limits; a loop that follows so little motion has shown little{what}",
        short(speed, 3)
    );
    let help = "choose a posture (reference.offset) that takes less torque to hold, or correct that limit in the robot file";
    Ok(Some(scenario.places.problem("reference", "slow", message, help).warning()))
}

/// The scenario with the speed of its reference found and written down, so that many runs need not search for it.
///
/// # Errors
/// As [`speed`].
pub fn pinned(scenario: &Scenario) -> Result<Scenario, Problems> {
    let mut pinned = scenario.clone();
    if let Some(scaling) = &mut pinned.time_scaling {
        scaling.speed = Speed::Given(speed(scenario)?);
    }
    Ok(pinned)
}

/// A usage in words.
fn described(scenario: &Scenario, usage: &Usage) -> String {
    let robot = &scenario.robot;
    let joint = &robot.joints[usage.joint];
    let (what, unit) = limit_words(usage.key, joint.kind);
    let share = if usage.share.is_finite() { format!(", {:.3} of it", usage.share) } else { String::new() };
    format!(
        "joint {}: {what} of {:.4} {unit} at t = {:.4} s, where {} is {} {unit}{share}",
        joint.name, usage.value, usage.time, usage.key, usage.limit
    )
}
