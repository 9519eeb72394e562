//! `[guard]`: what a controller refuses to do.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;

/// Limits that commands are kept to, and what happens when readings fail. Vectors have one entry per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardSettings {
    /// Largest torque > 0, infinite where there is no limit [N m].
    pub torque_limit: Vec<f64>,
    /// Largest torque rate > 0, infinite where there is no limit [N m/s].
    pub torque_rate_limit: Vec<f64>,
    /// Oldest reading that is good [control periods].
    pub max_age: u32,
    /// Good readings in a row after which the law takes over again ≥ 1 [control periods].
    pub rejoin_after: u32,
    /// Time in which it takes over > 0 \[s\].
    pub rejoin_duration: f64,
    /// Damping of the motors while stopped ≥ 0 [N m s/rad].
    pub stop_damping: Vec<f64>,
}

/// Good readings in a row after which the law takes over again, if nothing is said [control periods].
const REJOIN_AFTER: u64 = 10;

/// Time in which it does, if nothing is said \[s\].
const REJOIN_DURATION: f64 = 1.0;

/// Most control periods that a count in `[guard]` may be.
const MOST: u64 = 1_000_000;

/// Reads `[guard]`.
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
pub(crate) fn read(root: &Table<'_>, context: &Context<'_>) -> Option<Option<GuardSettings>> {
    root.optional("guard", |field| {
        let table = field.table(&[
            "torque_limit",
            "torque_rate_limit",
            "max_age",
            "rejoin_after",
            "rejoin_duration",
            "stop_damping",
        ])?;
        let joints = context.joints;
        let torque = table.optional("torque_limit", |field| field.per_joint(joints, &quantity::TORQUE_LIMIT));
        let rate = table
            .optional("torque_rate_limit", |field| field.per_joint(joints, &quantity::TORQUE_RATE_LIMIT));
        let max_age = table.optional("max_age", |field| field.whole("age in control periods", 0, MOST));
        let after = table.optional("rejoin_after", |field| field.whole("control periods", 1, MOST));
        let duration = table.optional("rejoin_duration", |field| field.number(&quantity::DURATION));
        let damping = table.per_joint("stop_damping", joints, &quantity::STOP_DAMPING);
        let limits = context.robot.map(|robot| &robot.limits);
        let count = |count: u64| u32::try_from(count).ok();
        Some(GuardSettings {
            torque_limit: torque?.or_else(|| limits.map(|limits| limits.torque.clone()))?,
            torque_rate_limit: rate?.or_else(|| limits.map(|limits| limits.torque_rate.clone()))?,
            max_age: count(max_age?.unwrap_or(0))?,
            rejoin_after: count(after?.unwrap_or(REJOIN_AFTER))?,
            rejoin_duration: duration?.unwrap_or(REJOIN_DURATION),
            stop_damping: damping?,
        })
    })
}
