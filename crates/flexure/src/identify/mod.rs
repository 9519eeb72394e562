//! From a log to the numbers of the joints: stiffness, motor inertia, damping and dry friction of both sides, and the time
//! offset between torques and positions, with error bars.
//!
//! First a start without local minima (`regression`), then maximum likelihood of the innovations of a predictor of constant
//! gain (`search.rs`, `predictor.rs`), whose derivatives are exact (`step.rs`), and a look beyond the minimum that it found
//! (`scan.rs`). docs/identification.md is the guide.

mod bounded;
mod checks;
mod doubt;
mod encoders;
mod evidence;
mod gain;
mod gaps;
mod layer;
mod outcome;
mod parameters;
mod predictor;
mod prior;
mod regression;
mod robot_file;
mod rubbing;
mod scan;
mod search;
mod step;
mod tangents;
mod torque;

pub use outcome::{Estimate, Identified, IdentifiedJoint, NoiseRatio, Offset};
pub use parameters::Parameter;
pub use robot_file::RobotFile;

use crate::logs::smooth::rms;
use encoders::{Hidden, position_noise};
use evidence::Evidence;
use parameters::Values;
use predictor::Piece;
use prior::{Prior, SHEET};
use search::{Found, Search};

use crate::files::{Problem, Problems};
use crate::logs::Log;
use crate::progress::Progress;
use crate::robot::Robot;

/// How to identify.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The part of each log, at its end, that is kept from the fit to judge it by, 0 to 0.5.
    pub hold_out: f64,
    /// Largest error (three standard deviations) of a stiffness or a motor inertia, as a part of it, for the number to count as
    /// known.
    pub accuracy: f64,
    /// Numbers of the robot that are not worth believing, as [`RobotFile::gaps`]: joint, parameter.
    pub gaps: Vec<(usize, Parameter)>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { hold_out: 0.2, accuracy: 0.2, gaps: Vec::new() }
    }
}

/// Standard deviations of a printed error.
const SIGMAS: f64 = 3.0;

/// Dampings and frictions are known if their error is below this part of them: they are told from zero.
const TOLD_FROM_ZERO: f64 = 1.0;

/// Part that a stiffness may be off by whose link is not seen: of a simulated arm one was 0.12 % off with an error bar of 0.04 %.
const UNSEEN: f64 = 0.002;

/// Length of the pieces that a log is predicted in, and what each begins with to forget where it began \[s\].
const PIECE: f64 = 4.0;
const RUN_IN: f64 = 0.4;

/// Identifies the joints of `robot`, whose links are known, from `logs`.
///
/// # Errors
/// If a log cannot be used or does not fit the robot, settings are out of range, or it was broken off.
pub fn identify(
    robot: &Robot,
    logs: &[Log],
    settings: &Settings,
    progress: Progress<'_>,
) -> Result<Identified, Problems> {
    check_settings(settings)?;
    checks::check(robot, logs, settings)?;
    let n = robot.joint_count();
    let layer = layer::layer(robot)?;
    let torque_size: Vec<f64> =
        (0..n).map(|i| logs.iter().map(|log| rms(&log.u_m, n, i)).fold(0.0, f64::max)).collect();
    let written = from_file(robot, &torque_size, logs.len());
    let start = started(robot, logs, &written, &settings.gaps)?;
    let mut prior = Prior::new(prior_mean(&written, &start), &settings.gaps);
    let pieces = pieces(logs, settings.hold_out);
    let noise = position_noise(logs, n);
    let hidden = Hidden::all(logs, &noise).unwrap_or_default();
    let stiffness = |joint: usize| parameters::unknown(joint, Parameter::Stiffness);
    // A stiffness that is not seen would go where what is rounded drives it, and take others along.
    let is_held = |hidden: &Hidden| hidden.stiffness() > settings.accuracy;
    for (joint, _) in hidden.iter().enumerate().filter(|(_, hidden)| is_held(hidden)) {
        prior.hold(stiffness(joint));
    }
    let search = Search {
        layer: &*layer,
        logs,
        pieces: &pieces,
        prior: &prior,
        position_noise: &noise,
        torque_size: &torque_size,
    };
    let found = search.run(start, progress)?;
    let (information, _) = search.with_prior(&found.total, &found.values);
    let mut evidence = Evidence::new(&information, &found.total, &prior).ok_or_else(unsolvable)?;
    for doubting in &found.doubting {
        evidence.doubted(&found.values.apart(doubting));
    }
    for joint in (0..n).filter(|_| hidden.is_empty()) {
        evidence.no_better(stiffness(joint), UNSEEN / SIGMAS);
    }
    for (joint, (hidden, values)) in hidden.iter().zip(&found.values.joints).enumerate() {
        let part = if is_held(hidden) { SIGMAS * SHEET } else { hidden.stiffness() };
        evidence.no_better(stiffness(joint), part / SIGMAS);
        for (parameter, part) in hidden.sides(values) {
            evidence.no_better(parameters::unknown(joint, parameter), part / SIGMAS);
        }
    }
    let doubts = doubt::doubts(&*robot.arm()?, logs, &found.values, &written, &settings.gaps);
    Ok(judged(robot, &search, &found, &evidence, settings, &doubts))
}

