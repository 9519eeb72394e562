//! The motion that tells most about a robot's joints: periodic, inside every limit, rich where the springs answer.
//!
//! A slow motion hardly bends a spring, so that stiffness drowns in the steps of encoders; what shows it is the swing of link
//! and motor against each other. Each joint gets a multisine with lines from slow to beyond that swing, and lines of its own, so
//! that joints can be told apart by frequency. How much power goes where maximises the determinant of the Fisher information
//! that a log holds about stiffness, motor inertia and dampings, averaged over stiffnesses from 0.6 to 1.6 times the assumed one,
//! because a motion that is best for one guess may miss the swing of the real joint.
//!
//! The reference is one of the links. It could be one of the motors' torques, which is what the information counts; but under a
//! torque alone an arm drifts and falls, and a loop that follows link positions gives by its feed-forward the torque of every
//! line, keeps the posture and bounds the speed.

mod design;
mod draft;
mod information;
mod joint;
mod lines;
mod phases;

use std::path::Path;

use serde::Serialize;

use crate::feasible::{self, Usage};
use crate::files::base::Base;
use crate::files::source::{self, Source};
use crate::files::{Outside, Problem, Problems, builtin, folder_of, spare};
use crate::progress::Progress;
use crate::robot::{Robot, load_robot_with};
use crate::scenario::{Scenario, document};
use crate::simulate::{LimitWatch, Summary, run_into};

pub use crate::excite::information::ErrorBars;
pub use crate::excite::joint::Joint;
pub use crate::excite::lines::Line;

/// What the motion shall be.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Length of the run \[s\]: a tenth to begin, then two equal periods.
    pub duration: f64,
    /// Control period, and period of the log \[s\].
    pub control_period: f64,
    /// Sets of phases that are tried for each joint, for the smallest peaks; at least one.
    pub budget: usize,
    /// Seed of the phases.
    pub seed: u64,
    /// Link positions that the motion is about, inside their limits \[rad, m for joints that slide\]; none for the middle of the limits.
    pub posture: Option<Vec<f64>>,
    /// One count of the encoders of the links \[rad\]; none if only motors have encoders.
    pub link_resolution: Option<f64>,
    /// One count of the encoders of the motors, on the link side of the gear \[rad\].
    pub motor_resolution: f64,
}

/// One count of an encoder of 17 bits on the link side of the gear \[rad\].
pub const RESOLUTION: f64 = std::f64::consts::TAU / 131_072.0;

/// Sets of phases that are tried unless said otherwise.
pub const BUDGET: usize = 200;

/// What one joint does, and what a log of it would tell.
#[derive(Clone, Debug, Serialize)]
pub struct JointMotion {
    /// Name of the joint.
    pub name: String,
    /// Frequency at which link and motor swing against each other in this posture with the other joints held \[Hz\].
    pub resonance: f64,
    /// Lines of the multisine, the slowest first.
    pub lines: Vec<Line>,
    /// Largest magnitude of the joint's own linear motion over its limits: 1 where the first one is reached.
    pub crest_share: f64,
    /// Three standard deviations that the Cramér–Rao bound leaves.
    pub error_bars: ErrorBars,
}

/// A designed motion.
#[derive(Clone, Debug, Serialize)]
pub struct Excitation {
    /// Name of the robot.
    pub robot: String,
    /// Period of the motion \[s\].
    pub period: f64,
    /// Each joint.
    pub joints: Vec<JointMotion>,
    /// What the reference of the whole arm uses of each limit.
    pub usage: Vec<Usage>,
    /// How the loop with these encoders followed it in simulation.
    pub run: Summary,
    /// The scenario file.
    pub toml: String,
    /// What speaks against it: limits that the simulated loop exceeds, or a reference that it does not follow.
    #[serde(skip)]
    pub objections: Vec<Problem>,
}

/// Part of each limit that the reference may use; positions to a lesser part of their range.
const MARGIN: f64 = 0.8;

/// Times that a motion is made smaller for the limits before it is given up.
const ATTEMPTS: usize = 16;

/// Times that it is made smaller by a third because the simulated loop does not follow it.
const SMALLER: usize = 4;

/// That a motion for the robot at `robot`, a file or a built-in name, may be written to `out`: nothing is there, or an earlier motion.
///
/// # Errors
/// If something else is.
pub fn spare_out(out: &Path, robot: &str) -> Result<(), Problem> {
    spare(out, "motion for identification", |text| text.starts_with(draft::MARK), &[Path::new(robot)])
}

/// Designs the motion for the robot at `robot`, a file or a built-in name, for a scenario file at `out`, which names the robot from
/// there; nothing is written. `outside` says whether files may name files outside of their folders.
///
/// # Errors
/// If a setting is out of range, a joint has no torque limit or its weight takes nearly all of it, or no motion of any size keeps the
/// limits; as [`Scenario::simulate`].
pub fn excite(
    robot: &str,
    out: &Path,
    outside: Outside,
    settings: &Settings,
    progress: Progress<'_>,
) -> Result<Excitation, Problems> {
    let path = named(robot, out)?;
    let robot = &load_robot_with(robot, outside)?;
    check(robot, settings)?;
    let mut plan = draft::Plan::new(robot, settings)?;
    let base = Base::of(out, outside);
    let read = |plan: &draft::Plan<'_>| {
        let toml = plan.toml(&path);
        document::read(&Source::new(&out.display().to_string(), &toml), &base, &[])
            .map(|scenario| (toml, scenario))
    };
    fit(&mut plan, |plan| feasible::usage(&read(plan)?.1))?;
    let mut smaller = 0;
    loop {
        let (toml, scenario) = read(&plan)?;
        let (run, objections) = followed(&scenario, progress)?;
        if objections.is_empty() || smaller == SMALLER {
            let usage = feasible::usage(&scenario)?;
            let (robot, period, joints) = (robot.name.clone(), plan.period(), plan.joints());
            return Ok(Excitation { robot, period, joints, usage, run, toml, objections });
        }
        smaller += 1;
        plan.scale(&vec![2.0 / 3.0; plan.joint_count()]);
    }
}

