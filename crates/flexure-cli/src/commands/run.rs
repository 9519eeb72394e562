//! `flexure run`: one closed loop.

use std::path::{Path, PathBuf};

use flexure::feasible;
use flexure::files::number::short;
use flexure::files::{Problem, Reading, prepare};
use flexure::imperfections::Imperfection;
use flexure::prove::standing::outside_of_proofs;
use flexure::report::{summary_table, unseen, write_view};
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

/// Two runs, and the page that shows both.
#[derive(Serialize)]
struct Beside<'a> {
    runs: Vec<Outcome<'a>>,
    files: Vec<PathBuf>,
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

pub fn run(
    scenario: &str,
    beside: Option<&str>,
    reading: Reading<'_>,
    traced: &Traced,
    json: bool,
) -> Result<(), Failure> {
    if beside.is_some() && !traced.view {
        let message = "a second scenario is there for the page that shows both".to_owned();
        return Err(Failure::input("usage", message, "add --view, or run them one after the other"));
    }
    let mut scenarios = Vec::new();
    for name in [Some(scenario), beside].into_iter().flatten() {
        scenarios.push(load_scenario_with(name, reading)?);
    }
    if let [one, other] = scenarios.as_slice()
        && one.name == other.name
    {
        let message = format!("both scenarios are called {}, and so would be their files", one.name);
        return Err(Failure::input(
            "usage",
            message,
            "a scenario is called as its file: copy one under another name",
        ));
    }
    told(scenarios, None, traced, json)
}

/// A run with what it left, and what it was asked.
struct Finished {
    experiment: Experiment,
    /// The answers that are no, the first first; nothing for a run that was broken off, of which that is not known.
    answers: Vec<Problem>,
    files: Vec<PathBuf>,
}

/// Runs scenarios, writes their files as `traced` says, and tells what came of them, after `first`: who prints before the end has no word
/// left for what Ctrl-C breaks off. What comes after a run that is broken off is not begun.
pub fn told(
    scenarios: Vec<Scenario>,
    first: Option<&str>,
    traced: &Traced,
    json: bool,
) -> Result<(), Failure> {
    free(&scenarios, traced)?;
    let mut finished: Vec<Finished> = Vec::new();
    for scenario in scenarios {
        if traced.view {
            say(unseen(&scenario.robot).as_slice());
        }
        finished.push(run_of(scenario, traced)?);
        if finished.iter().any(|run| run.experiment.run.broken_off.is_some()) {
            break;
        }
    }
    let page = if traced.view { Some(page(&finished, &traced.output.out)?) } else { None };
    let mut broken_off = None;
    if json {
        document(&finished, page)?;
    } else {
        first.map_or(Ok(()), print::line)?;
        for run in &finished {
            in_words(run)?;
        }
        if let Some(page) = page {
            print::line(&format!("wrote {}", page.display()))?;
        }
    }
    let mut answers = Vec::new();
    for Finished { experiment, answers: own, .. } in finished {
        broken_off =
            broken_off.or(experiment.run.broken_off.map(|time| words_of_end(&experiment.scenario, time)));
        answers.extend(own.into_iter().map(Into::into));
    }
    if let Some(words) = broken_off {
        return Err(Failure::interrupted(
            words,
            "summary, trace and figure end there; whether it follows is not known",
        ));
    }
    if answers.is_empty() { Ok(()) } else { Err(Failure::No(answers)) }
}

/// Bytes of a file's name, at most, on every system in use.
const LONGEST_NAME: usize = 255;

/// Whether all that is to be written can be: no folder has the name, and none is too long. A run may take an hour.
fn free(scenarios: &[Scenario], traced: &Traced) -> Result<(), Failure> {
    let names: Vec<&str> = scenarios.iter().map(|scenario| scenario.name.as_str()).collect();
    let page = traced.view.then(|| format!("{}.view.html", names.join("-and-")));
    let files = names.iter().flat_map(|name| ["csv", "svg", "png"].map(|ending| format!("{name}.{ending}")));
    for file in files.chain(page) {
        let is_long = file.len() > LONGEST_NAME;
        let path = traced.output.out.join(file);
        let objection = if is_long {
            "has a name that is too long"
        } else if path.is_dir() {
            "is not a regular file"
        } else {
            continue;
        };
        let message = format!("{} {objection}", path.display());
        let help = "files are called as the scenario: give it another name, or another --out";
        return Err(Failure::input("write", message, help));
    }
    Ok(())
}

/// Runs a scenario and writes its trace and its figure.
fn run_of(scenario: Scenario, traced: &Traced) -> Result<Finished, Failure> {
    let Traced { output, columns, every, view: _ } = traced;
    let signals = scenario.signals()?;
    let excerpt = Excerpt::new(&signals, columns, *every)?;
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
    if experiment.run.divergence.is_none() {
        say(&experiment.exceeded);
    }
    say(unbalanced(&experiment).as_slice());
    let answers = match experiment.run.broken_off {
        Some(_) => Vec::new(),
        None => objections(&experiment).into_iter().chain(beyond).collect(),
    };
    Ok(Finished { experiment, answers, files })
}

/// The runs in motion, as a page.
fn page(finished: &[Finished], folder: &Path) -> Result<PathBuf, Failure> {
    let words: Vec<String> = finished.iter().map(Finished::verdict).collect();
    let viewed = finished.iter().zip(&words).map(|(finished, words)| {
        let good = finished.answers.is_empty() && finished.experiment.run.broken_off.is_none();
        finished.experiment.viewed(good, words)
    });
    Ok(write_view(folder, &viewed.collect::<Vec<_>>())?)
}

impl Finished {
    /// Its summary and its files, `page` among them.
    fn outcome(&self, page: Option<PathBuf>) -> Outcome<'_> {
        Outcome::new(&self.experiment, self.files.iter().cloned().chain(page).collect())
    }

    /// What came of it in a sentence.
    fn verdict(&self) -> String {
        let Experiment { scenario, run, .. } = &self.experiment;
        match (run.broken_off, self.answers.first()) {
            (Some(time), _) => words_of_end(scenario, time),
            (None, Some(_)) => {
                let prefix = format!("{}: ", scenario.name);
                let first = |answer: &Problem| {
                    let words = answer.to_string();
                    let words = words.strip_prefix(&prefix).unwrap_or(&words);
                    words.split(";\n").next().unwrap_or(words).to_owned()
                };
                let stops = run.summary.stops;
                let stopped = (stops > 0).then(|| format!("the guard stopped the robot {stops} times"));
                self.answers.iter().map(first).chain(stopped).collect::<Vec<_>>().join("; ")
            }
            (None, None) => run.summary.in_words(),
        }
    }
}

/// Prints what came of runs as JSON: of one as it is, of two as a list.
fn document(finished: &[Finished], page: Option<PathBuf>) -> Result<(), Failure> {
    match finished {
        [one] => print::json(&one.outcome(page)),
        runs => print::json(&Beside {
            runs: runs.iter().map(|run| run.outcome(None)).collect(),
            files: page.into_iter().collect(),
        }),
    }
}

/// Prints what came of a run.
fn in_words(Finished { experiment, files, .. }: &Finished) -> Result<(), Failure> {
    let broken_off = experiment.run.broken_off.map(|time| words_of_end(&experiment.scenario, time));
    if let Some(words) = &broken_off {
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
    for file in files {
        print::line(&format!("wrote {}", file.display()))?;
    }
    Ok(())
}

/// That a run was broken off, and when.
fn words_of_end(scenario: &Scenario, time: f64) -> String {
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
