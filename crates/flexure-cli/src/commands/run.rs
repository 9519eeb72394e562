//! `flexure run`: one closed loop.

use std::path::PathBuf;

use flexure::feasible;
use flexure::files::number::short;
use flexure::files::{Problem, Reading, prepare};
use flexure::imperfections::Imperfection;
use flexure::prove::standing::outside_of_proofs;
use flexure::report::summary_table;
use flexure::reproduce::{Experiment, trace_file, write_experiment};
use flexure::sampled::{Sampled, not_looked_at};
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::simulate::{Cause, Excerpt, FaultLog, Following, Summary, preload};
use serde::Serialize;

use super::print;
use crate::args::Traced;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// A summary and where the files are.
#[derive(Serialize)]
pub struct Outcome<'a> {
    #[serde(flatten)]
    pub summary: &'a Summary,
    /// Time of divergence in s; none if the loop ran to the end.
    pub diverged_at: Option<f64>,
    /// Whether the loop is stable that holds its torque for a control period; none for laws in continuous time.
    pub sampled: Option<&'a Sampled>,
    /// What the guard kept of its stops; not there without a guard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faults: Option<&'a FaultLog>,
    pub files: Vec<PathBuf>,
}

impl<'a> Outcome<'a> {
    pub fn new(experiment: &'a Experiment, files: Vec<PathBuf>) -> Self {
        let diverged_at = experiment.run.divergence.map(|divergence| divergence.time);
        let run = &experiment.run;
        Self {
            summary: &run.summary,
            diverged_at,
            sampled: experiment.sampled.as_ref(),
            faults: run.faults.as_ref(),
            files,
        }
    }
}

pub fn run(scenario: &str, reading: Reading<'_>, traced: &Traced, json: bool) -> Result<(), Failure> {
    told(load_scenario_with(scenario, reading)?, None, traced, json)
}

/// Runs `scenario`, writes its files as `traced` says, and tells what came of it, after `first`: who prints before the end has no word left
/// for what Ctrl-C breaks off.
pub fn told(scenario: Scenario, first: Option<&str>, traced: &Traced, json: bool) -> Result<(), Failure> {
    let Traced { output, columns, every } = traced;
    let excerpt = Excerpt::new(&scenario.signals()?, columns, *every)?;
    say(&scenario.warnings);
    say(&preload(&scenario)?);
    say(&feasible::slowed(&scenario)?);
    let beyond = feasible::exceeded(&scenario, &feasible::usage(&scenario)?);
    prepare(&output.out)?;
    let mut trace = trace_file(&output.out, &scenario, excerpt)?;
    let experiment = {
        let progress = Progress::of_one(&scenario.name);
        Experiment::new(scenario, &mut [&mut trace], &|fraction| progress.set(0, fraction))?
    };
    let files = write_experiment(&experiment, trace)?;
    let broken_off = experiment.run.broken_off.map(|time| broken_off(&experiment.scenario, time));
    if experiment.run.divergence.is_none() {
        say(&experiment.exceeded);
    }
    say(unbalanced(&experiment).as_slice());
    if json {
        print::json(&Outcome::new(&experiment, files))?;
    } else {
        for words in first.into_iter().chain(broken_off.as_deref()) {
            print::line(words)?;
        }
        print::line(&summary_table(std::slice::from_ref(&experiment.run.summary), print::columns()))?;
        if let Some(line) = summary_line(&experiment.run.summary) {
            print::line(&line)?;
        }
        let conditions =
            experiment.scenario.vcbc().map_or_else(|_| Vec::new(), |_| experiment.scenario.beyond_ideal());
        if let Some(line) = outside_of_proofs(&conditions) {
            print::line(&line)?;
        }
        let sampled = experiment.sampled.as_ref().map(Sampled::line);
        if let Some(line) = sampled.or_else(|| not_looked_at(&experiment.scenario)) {
            print::line(&line)?;
        }
        if broken_off.is_none() {
            print::line(&verdict(&experiment.run.summary.following))?;
        }
        for file in &files {
            print::line(&format!("wrote {}", file.display()))?;
        }
    }
    if let Some(words) = broken_off {
        return Err(Failure::interrupted(
            words,
            "summary, trace and figure end there; whether it follows is not known",
        ));
    }
    let answers: Vec<Problem> = objections(&experiment).into_iter().chain(beyond).collect();
    if answers.is_empty() {
        return Ok(());
    }
    Err(Failure::No(answers.into_iter().map(Into::into).collect()))
}

/// That a run was broken off, and when.
fn broken_off(scenario: &Scenario, time: f64) -> String {
    let [time, end] = [time, scenario.duration].map(|seconds| short(seconds, 4));
    format!("{}: broken off at t = {time} s of {end} s", scenario.name)
}

/// Part of the energy that goes through a robot that its simulation may lose without a word.
const LOST_ENERGY: f64 = 1e-3;

/// A warning that the simulation does not keep the energy of the robot, if it does not.
fn unbalanced(Experiment { scenario, run, .. }: &Experiment) -> Option<Problem> {
    let drift = run.summary.energy_drift;
    let message = format!(
        "{}: the simulation gains or loses {} % of the energy that goes through the robot: what is printed of this run is not to be \
         relied on",
        scenario.name,
        short(100.0 * drift, 2)
    );
    let help = if scenario.is_rough() {
        "friction, play and hysteresis are stepped at 0.1 ms: springs or links of this robot are too fast for that"
    } else {
        "a smaller integration_tolerance in the scenario, or a shorter control_period"
    };
    // A loop that diverges is told for that.
    (run.divergence.is_none() && drift > LOST_ENERGY)
        .then(|| scenario.places.problem("integration_tolerance", "energy", message, help).warning())
}

