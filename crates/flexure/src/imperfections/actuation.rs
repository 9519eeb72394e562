//! Imperfections of computer and drives.

use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::{Context, Imperfection};
use crate::robot::Robot;

/// Times that pass between a control instant and the torque that it commands, ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delay {
    /// Of the law \[s\].
    pub computation: f64,
    /// Of the drive \[s\].
    pub actuation: f64,
}

impl Delay {
    /// From the control instant to the torque \[s\].
    pub fn total(&self) -> f64 {
        self.computation + self.actuation
    }
}

/// Control instants that the law misses: the last command stays for a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deadline {
    /// Each with this probability in [0, 1].
    Random {
        /// Per control instant.
        probability: f64,
    },
    /// Each `every`-th, ≥ 2, counted from 1 at t = 0.
    Every(u32),
}

pub(crate) const DELAY: &[&str] = &["kind", "computation", "actuation"];

pub(crate) fn delay(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let read = |key| table.optional(key, |field| field.number(&quantity::DELAY));
    let (computation, actuation) = (read("computation"), read("actuation"));
    let (computation, actuation) = (computation?, actuation?);
    if computation.is_none() && actuation.is_none() {
        table.error(
            "missing-key",
            "delay: neither computation nor actuation is given",
            "give at least one, in s; they add up, and need be no multiples of the control period",
        );
        return None;
    }
    let delay = Delay { computation: computation.unwrap_or(0.0), actuation: actuation.unwrap_or(0.0) };
    if let Some((duration, _)) = context.times
        && delay.total() >= duration
    {
        let message = format!("the delay is {} s, must be < duration, {duration} s", delay.total());
        table.error("range", message, "no torque would arrive during the run; is it in milliseconds?");
        return None;
    }
    Some(Imperfection::Delay(delay))
}

pub(crate) const DEADLINE: &[&str] = &["kind", "probability", "every"];

pub(crate) fn deadline(table: &Table<'_>, _: &Context<'_>) -> Option<Imperfection> {
    let deadline = match (table.get("probability"), table.get("every")) {
        (Some(field), None) => Deadline::Random { probability: field.number(&quantity::PROBABILITY)? },
        (None, Some(field)) => {
            let every = field.whole("each so many-th control instant is missed", 2, u64::from(u32::MAX))?;
            Deadline::Every(u32::try_from(every).ok()?)
        }
        _ => {
            table.error(
                "missing-key",
                "deadline: either probability or every must be given",
                "probability per control instant, or every = 10 for each tenth",
            );
            return None;
        }
    };
    Some(Imperfection::Deadline(deadline))
}

pub(crate) const TORQUE_GAIN: &[&str] = &["kind", "factor"];

pub(crate) fn torque_gain(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    table.per_joint("factor", context.joints, &quantity::TORQUE_FACTOR).map(Imperfection::TorqueGain)
}

pub(crate) const SATURATION: &[&str] = &["kind", "limit"];

pub(crate) fn saturation(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let default = ("torque_limit", |robot: &Robot| robot.limits.torque.clone());
    limit(table, context, &quantity::TORQUE_LIMIT, default).map(Imperfection::Saturation)
}

pub(crate) const TORQUE_RATE: &[&str] = &["kind", "limit"];

pub(crate) fn torque_rate(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let default = ("torque_rate_limit", |robot: &Robot| robot.limits.torque_rate.clone());
    limit(table, context, &quantity::TORQUE_RATE_LIMIT, default).map(Imperfection::TorqueRate)
}

/// The limit, or the robot's under `key`, which must then have one.
fn limit(
    table: &Table<'_>,
    context: &Context<'_>,
    quantity: &Quantity,
    (key, of): (&str, impl Fn(&Robot) -> Vec<f64>),
) -> Option<Vec<f64>> {
    if let Some(field) = table.get("limit") {
        return field.per_joint(context.joints, quantity);
    }
    let robot = context.robot?;
    let limit = of(robot);
    if limit.iter().any(|limit| !limit.is_finite()) {
        let message = format!("missing key {}, and robot {} has no {key}", table.key("limit"), robot.name);
        let hint = format!("{}, per joint; or add {key} to [joints] of the robot file", quantity.described());
        table.error("missing-key", message, hint);
        return None;
    }
    Some(limit)
}

pub(crate) const CURRENT_QUANTISATION: &[&str] = &["kind", "step"];

pub(crate) fn current_quantisation(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let step = table.per_joint("step", context.joints, &quantity::TORQUE_STEP)?;
    Some(Imperfection::CurrentQuantisation(step))
}
