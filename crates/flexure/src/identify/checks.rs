//! Logs that cannot be used, told before anything is computed, and those that do not fit the robot.

use super::Settings;
use super::regression::Started;
use crate::files::{Problem, Problems, number::significant};
use crate::logs::Log;
use crate::logs::smooth::rms;
use crate::robot::Robot;

/// Shortest log that is worth looking at \[s\].
const SHORTEST: f64 = 2.0;

/// Longest sampling period at which springs of robots are seen to swing \[s\].
const SLOWEST: f64 = 0.01;

/// Most samples of a log: five hours at 1 kHz.
const MOST: usize = 20_000_000;

/// Least range of a joint that moves \[rad\].
const STILL: f64 = 1e-4;

/// Part of the samples at which a torque may be at its extreme.
const SATURATED: f64 = 0.02;

/// Largest part of the torques that smoothed equations may leave unexplained: good logs leave 0.05, swapped or mis-scaled columns
/// 0.4 and more.
const UNEXPLAINED: f64 = 0.3;

/// Refuses logs that cannot say anything of `robot`.
///
/// # Errors
/// With everything that is wrong.
pub(crate) fn check(robot: &Robot, logs: &[Log], settings: &Settings) -> Result<(), Problems> {
    let Some(first) = logs.first() else {
        return Err(Problem::new("log", "there is no log", "name at least one with --log").into());
    };
    let mut problems = Vec::new();
    if let Some((joint, gap)) = settings.gaps.iter().find(|(_, gap)| first.q_l.is_none() && gap.is_needed()) {
        let joint = robot.joints.get(*joint).map_or("", |joint| &joint.name);
        let message = format!(
            "{} leaves {} of {joint} open, and the links have no encoders in the log",
            robot.name,
            gap.name()
        );
        let help =
            "with motor encoders alone the search starts from the robot file: give a guess, 30 % off will do";
        problems.push(Problem::new("log", message, help));
    }
    for (k, log) in logs.iter().enumerate() {
        problems.extend(alone(robot, log));
        if logs[..k].iter().any(|other| other.q_m == log.q_m && other.u_m == log.u_m) {
            let message = format!("{} is there twice", log.name);
            let help = "what is counted twice looks better known than it is: name each log once";
            problems.push(Problem::new("log", message, help));
        }
        let same = log.q_l.is_some() == first.q_l.is_some()
            && log.q_m.is_some() == first.q_m.is_some()
            && (log.period / first.period - 1.0).abs() < 1e-6;
        if !same {
            let message = format!("{} and {} differ in channels or sampling period", first.name, log.name);
            problems.push(Problem::new("log", message, "identify from logs of one kind"));
        }
    }
    Problems::or_warnings(problems).map(drop)
}

/// What is wrong with a log by itself.
fn alone(robot: &Robot, log: &Log) -> Vec<Problem> {
    let n = robot.joint_count();
    let name = &log.name;
    let problem = |code, message: String, help: &str| Problem::new(code, message, help);
    if log.joints != n {
        let message = format!("{name} has {} joints, {} has {n}", log.joints, robot.name);
        return vec![problem("joints", message, "one column of each signal per joint, in the robot's order")];
    }
    if log.q_m.is_none() {
        let message = format!("{name} has no motor positions");
        let help =
            "motor inertia and friction are seen from the motor only: log q_m, on the link side of the gear";
        return vec![problem("log", message, help)];
    }
    let sizes = [&log.q_l, &log.q_m].into_iter().flatten().all(|signal| signal.len() == log.u_m.len());
    if !sizes || !log.u_m.len().is_multiple_of(n) || log.samples() > MOST {
        let message = format!("{name}: signals differ in length, or are longer than {MOST} samples");
        return vec![problem("log", message, "one row per sample")];
    }
    if !(log.period > 0.0 && log.period <= SLOWEST) {
        let message = format!("{name} has a sample every {} s, must be at most {SLOWEST} s", log.period);
        return vec![problem(
            "log",
            message,
            "springs swing at 5 to 100 Hz: log at 200 Hz or faster, 1 kHz is good",
        )];
    }
    if log.duration() < SHORTEST {
        let message = format!("{name} lasts {:.2} s, must last at least {SHORTEST} s", log.duration());
        return vec![problem("log", message, "20 s of a motion that excites every joint are good")];
    }
    let finite = |signal: &[f64]| signal.iter().position(|x| !x.is_finite());
    for (key, signal) in [("q_l", log.q_l.as_deref()), ("q_m", log.q_m.as_deref()), ("u_m", Some(&*log.u_m))]
    {
        if let Some(at) = signal.and_then(finite) {
            let message = format!("{name}: {key} of joint {} is no number at sample {}", at % n + 1, at / n);
            return vec![problem(
                "not-finite",
                message,
                "cut the gap out: give the parts as logs of their own",
            )];
        }
    }
    (0..n).filter_map(|i| of_joint(robot, log, i)).collect()
}

