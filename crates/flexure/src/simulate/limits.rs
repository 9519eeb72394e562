//! Did the robot stay inside its limits?

use crate::feasible::limit_words;
use crate::files::Problem;
use crate::robot::Robot;
use crate::simulate::trace::Trace;

/// A warning for each joint and limit of position, velocity or deflection that was exceeded: from when on, and how far.
/// For torques there is [`Summary::saturated_fraction`](crate::simulate::summary::Summary).
pub fn exceeded(robot: &Robot, trace: &Trace) -> Vec<Problem> {
    let time = trace.column("t").unwrap_or_default();
    let signals = [trace.joints("q_l"), trace.joints("q_m"), trace.joints("dq_l")];
    let [q_l, q_m, v_l] = &signals;
    let mut warnings = Vec::new();
    for (i, joint) in robot.joints.iter().enumerate().take(q_l.len()) {
        let limits = &robot.limits;
        let mut watch = |key: &str, limit: f64, value: &dyn Fn(usize) -> f64, excess: &dyn Fn(f64) -> f64| {
            let beyond = |k: &usize| excess(value(*k)) > 0.0;
            let Some(first) = (0..trace.len()).find(beyond) else { return };
            let worst = (first..trace.len()).max_by(|&a, &b| excess(value(a)).total_cmp(&excess(value(b))));
            let (what, unit) = limit_words(key, joint.kind);
            let message = format!(
                "joint {}: {what} exceeds {key}, {limit} {unit}, from t = {:.3} s on: {:.4} {unit} at worst",
                joint.name,
                time.get(first).copied().unwrap_or(f64::NAN),
                value(worst.unwrap_or(first)),
            );
            let hint = "the simulation does not stop there; choose a slower or smaller reference";
            warnings.push(robot.places.problem(&format!("joints.{key}"), "limits", message, hint).warning());
        };
        let (lower, upper) = (limits.lower[i], limits.upper[i]);
        watch("position_lower", lower, &|k| q_l[i][k], &|q| lower - q);
        watch("position_upper", upper, &|k| q_l[i][k], &|q| q - upper);
        let velocity = limits.velocity[i];
        watch("velocity_limit", velocity, &|k| v_l[i][k], &|v| v.abs() - velocity);
        let deflection = limits.deflection[i];
        watch("deflection_limit", deflection, &|k| q_m[i][k] - q_l[i][k], &|zeta| zeta.abs() - deflection);
    }
    warnings
}
