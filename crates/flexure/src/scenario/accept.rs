//! `[accept]`: what counts as following the reference.

use crate::files::field::Joints;
use crate::files::quantity;
use crate::files::table::Table;

/// What a run is held to, where the scenario says so; what it does not say has the defaults of
/// [`Criteria`](crate::simulate::Criteria). Vectors have one entry per joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Accept {
    /// Largest |q_l − q_ld| > 0 from `settling` on \[rad\].
    pub error: Option<Vec<f64>>,
    /// Time ≥ 0, before the end, from which errors, torque changes and time at the limit count \[s\].
    pub settling: Option<f64>,
    /// Largest torque of the motors > 0 [N m].
    pub torque: Option<Vec<f64>>,
    /// Largest link velocity > 0 [rad/s].
    pub speed: Option<Vec<f64>>,
    /// Largest deflection of the springs > 0 \[rad\].
    pub deflection: Option<Vec<f64>>,
    /// Largest root mean square change of the torque from one control instant to the next > 0 [N m].
    pub torque_change: Option<Vec<f64>>,
    /// Largest part of the control instants at which the drive is at its limit, 0 to 1.
    pub at_limit: Option<f64>,
}

/// Its keys.
const KEYS: &[&str] = &["error", "settling", "torque", "speed", "deflection", "torque_change", "at_limit"];

/// Reads `[accept]`; `times` are duration and control period.
pub(crate) fn read(root: &Table<'_>, joints: &Joints, times: Option<(f64, f64)>) -> Option<Accept> {
    let Some(field) = root.get("accept") else { return Some(Accept::default()) };
    let table = field.table(KEYS)?;
    let vector = |key, quantity| table.optional(key, |field| field.per_joint(joints, quantity));
    let error = vector("error", &quantity::ACCEPTED_ERROR);
    let torque = vector("torque", &quantity::TORQUE_LIMIT);
    let speed = vector("speed", &quantity::VELOCITY_LIMIT);
    let deflection = vector("deflection", &quantity::DEFLECTION_LIMIT);
    let torque_change = vector("torque_change", &quantity::ACCEPTED_CHANGE);
    let at_limit = table.optional("at_limit", |field| field.number(&quantity::ACCEPTED_SHARE));
    let settling = table.optional("settling", |field| {
        let settling = field.number(&quantity::SETTLING)?;
        let late = times.is_some_and(|(duration, _)| settling >= duration);
        if late {
            let message = format!(
                "{} is {settling} s, must be < duration, {} s",
                field.path,
                times.map_or(f64::NAN, |(duration, _)| duration)
            );
            field.error("range", message, "errors count from then on: something of the run must be left");
        }
        (!late).then_some(settling)
    });
    Some(Accept {
        error: error?,
        settling: settling?,
        torque: torque?,
        speed: speed?,
        deflection: deflection?,
        torque_change: torque_change?,
        at_limit: at_limit?,
    })
}