fn check_settings(settings: &Settings) -> Result<(), Problem> {
    let Settings { hold_out, accuracy, .. } = *settings;
    if !(0.0..=0.5).contains(&hold_out) {
        let message = format!("--hold-out is {hold_out}, must be >= 0 and <= 0.5");
        return Err(Problem::new("range", message, "the part of each log that is kept from the fit"));
    }
    if !(accuracy > 0.0 && accuracy <= 1.0) {
        let message = format!("--accuracy is {accuracy}, must be > 0 and <= 1");
        return Err(Problem::new(
            "range",
            message,
            "the error of stiffness and motor inertia, as a part of them",
        ));
    }
    Ok(())
}

fn unsolvable() -> Problem {
    let message = "the logs do not fit the robot: the search left the finite numbers";
    Problem::new(
        "unsolvable",
        message,
        "check units, signs and order of the columns, and the masses of the links",
    )
}

/// The numbers of the robot file; where it says zero or nothing, small parts of the torque.
fn from_file(robot: &Robot, torque_size: &[f64], logs: usize) -> Values {
    let joints = (0..robot.joint_count())
        .map(|i| {
            let friction = 0.02 * torque_size[i];
            let damping = |d: f64| if d > 0.0 { d } else { 0.01 * torque_size[i] };
            [
                robot.stiffness[i],
                robot.motor_inertia[i],
                damping(robot.link_damping[i]),
                damping(robot.motor_damping[i]),
                friction,
                friction,
            ]
        })
        .collect();
    Values { joints, offsets: vec![0.0; logs] }
}

/// Smallest part of what is written that a search starts from, and its inverse.
const FAR: f64 = 0.02;

/// Where the search starts: by regression; where only motors are measured, about the stiffness of the file.
fn started(
    robot: &Robot,
    logs: &[Log],
    written: &Values,
    gaps: &[(usize, Parameter)],
) -> Result<Values, Problems> {
    let mut values = written.clone();
    let arm = robot.arm()?;
    for (k, log) in logs.iter().enumerate() {
        let started = match (&log.q_l, &log.q_m) {
            (Some(q_l), Some(q_m)) => regression::both_sides::start(&*arm, log, q_l, q_m),
            (None, Some(q_m)) => {
                regression::motors::start(&*arm, log, q_m, &written.of(Parameter::Stiffness))
            }
            (_, None) => continue,
        };
        checks::explained(robot, log, &started)?;
        values.offsets[k] = started.offset;
        if k == 0 {
            for (joint, found) in started.joints.iter().enumerate() {
                for (parameter, found) in Parameter::ALL.into_iter().zip(*found) {
                    let value = &mut values.joints[joint][parameter.place()];
                    let is_open = gaps.contains(&(joint, parameter)) && found > 0.0;
                    *value = if is_open { found } else { found.clamp(FAR * *value, *value / FAR) };
                }
            }
        }
    }
    Ok(values)
}

/// The prior is about the file's numbers; about friction it says nothing, so that where the search starts is as good.
fn prior_mean(written: &Values, start: &Values) -> Values {
    let mut mean = written.clone();
    for (mean, start) in mean.joints.iter_mut().zip(&start.joints) {
        for parameter in [Parameter::LinkFriction, Parameter::MotorFriction] {
            mean[parameter.place()] = start[parameter.place()];
        }
    }
    mean.offsets.clone_from(&start.offsets);
    mean
}