/// Makes `plan` smaller until it keeps the limits by what is [used](feasible::usage) of them.
fn fit(
    plan: &mut draft::Plan<'_>,
    used: impl Fn(&draft::Plan<'_>) -> Result<Vec<Usage>, Problems>,
) -> Result<(), Problems> {
    for attempt in 0..ATTEMPTS {
        let usage = used(plan)?;
        let mut factors = plan.factors(&usage);
        let least = factors.iter().copied().fold(1.0, f64::min);
        if least >= 1.0 {
            return Ok(());
        }
        if attempt > 0 {
            // What is left comes from other joints.
            factors.fill(least);
        }
        plan.scale(&factors);
    }
    Err(unlimited(plan.robot(), &used(plan)?).into())
}

/// That no motion keeps the limits.
fn unlimited(robot: &Robot, usage: &[Usage]) -> Problem {
    let worst = usage.iter().max_by(|a, b| a.share.total_cmp(&b.share));
    let worst = worst.map_or(String::new(), |usage| {
        format!(": joint {} is at {:.2} of its {}", robot.joints[usage.joint].name, usage.share, usage.key)
    });
    let message = format!("no motion of {} inside all of its limits was found{worst}", robot.name);
    let help =
        "flexure check shows the limits; is one of them far below what the joint needs to carry itself?";
    robot.places.problem("joints", "limits", message, help)
}

/// Simulates the scenario and says what speaks against it.
fn followed(scenario: &Scenario, progress: Progress<'_>) -> Result<(Summary, Vec<Problem>), Problems> {
    let mut watch = LimitWatch::new(&scenario.robot, &scenario.signals()?);
    let found = run_into(scenario, &mut [&mut watch], progress)?;
    let mut objections = watch.warnings();
    let reasons = &found.summary.following.reasons;
    objections.extend(reasons.first().map(|reason| {
        let message = format!("the simulated loop does not follow the motion: {}", reason.words);
        Problem::new(
            "lost",
            message,
            "flexure tune finds gains for the scenario; a robot that is stiffer or lighter than its \
                      file says may follow as it is",
        )
    }));
    Ok((found.summary, objections))
}

/// What a scenario file at `out` calls the robot that is called `robot` here.
fn named(robot: &str, out: &Path) -> Result<String, Problem> {
    if builtin::is_name(robot) {
        return Ok(robot.to_owned());
    }
    let folder = folder_of(out);
    let unreadable = |error| source::unreadable(Path::new(robot), &error);
    let real = Path::new(robot).canonicalize().map_err(unreadable)?;
    let beside = folder.canonicalize().ok().and_then(|folder| real.strip_prefix(folder).ok());
    Ok(beside.unwrap_or(&real).display().to_string())
}

fn check(robot: &Robot, settings: &Settings) -> Result<(), Problems> {
    let Settings { duration, control_period, budget, link_resolution, motor_resolution, .. } = settings;
    let refuse = |message: String, help: &str| Err(Problem::new("range", message, help).into());
    if !(1e-5..=0.02).contains(control_period) {
        return refuse(
            format!("--control-period is {control_period} s, must be from 1e-5 to 0.02"),
            "0.001 is 1 kHz",
        );
    }
    if !(2.0..=600.0).contains(duration) {
        return refuse(format!("--duration is {duration} s, must be from 2 to 600"), "20 s are usual");
    }
    if *budget == 0 || *budget > 100_000 {
        return refuse(
            format!("--budget is {budget}, must be from 1 to 100000"),
            "sets of phases that are tried for each joint",
        );
    }
    let mut steps = link_resolution.iter().chain([motor_resolution]);
    if let Some(step) = steps.find(|step| !(1e-12..=0.1).contains(*step)) {
        return refuse(
            format!("one count is {step} rad, must be from 1e-12 to 0.1"),
            "2π / counts per turn, on the link side of the gear",
        );
    }
    if let Some(posture) = &settings.posture {
        check_posture(robot, posture)?;
    }
    let unlimited = robot.limits.torque.iter().position(|limit| limit.is_infinite());
    if let Some(joint) = unlimited.map(|i| &robot.joints[i]) {
        let message = format!("joint {} has no torque_limit: how hard may the motion drive it?", joint.name);
        let help = "add torque_limit to [joints] of the robot file, N m on the link side of the gear";
        return Err(robot.places.problem("joints", "missing-key", message, help).into());
    }
    Ok(())
}

fn check_posture(robot: &Robot, posture: &[f64]) -> Result<(), Problem> {
    let help = "one link position per joint, rad or m, strictly inside its limits";
    if posture.len() != robot.joint_count() {
        let (given, joints) = (posture.len(), robot.joint_count());
        let message = format!("--posture: {given} given, {} has {joints} joints", robot.name);
        return Err(Problem::new("joints", message, help));
    }
    let limits = robot.limits.lower.iter().zip(&robot.limits.upper);
    for ((joint, &position), (&lower, &upper)) in robot.joints.iter().zip(posture).zip(limits) {
        if !(position.is_finite() && lower < position && position < upper) {
            let wanted = if lower.is_finite() || upper.is_finite() {
                format!("> {lower} and < {upper}")
            } else {
                "a finite number".to_owned()
            };
            let message = format!("--posture has {position} for joint {}, must be {wanted}", joint.name);
            return Err(Problem::new("range", message, help));
        }
    }
    Ok(())
}