fn of_joint(robot: &Robot, log: &Log, i: usize) -> Option<Problem> {
    let (n, name, joint) = (log.joints, &log.name, &robot.joints[i].name);
    let range = |signal: &[f64]| {
        let values = || signal.iter().skip(i).step_by(n).copied();
        let (low, high) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        (low, high)
    };
    for (side, signal) in [("link", &log.q_l), ("motor", &log.q_m)] {
        let Some(signal) = signal else { continue };
        let (low, high) = range(signal);
        if high - low < STILL {
            let message =
                format!("{name}: the {side} of {joint} does not move (range {:.1e} rad)", high - low);
            return Some(Problem::new(
                "log",
                message,
                "move every joint; `flexure excite` designs such a motion",
            ));
        }
    }
    let torques = || log.u_m.iter().skip(i).step_by(n).map(|u| u.abs());
    let most = torques().fold(0.0, f64::max);
    if let (low, high) = range(&log.u_m)
        && low >= high
    {
        let message = format!("{name}: the torque of {joint} is {low} N m in all samples");
        return Some(Problem::new("log", message, "is it the right column?"));
    }
    let limit = robot.limits.torque[i];
    let at_most = torques().filter(|u| *u >= most * (1.0 - 1e-9)).count() as f64 / log.samples() as f64;
    let saturated = torques().filter(|u| *u >= limit * (1.0 - 1e-6)).count() as f64 / log.samples() as f64;
    if at_most.max(saturated) > SATURATED {
        let share = 100.0 * at_most.max(saturated);
        let message = format!("{name}: the torque of {joint} is at its limit in {share:.0} % of the samples");
        let help = "what the motor gives at its limit is not what is logged: move more gently";
        return Some(Problem::new("log-saturated", message, help));
    }
    None
}

/// Refuses a log whose torques the equations of motion do not explain, by any numbers.
///
/// # Errors
/// Naming the joints.
pub(crate) fn explained(robot: &Robot, log: &Log, started: &Started) -> Result<(), Problems> {
    let mut problems = Vec::new();
    for (i, [link, motor]) in started.unexplained.iter().enumerate() {
        let joint = &robot.joints[i].name;
        let torque = rms(&log.u_m, log.joints, i);
        let [stiffness, inertia, ..] = started.joints[i];
        // With motors alone the equation that is seen is that of links and motors together.
        let (seen, is_positive) = match &log.q_l {
            Some(_) => (
                format!(
                    "{:.0} % of the torque on the link's side of the spring and {:.0} % on the motor's",
                    100.0 * link,
                    100.0 * motor
                ),
                stiffness > 0.0 && inertia > 0.0,
            ),
            None => (format!("{:.0} % of the motor torque", 100.0 * motor), true),
        };
        if *link <= UNEXPLAINED && *motor <= UNEXPLAINED && !is_positive {
            let what = if stiffness <= 0.0 { "stiffness" } else { "motor inertia" };
            let message = format!("{}: no positive {what} of {joint} explains how it moves", log.name);
            let help = "the motion is too slow or too small to show it (`flexure excite` designs one that does), or a column has \
                        another sign";
            problems.push(Problem::new("log-mismatch", message, help));
        } else if *link > UNEXPLAINED || *motor > UNEXPLAINED {
            let message = format!(
                "{}: {joint} does not move as the robot does: its equations leave {seen} unexplained, whatever its numbers are \
                 (its motor gives {} N m rms)",
                log.name,
                significant(torque, 3)
            );
            let help = "are columns swapped, in degrees, on the motor side of the gear, of another sign, or is the motion \
                        too slow to bend the springs?";
            problems.push(Problem::new("log-mismatch", message, help));
        }
    }
    Problems::or_warnings(problems).map(drop)
}