/// The logs in pieces, the last part of each held out.
fn pieces(logs: &[Log], hold_out: f64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (of_log, log) in logs.iter().enumerate() {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of the samples")]
        let count = |seconds: f64| (seconds / log.period).round() as usize;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of the samples")]
        let fitted = ((1.0 - hold_out) * log.samples() as f64) as usize;
        let (run_in, length) = (count(RUN_IN), count(PIECE));
        for (from, to, held_out) in [(run_in, fitted, false), (fitted + run_in, log.samples(), true)] {
            let mut counted = from;
            while counted < to {
                let end = if to - counted < 2 * length { to } else { counted + length };
                pieces.push(Piece {
                    number: pieces.len(),
                    log: of_log,
                    first: counted - run_in,
                    counted,
                    end,
                    held_out,
                });
                counted = end;
            }
        }
    }
    pieces
}

fn judged(
    robot: &Robot,
    search: &Search<'_>,
    found: &Found,
    evidence: &Evidence,
    settings: &Settings,
    doubts: &[Option<String>],
) -> Identified {
    let values = &found.values;
    let kept: Vec<&Piece> = search.pieces.iter().filter(|piece| piece.held_out).collect();
    let validation =
        layer::total(search.layer, search.logs, kept.iter().copied(), values, &found.weighing, false);
    let names: Vec<String> = robot.joints.iter().map(|joint| joint.name.clone()).collect();
    let offsets = search.logs.iter().enumerate().map(|(k, log)| Offset {
        log: log.name.clone(),
        value: values.offsets[k],
        error: SIGMAS * evidence.deviations[names.len() * Parameter::COUNT + k],
    });
    let offsets: Vec<_> = offsets.collect();
    let is_timed = offsets.iter().all(Offset::is_known);
    let joints = (0..names.len()).map(|i| {
        let root = |x: f64, noise: f64| x.sqrt() / noise;
        let [l, _, m] = found.total.covariance(i);
        let [of_link, of_motor] = search.position_noise[i];
        let link = search.logs[0].q_l.as_ref().map(|_| root(l, of_link));
        IdentifiedJoint {
            name: names[i].clone(),
            parameters: Parameter::ALL
                .iter()
                .map(|&parameter| {
                    let estimate = estimate(robot, values, evidence, settings, i, parameter);
                    // Short of the end of the search error bars say nothing.
                    let is_sound = found.converged && is_timed && doubts[i].is_none();
                    Estimate { known: estimate.known && is_sound, ..estimate }
                })
                .collect(),
            doubt: doubts[i].clone(),
            noise_ratio: NoiseRatio { link, motor: root(m, of_motor) },
            torque_noise: found.torque_noise[i],
            held_out: (validation.samples > 0).then(|| {
                let weighed = |total: &layer::Total| {
                    let ([l, both, m], [a, b, c]) = (total.covariance(i), found.weighing.weights[i]);
                    a * l + 2.0 * b * both + c * m
                };
                weighed(&validation) / weighed(&found.total)
            }),
        }
    });
    let joints = joints.collect();
    let (direction, deviation) = &evidence.weakest;
    Identified {
        robot: robot.name.clone(),
        joints,
        offsets,
        samples: found.total.samples,
        held_out: validation.samples,
        link_encoders: search.logs[0].q_l.is_some(),
        converged: found.converged,
        condition: evidence.condition,
        weakest: evidence::in_words(direction, *deviation, values, &names),
    }
}

fn estimate(
    robot: &Robot,
    values: &Values,
    evidence: &Evidence,
    settings: &Settings,
    joint: usize,
    parameter: Parameter,
) -> Estimate {
    let value = values.joints[joint][parameter.place()];
    let share = SIGMAS * evidence.deviations[parameters::unknown(joint, parameter)];
    let before = match parameter {
        _ if settings.gaps.contains(&(joint, parameter)) => None,
        Parameter::Stiffness => Some(robot.stiffness[joint]),
        Parameter::MotorInertia => Some(robot.motor_inertia[joint]),
        Parameter::LinkDamping => Some(robot.link_damping[joint]),
        Parameter::MotorDamping => Some(robot.motor_damping[joint]),
        Parameter::LinkFriction | Parameter::MotorFriction => None,
    };
    let allowed = if parameter.is_needed() { settings.accuracy } else { TOLD_FROM_ZERO };
    Estimate {
        key: parameter.name(),
        unit: parameter.unit().of(robot.joints[joint].kind).plain,
        value,
        error: share * value,
        before,
        known: share <= allowed,
    }
}