/// What the table does not say of a real loop.
fn summary_line(summary: &Summary) -> Option<String> {
    let real = summary.rms_e_l.is_finite()
        && (!summary.imperfections.is_empty() || summary.stops > 0 || summary.suspended_fraction > 0.0);
    real.then(|| {
        format!(
            "rms |e_l| {:.3} mrad; motors gave other torques than the law's, or the guard acted, in {:.2} % of the run; \
             safe stops: {}",
            1e3 * summary.rms_e_l,
            100.0 * summary.suspended_fraction,
            summary.stops
        )
    })
}

/// Whether it follows, and what it was held to.
fn verdict(following: &Following) -> String {
    let answer = if following.follows { "yes" } else { "no" };
    let accepted = following.accepted.words().into_iter().map(|words| format!("\n  {words}"));
    format!("follows its reference: {answer}; accepted are{}", accepted.collect::<String>())
}

/// What to say of a loop that diverged, that is not stable as it is sampled, or that does not follow its reference.
pub fn objections(experiment: &Experiment) -> Vec<Problem> {
    if let Some(problem) = diverged(experiment) {
        return vec![problem];
    }
    let Experiment { scenario, sampled, .. } = experiment;
    // Why comes before what.
    let unstable = sampled.as_ref().and_then(|sampled| sampled.problem(scenario));
    unstable.into_iter().chain(lost(experiment)).collect()
}

/// Reasons that are told; the others are in the JSON.
const TOLD: usize = 4;

/// What to say of a loop that does not follow its reference.
fn lost(experiment: &Experiment) -> Option<Problem> {
    let Experiment { scenario, run, .. } = experiment;
    let reasons = &run.summary.following.reasons;
    let told: Vec<_> = reasons.iter().take(TOLD).map(|reason| reason.words.as_str()).collect();
    let more = match reasons.len().saturating_sub(TOLD) {
        0 => String::new(),
        more => format!(";\nand {more} more: `flexure run --json` has all of them"),
    };
    let message = format!("{}: the loop does not follow: {}{more}", scenario.name, told.join(";\n"));
    (!told.is_empty()).then(|| scenario.places.problem("reference", "lost", message, of_lost(experiment)))
}

/// What a loop may be lost by.
fn of_lost(Experiment { scenario, run, .. }: &Experiment) -> String {
    let lies = |imperfection: &Imperfection| ["dropout", "freeze", "jump"].contains(&imperfection.kind());
    if let Some(first) = run.faults.as_ref().and_then(|faults| faults.stops.first()) {
        let joint = first.joint.and_then(|joint| scenario.robot.joints.get(joint as usize));
        let at = match (first.side, joint) {
            (Some(side), Some(joint)) => format!(", {side} side of joint {}", joint.name),
            _ => String::new(),
        };
        return format!(
            "the guard stopped the robot at t = {} s: {}{at}; the columns `phase` and `fault` of the trace and `faults` of \
             `flexure run --json` tell the rest",
            short(first.time, 4),
            first.cause
        );
    }
    if scenario.guard.is_none() && scenario.imperfections.iter().any(lies) {
        return "readings fail in this loop and nothing looks at them: add [guard]".to_owned();
    }
    "what is accepted stands in [accept], or follows from the robot's limits and the reference; slower references and smooth starts \
     take less"
        .to_owned()
}

/// What to say of a loop that diverged.
fn diverged(experiment: &Experiment) -> Option<Problem> {
    let Experiment { scenario, run, sampled, .. } = experiment;
    run.divergence.map(|divergence| {
        let code = match divergence.cause {
            Cause::Unbounded => "diverged",
            Cause::Torque => "no-torque",
            Cause::Unsolvable => "unsolvable",
        };
        let unstable = sampled.as_ref().filter(|sampled| !sampled.stable);
        let hint = unstable
            .and_then(Sampled::help)
            .unwrap_or_else(|| of_large_signals(experiment, divergence.cause));
        let message = match unstable {
            Some(sampled) => format!("{}: {divergence}; {}", scenario.name, sampled.line()),
            None => format!("{}: {divergence}", scenario.name),
        };
        scenario.places.problem("control_period", code, message, hint + "; outputs end where the loop does")
    })
}

/// What may be wrong where small errors shrink.
fn of_large_signals(Experiment { scenario, sampled, .. }: &Experiment, cause: Cause) -> String {
    let small = match sampled {
        Some(_) => {
            "small errors shrink where the loop was looked at: it is the large ones, or what stands between law and robot; "
        }
        None => "",
    };
    let join = match scenario.smooth_start {
        Some(_) => "",
        None => "join the reference smoothly with [reference.smooth_start]; ",
    };
    let look = match cause {
        Cause::Unbounded => "look at limits, delays and noise",
        Cause::Torque => return "a sensor that drops out reads NaN: add [guard]".to_owned(),
        Cause::Unsolvable => {
            "check that the reference has four continuous derivatives; a shorter control_period, slower gains"
        }
    };
    format!("{small}{join}{look}")
}
