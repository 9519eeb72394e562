//! `flexure run`: one closed loop.

use std::path::{Path, PathBuf};

use flexure::feasible;
use flexure::files::{Problem, prepare};
use flexure::report::summary_table;
use flexure::reproduce::{Experiment, write_experiment};
use flexure::scenario::load_scenario;
use flexure::simulate::{Cause, Summary, exceeded, preload};
use serde::Serialize;

use super::print;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// A summary and where the files are.
#[derive(Serialize)]
pub struct Outcome<'a> {
    #[serde(flatten)]
    pub summary: &'a Summary,
    /// Time of divergence in s; none if the loop ran to the end.
    pub diverged_at: Option<f64>,
    pub files: Vec<PathBuf>,
}

impl<'a> Outcome<'a> {
    pub fn new(experiment: &'a Experiment, files: Vec<PathBuf>) -> Self {
        let diverged_at = experiment.run.divergence.map(|divergence| divergence.time);
        Self { summary: &experiment.run.summary, diverged_at, files }
    }
}

pub fn run(scenario: &str, out: &Path, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario(scenario)?;
    say(&scenario.warnings);
    say(&preload(&scenario)?);
    let beyond = feasible::exceeded(&scenario, &feasible::usage(&scenario)?);
    prepare(out)?;
    let experiment = {
        let progress = Progress::new(&scenario.name, 1);
        Experiment::new(scenario, &|fraction| progress.set(0, fraction))?
    };
    let files = write_experiment(out, &experiment)?;
    if experiment.run.divergence.is_none() {
        say(&exceeded(&experiment.scenario.robot, &experiment.run.trace));
    }
    if json {
        print::json(&Outcome::new(&experiment, files))?;
    } else {
        print::line(&summary_table(std::slice::from_ref(&experiment.run.summary)))?;
        if let Some(line) = summary_line(&experiment.run.summary) {
            print::line(&line)?;
        }
        for file in &files {
            print::line(&format!("wrote {}", file.display()))?;
        }
    }
    let answers: Vec<Problem> = diverged(&experiment).into_iter().chain(beyond).collect();
    if answers.is_empty() {
        return Ok(());
    }
    Err(Failure::No(answers.into_iter().map(Into::into).collect()))
}

/// What the table does not say of a real loop.
fn summary_line(summary: &Summary) -> Option<String> {
    let real = !summary.imperfections.is_empty() || summary.stops > 0 || summary.suspended_fraction > 0.0;
    real.then(|| {
        format!(
            "rms |e_l| {:.3} mrad; no certificate could hold for {:.2} % of the run; safe stops: {}",
            1e3 * summary.rms_e_l,
            100.0 * summary.suspended_fraction,
            summary.stops
        )
    })
}

/// What to say of a loop that diverged.
pub fn diverged(experiment: &Experiment) -> Option<Problem> {
    let Experiment { scenario, run, .. } = experiment;
    run.divergence.map(|divergence| {
        let (code, hint) = match divergence.cause {
            Cause::Unbounded => (
                "diverged",
                "shorten control_period, lower the gains, or join the reference smoothly with \
                 [reference.smooth_start]; outputs end where the loop does",
            ),
            Cause::Torque => (
                "no-torque",
                "a sensor that drops out reads NaN: add [guard]; or gains are too high; outputs end where the loop does",
            ),
            Cause::Unsolvable => (
                "unsolvable",
                "shorten control_period, lower the gains, and check that the reference has four continuous \
                 derivatives; outputs end there",
            ),
        };
        let message = format!("{}: {divergence}", scenario.name);
        scenario.places.problem("control_period", code, message, hint)
    })
}
