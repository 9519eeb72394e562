//! `[reference]`: where the links shall be.

use crate::files::base::Base;
use crate::files::field::{Field, Joints};
use crate::files::quantity;
use crate::references::registry::Context;
use crate::references::{NAMES, Reference};

/// Longest time in s in which a moving robot comes to rest if nothing is said: springs swing faster, and a jerk carries the
/// reference on by its cube.
const SETTLE: f64 = 0.25;

/// How the robot joins the reference from where it is and how it moves at t = 0: `[reference.smooth_start]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStart {
    /// Time in which the reference is reached \[s\].
    pub duration: f64,
    /// Time in which the robot's own motion would come to rest; `duration` unless given \[s\].
    pub settle: f64,
}

impl SmoothStart {
    /// Reaching the reference, and the end of the robot's own motion, in `duration` seconds.
    pub const fn within(duration: f64) -> Self {
        Self { duration, settle: duration.min(SETTLE) }
    }
}

/// Another clock for the reference: `[reference.time_scaling]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeScaling {
    /// Seconds of the reference per second of the run.
    pub speed: Speed,
    /// Time in which the clock gets from rest to its speed, if it does not run at it from the start \[s\].
    pub rise: Option<f64>,
}

/// How fast a clock goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// As given, > 0.
    Given(f64),
    /// The largest up to 1 that [`feasible`](crate::feasible) finds for this share of the robot's limits, > 0 and ≤ 1.
    Within(f64),
}

/// A reference with what is done to it.
pub(crate) struct Timed {
    pub reference: Reference,
    pub smooth_start: Option<SmoothStart>,
    pub time_scaling: Option<TimeScaling>,
}

/// Keys of every kind.
const COMMON: &[&str] = &["kind", "smooth_start", "time_scaling"];

/// Reads `[reference]` for a run of `end` seconds (NaN if that is not known).
pub(crate) fn read(field: &Field<'_>, joints: &Joints, base: &Base, end: f64) -> Option<Timed> {
    let table = field.any_table()?;
    let smooth_start = table.optional("smooth_start", smooth_start);
    let time_scaling = table.optional("time_scaling", time_scaling);
    let name = table.choice("kind", &NAMES.map(|name| (name.entry.name, name)))?;
    table.refuse_unknown(&[COMMON, name.keys].concat());
    let speed = match time_scaling {
        Some(Some(TimeScaling { speed: Speed::Given(speed), .. })) => speed,
        Some(Some(TimeScaling { speed: Speed::Within(_), .. }) | None) | None => 1.0,
    };
    let reference = (name.read)(&table, &Context { joints, base, end: end * speed });
    Some(Timed { reference: reference?, smooth_start: smooth_start?, time_scaling: time_scaling? })
}

fn smooth_start(field: &Field<'_>) -> Option<SmoothStart> {
    let table = field.table(&["duration", "settle"])?;
    let duration = table.number("duration", &quantity::DURATION);
    let settle = table.optional("settle", |field| field.number(&quantity::DURATION));
    let (duration, settle) = (duration?, settle?);
    Some(SmoothStart { duration, settle: settle.unwrap_or(duration.min(SETTLE)) })
}

fn time_scaling(field: &Field<'_>) -> Option<TimeScaling> {
    let table = field.table(&["speed", "margin", "rise"])?;
    let rise = table.optional("rise", |field| field.number(&quantity::DURATION));
    let speed = match (table.get("speed"), table.get("margin")) {
        (Some(speed), None) => speed.number(&quantity::SPEED_OF_TIME).map(Speed::Given),
        (None, Some(margin)) => share(&margin).map(Speed::Within),
        (given, _) => {
            let (what, help) =
                (given.map_or("neither", |_| "both"), "speed = 0.5, or margin = 0.9 to have it found");
            let message =
                format!("{}: {what} of speed and margin are given, must be one of them", field.path);
            field.error("time-scaling", message, help);
            None
        }
    };
    Some(TimeScaling { speed: speed?, rise: rise? })
}

/// A share of limits, up to all of them.
fn share(field: &Field<'_>) -> Option<f64> {
    let share = field.number(&quantity::MARGIN)?;
    if share > 1.0 {
        field.error(
            "range",
            format!("{} is {share}, must be <= 1", field.path),
            quantity::MARGIN.described(),
        );
        return None;
    }
    Some(share)
}
