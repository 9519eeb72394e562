//! Could the robot have done what its log says? Wrong units, scales and swapped columns show here.

use crate::files::number::significant;
use crate::files::source::Source;
use crate::files::{Problem, Problems};
use crate::logs::channel::Channel;
use crate::logs::log::Log;
use crate::logs::speeds;
use crate::robot::{JointKind, Robot};

/// Of a position limit, more than this is no overshoot but another unit.
const BEYOND: f64 = 2.0;

/// Of a limit of speed or torque.
const FAR_BEYOND: f64 = 5.0;

/// A joint that turned farther than this \[rad\], about eight turns, is not one of an arm.
const FAR: f64 = 50.0;

/// Position ranges below this \[rad\] say nothing of how motors and links move together, or how fast.
pub(super) const STILL: f64 = 0.02;

/// Motors move as links do, to this part, or what bends the spring comes from the motor.
const TOGETHER: f64 = 0.5;

/// Largest torque of a spring over the largest of its motor: a swing may carry some times what keeps it up.
const SWING: f64 = 5.0;

/// What is doubtful about `log`, a log of `robot`; an error where the robot cannot have done it.
pub(super) fn check(log: &Log, robot: &Robot) -> Result<Vec<Problem>, Problems> {
    let mut problems = Vec::new();
    for (i, _) in robot.joints.iter().enumerate() {
        for channel in Channel::ALL {
            let Some(values) = values(log, channel) else { continue };
            let column: Vec<f64> = values.iter().skip(i).step_by(log.joints).copied().collect();
            problems.extend(beyond(log, robot, i, channel, &column));
        }
        problems.extend(apart(log, robot, i));
        problems.extend(no_torque(log, robot, i));
        problems.extend(speeds::foreign(log, robot, i));
    }
    Problems::or_warnings(problems)
}

fn values(log: &Log, channel: Channel) -> Option<&[f64]> {
    match channel {
        Channel::LinkPosition => log.q_l.as_deref(),
        Channel::MotorPosition => log.q_m.as_deref(),
        Channel::LinkVelocity => log.dq_l.as_deref(),
        Channel::MotorVelocity => log.dq_m.as_deref(),
        Channel::MotorTorque => Some(&log.u_m),
    }
}

/// A problem with the log as a whole.
pub(super) fn problem(log: &Log, code: &'static str, what: String, help: &str) -> Problem {
    Problem::new(code, what, help).at(&Source::part(&log.name, "", 0), 0..0)
}

/// What to say of numbers of joint `i` that are beyond its limits.
fn beyond(log: &Log, robot: &Robot, i: usize, channel: Channel, values: &[f64]) -> Option<Problem> {
    let limits = &robot.limits;
    let joint = &robot.joints[i];
    let is_position = matches!(channel, Channel::LinkPosition | Channel::MotorPosition);
    let (middle, half) = match channel {
        Channel::LinkPosition | Channel::MotorPosition => {
            let (lower, upper) = (limits.lower[i], limits.upper[i]);
            let bounded = (upper - lower).is_finite();
            let far = if joint.kind == JointKind::Revolute { FAR } else { f64::INFINITY };
            if bounded { (0.5 * (lower + upper), 0.5 * (upper - lower)) } else { (0.0, far) }
        }
        Channel::LinkVelocity | Channel::MotorVelocity => (0.0, limits.velocity[i]),
        Channel::MotorTorque => (0.0, limits.torque[i]),
    };
    let farthest = values.iter().copied().max_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()))?;
    let share = (farthest - middle).abs() / half;
    if share.is_nan() || share <= 1.0 + f64::EPSILON {
        return None;
    }
    let quantity = channel.quantity();
    let value = |x: f64| significant(x, 3);
    let limit = if is_position {
        format!("the joint goes from {} to {}", value(middle - half), value(middle + half))
    } else {
        format!("its limit is {}", value(half))
    };
    let what = format!(
        "joint {}: {} goes up to {}, but {limit} ({})",
        joint.name,
        channel.key(),
        value(farthest),
        quantity.described()
    );
    let whole = values.iter().all(|x| x.fract() == 0.0) && values.iter().any(|x| x.abs() > 1.0);
    let help = if channel == Channel::MotorTorque {
        "are these mN m, currents, or torques before the gear? --columns with unit, scale or motor_side"
    } else if whole {
        "these look like encoder counts: --columns with scale = 2π / counts per turn, and motor_side for motors before the gear"
    } else {
        "are these degrees, or motors before the gear? --columns with unit = \"deg\" or motor_side = true"
    };
    if share > if is_position { BEYOND } else { FAR_BEYOND } {
        return Some(problem(log, "scale", what, help));
    }
    Some(
        problem(log, "suspicious", what, "the robot's limits are in its file; is it the right joint?")
            .warning(),
    )
}

/// What to say where the motor of joint `i` does not move with its link.
fn apart(log: &Log, robot: &Robot, i: usize) -> Option<Problem> {
    let of = |values: &Option<Vec<f64>>| -> Option<Vec<f64>> {
        Some(values.as_ref()?.iter().skip(i).step_by(log.joints).copied().collect())
    };
    let (q_l, q_m) = (of(&log.q_l)?, of(&log.q_m)?);
    let range = |q: &[f64]| {
        let (low, high) =
            q.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        high - low
    };
    let moved = range(&q_l).max(range(&q_m));
    if moved < STILL {
        return None;
    }
    let deflection: Vec<f64> = q_m.iter().zip(&q_l).map(|(q_m, q_l)| q_m - q_l).collect();
    let bending = 0.5 * robot.stiffness[i] * range(&deflection);
    let given =
        log.u_m.iter().skip(i).step_by(log.joints).fold(0.0, |given: f64, torque| given.max(torque.abs()));
    if range(&deflection) < TOGETHER * moved || bending < SWING * given {
        return None;
    }
    let ratio = range(&q_m) / range(&q_l);
    let what = format!(
        "joint {}: the motor moves over {} rad and the link over {} rad; that bends the spring with {} N m, and the motor gives \
         {} N m at most",
        robot.joints[i].name,
        significant(range(&q_m), 3),
        significant(range(&q_l), 3),
        significant(bending, 3),
        significant(given, 3)
    );
    let help = if ratio > 5.0 {
        "motors are seen from the link side of the gear: --columns with q_m.motor_side = true, or scale"
    } else {
        "are columns swapped, or does one of them count the other way? --columns with sign = -1"
    };
    Some(problem(log, "scale", what, help))
}

/// What to say where no torque moves joint `i`.
fn no_torque(log: &Log, robot: &Robot, i: usize) -> Option<Problem> {
    let silent = log.u_m.iter().skip(i).step_by(log.joints).all(|torque| *torque == 0.0);
    silent.then(|| {
        let what = format!("joint {}: the motor torque is 0 all the time", robot.joints[i].name);
        problem(log, "suspicious", what, "is it the right column?").warning()
    })
}
