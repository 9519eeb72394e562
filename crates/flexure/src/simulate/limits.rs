//! Did the robot stay inside its limits?

use crate::files::Problem;
use crate::robot::{JointKind, Robot};
use crate::simulate::trace::Trace;

/// A limit that a run exceeded: what it is of, its key in a robot file, its unit for revolute and prismatic joints.
type Kind = (&'static str, &'static str, [&'static str; 2]);

const POSITION_LOWER: Kind = ("link position", "position_lower", ["rad", "m"]);
const POSITION_UPPER: Kind = ("link position", "position_upper", ["rad", "m"]);
const VELOCITY: Kind = ("link velocity", "velocity_limit", ["rad/s", "m/s"]);
const DEFLECTION: Kind = ("deflection of the spring", "deflection_limit", ["rad", "m"]);

/// A warning for each joint and limit of position, velocity or deflection that was exceeded: from when on, and how far.
/// For torques there is [`Summary::saturated_fraction`](crate::simulate::summary::Summary).
pub fn exceeded(robot: &Robot, trace: &Trace) -> Vec<Problem> {
    let time = trace.column("t").unwrap_or_default();
    let signals = [trace.joints("q_l"), trace.joints("q_m"), trace.joints("dq_l")];
    let [q_l, q_m, v_l] = &signals;
    let mut warnings = Vec::new();
    for (i, joint) in robot.joints.iter().enumerate().take(q_l.len()) {
        let limits = &robot.limits;
        let mut watch = |kind: Kind,
                         limit: f64,
                         value: &dyn Fn(usize) -> f64,
                         excess: &dyn Fn(f64) -> f64| {
            let beyond = |k: &usize| excess(value(*k)) > 0.0;
            let Some(first) = (0..trace.len()).find(beyond) else { return };
            let worst = (first..trace.len()).max_by(|&a, &b| excess(value(a)).total_cmp(&excess(value(b))));
            let (what, key, [angle, distance]) = kind;
            let unit = match joint.kind {
                JointKind::Revolute => angle,
                JointKind::Prismatic => distance,
            };
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
        watch(POSITION_LOWER, lower, &|k| q_l[i][k], &|q| lower - q);
        watch(POSITION_UPPER, upper, &|k| q_l[i][k], &|q| q - upper);
        let velocity = limits.velocity[i];
        watch(VELOCITY, velocity, &|k| v_l[i][k], &|v| v.abs() - velocity);
        let deflection = limits.deflection[i];
        watch(DEFLECTION, deflection, &|k| q_m[i][k] - q_l[i][k], &|zeta| zeta.abs() - deflection);
    }
    warnings
}
