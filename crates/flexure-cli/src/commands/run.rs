//! `flexure run`: one closed loop.

use std::path::{Path, PathBuf};

use flexure::feasible;
use flexure::files::number::short;
use flexure::files::{Problem, Reading, folder_of, prepare_for, read_text};
use flexure::prove::documents::LARGEST;
use flexure::prove::sampled_data::beside::{Beside, InTube};
use flexure::prove::standing::outside_of_proofs;
use flexure::report::{RunTold, Verdict, summary_table, view_name, write_ran, write_view};
use flexure::reproduce::{Experiment, trace_file, write_experiment};
use flexure::sampled::{Sampled, not_looked_at};
use flexure::scenario::{Integration, Scenario, load_scenario_with};
use flexure::simulate::{Excerpt, Summary, preload};
use flexure::verify::Rejected;
use serde::Serialize;

use super::collocated::Collocated;
use super::objections::objections;
use super::print;
use super::ran::Outcome;
use super::verify::{clipped, malformed, shown};
use crate::args::Traced;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// Two runs, and the page that shows both.
#[derive(Serialize)]
struct Both<'a> {
    runs: Vec<Outcome<'a>>,
    files: Vec<PathBuf>,
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
    /// Where it was in the tube beside which it was watched.
    tube: Option<InTube>,
    /// What it is by collocation, if it was moved by midpoint steps.
    collocated: Option<Collocated>,
    files: Vec<PathBuf>,
    /// Its page and the figure of that, if they were asked for.
    pages: Vec<PathBuf>,
}

/// Runs scenarios, writes their files as `traced` says, and tells what came of them, after `first`: who prints before the end has no word
/// left for what Ctrl-C breaks off. What comes after a run that is broken off is not begun.
pub fn told(
    scenarios: Vec<Scenario>,
    first: Option<&str>,
    traced: &Traced,
    json: bool,
) -> Result<(), Failure> {
    let files = scenarios
        .iter()
        .flat_map(|scenario| ["csv", "svg", "png"].map(|ending| format!("{}.{ending}", scenario.name)));
    let view = traced.view.then(|| view_name(scenarios.iter()));
    prepare_for(&traced.output.out, files.chain(view))?;
    for scenario in &scenarios {
        let own = ["csv", "svg", "png", "view.html"];
        let own = own.map(|ending| traced.output.out.join(format!("{}.{ending}", scenario.name)));
        traced.paged.prepare(&scenario.name, "run", 1, &own)?;
    }
    let mut finished: Vec<Finished> = Vec::new();
    for scenario in scenarios {
        finished.push(run_of(scenario, traced)?);
        if finished.iter().any(|run| run.experiment.run.broken_off.is_some()) {
            break;
        }
    }
    let page = if traced.view { Some(page(&finished, &traced.output.out)?) } else { None };
    if let Some(folder) = &traced.paged.page {
        for run in &mut finished {
            run.pages = page_of(run, folder, page.as_deref())?;
        }
    }
    let mut broken_off = None;
    if json {
        document(&finished, page)?;
    } else {
        first.map_or(Ok(()), print::line)?;
        for run in &finished {
            in_words(run)?;
        }
        print::wrote(page.as_slice())?;
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

/// Runs a scenario and writes its trace and its figure.
fn run_of(scenario: Scenario, traced: &Traced) -> Result<Finished, Failure> {
    let Traced { output, columns, every, tube, view: _, paged: _ } = traced;
    let mut tube = tube.as_deref().map(|file| beside(file, &scenario)).transpose()?;
    let signals = scenario.signals()?;
    let signals = tube.as_ref().map_or(signals.clone(), |tube| tube.signals(signals));
    let excerpt = Excerpt::new(&signals, columns, *every)?;
    say(&scenario.warnings);
    say(&preload(&scenario)?);
    say(&feasible::slowed(&scenario)?);
    let beyond = feasible::exceeded(&scenario, &feasible::usage(&scenario)?);
    let mut trace = trace_file(&output.out, &scenario, excerpt)?;
    let (experiment, collocated) = {
        let progress = Progress::of_one(&scenario.name);
        let told = |fraction| progress.set(0, fraction);
        let experiment = match &mut tube {
            None => Experiment::new(scenario, &mut [&mut trace], &told)?,
            Some(tube) => Experiment::new(scenario, &mut [&mut tube.before(&mut trace)], &told)?,
        };
        let is_whole = experiment.run.broken_off.is_none();
        let collocated = is_whole.then(|| Collocated::of(&experiment.scenario, &told)).transpose()?.flatten();
        (experiment, collocated)
    };
    let tube = tube.map(|tube| tube.found());
    let files = write_experiment(&experiment, trace)?;
    if experiment.run.divergence.is_none() {
        say(&experiment.exceeded);
    }
    say(unbalanced(&experiment).as_slice());
    let left = tube.as_ref().and_then(|tube| outside(&experiment.scenario, tube));
    let beside = collocated.as_ref();
    let apart = beside.and_then(|beside| beside.disagreement(&experiment.scenario, &experiment.run.summary));
    let answers = match experiment.run.broken_off {
        Some(_) => Vec::new(),
        None => apart.into_iter().chain(objections(&experiment)).chain(beyond).chain(left).collect(),
    };
    Ok(Finished { experiment, answers, tube, collocated, files, pages: Vec::new() })
}

/// The tube of `file`, for a run of `scenario`.
fn beside(file: &Path, scenario: &Scenario) -> Result<Beside, Failure> {
    let text = read_text(file, LARGEST)?;
    Beside::new(&text, scenario)?.map_err(|rejected| match rejected {
        Rejected::Malformed { place, reason, line, column } => {
            malformed(file, "tube", &place, &reason, (line, column))
        }
        Rejected::False { claim, reason } => malformed(file, "tube", &claim, &reason, (None, None)),
    })
}

/// Where a run was in its tube: words of the file may be in it.
fn where_in(tube: &InTube) -> String {
    format!("the tube {}", clipped(&shown(&tube.words())))
}

/// That a run was not in its tube from beginning to end, if it was not.
fn outside(scenario: &Scenario, tube: &InTube) -> Option<Problem> {
    let is_out = tube.void.is_some() || tube.left.is_some();
    let message = format!("{}: {}", scenario.name, where_in(tube));
    let help = "what is proved of the tube is not known of this run; without --tube it is judged by itself";
    is_out.then(|| scenario.places.problem("controller", "tube", message, help))
}

/// The runs in motion, as a page.
fn page(finished: &[Finished], folder: &Path) -> Result<PathBuf, Failure> {
    let verdicts: Vec<Verdict> = finished.iter().map(Finished::verdict).collect();
    let viewed = finished.iter().zip(&verdicts);
    let viewed = viewed.map(|(finished, Verdict { good, words })| finished.experiment.viewed(*good, words));
    let (path, warnings) = write_view(folder, &viewed.collect::<Vec<_>>())?;
    say(&warnings);
    Ok(path)
}

/// The page of a run, with links to what it left in the same folder, the page in `motion` too.
fn page_of(run: &Finished, folder: &Path, motion: Option<&Path>) -> Result<Vec<PathBuf>, Failure> {
    let Experiment { scenario, run: ran, figure, proved, .. } = &run.experiment;
    let trace = run
        .files
        .first()
        .map(|path| (path.as_path(), "every signal at every control instant that was asked for"));
    let motion = motion.map(|path| (path, "the robot in motion"));
    let name = |(path, what): (&Path, &'static str)| Some((path.file_name()?.to_str()?.to_owned(), what));
    let beside: Vec<_> = trace
        .into_iter()
        .chain(motion)
        .filter(|(path, _)| folder_of(path) == folder)
        .filter_map(name)
        .collect();
    let warnings = run.experiment.exceeded.iter().cloned().chain(unbalanced(&run.experiment));
    let warned = if ran.divergence.is_none() {
        warnings.map(|warning| format!("Warning: {warning}.")).collect()
    } else {
        Vec::new()
    };
    let told = RunTold {
        scenario,
        summary: &ran.summary,
        end: ran.divergence.map(|divergence| divergence.time).or(ran.broken_off).unwrap_or(scenario.duration),
        verdict: &run.verdict(),
        figure,
        proved: *proved,
        notes: &[warned, run.notes()].concat(),
        beside: &beside,
    };
    Ok(write_ran(folder, &told)?)
}

impl Finished {
    /// Its summary and its files, `page` among them.
    fn outcome(&self, page: Option<PathBuf>) -> Outcome<'_> {
        let files = self.files.iter().cloned().chain(page).collect();
        Outcome {
            pages: self.pages.clone(),
            tube: self.tube.as_ref(),
            collocated: self.collocated.as_ref(),
            ..Outcome::new(&self.experiment, files)
        }
    }

    /// What the numbers do not say of the loop.
    fn notes(&self) -> Vec<String> {
        let Experiment { scenario, run, sampled, .. } = &self.experiment;
        let conditions = scenario.vcbc().map_or_else(|_| Vec::new(), |_| scenario.beyond_ideal());
        let sampled = sampled.as_ref().map(Sampled::line).or_else(|| not_looked_at(scenario));
        let tube = self.tube.as_ref().map(where_in);
        let collocated = self.collocated.as_ref().map(|collocated| collocated.line(&run.summary));
        let all = [summary_line(&run.summary), collocated, outside_of_proofs(&conditions), sampled, tube];
        all.into_iter().flatten().collect()
    }

    /// What came of it, and whether that is good: not known of a run that was broken off.
    fn verdict(&self) -> Verdict {
        let good = self.experiment.run.broken_off.is_none().then_some(self.answers.is_empty());
        Verdict { good, words: self.words() }
    }

    /// What came of it in a sentence.
    fn words(&self) -> String {
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
        runs => print::json(&Both {
            runs: runs.iter().map(|run| run.outcome(None)).collect(),
            files: page.into_iter().collect(),
        }),
    }
}

/// Prints what came of a run.
fn in_words(finished: &Finished) -> Result<(), Failure> {
    let Finished { experiment, files, pages, .. } = finished;
    let broken_off = experiment.run.broken_off.map(|time| words_of_end(&experiment.scenario, time));
    if let Some(words) = &broken_off {
        print::line(words)?;
    }
    print::line(&summary_table(std::slice::from_ref(&experiment.run.summary), print::columns()))?;
    finished.notes().iter().try_for_each(|line| print::line(line))?;
    if broken_off.is_none() {
        print::line(&verdict(&experiment.run.summary))?;
    }
    print::wrote(files)?;
    print::wrote(pages)
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
    let (key, help) = if scenario.is_rough() {
        (
            "imperfection",
            "friction, play and hysteresis are stepped at 0.1 ms: springs or links of this robot are too fast for that",
        )
    } else if scenario.integration == Integration::Midpoint {
        ("integration", "remove integration = \"midpoint\": its steps of 1 ms are too long for this loop")
    } else {
        (
            "integration_tolerance",
            "a smaller integration_tolerance in the scenario, or a shorter control_period",
        )
    };
    // A loop that diverges is told for that.
    (run.divergence.is_none() && drift > LOST_ENERGY)
        .then(|| scenario.places.problem(key, "energy", message, help).warning())
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
fn verdict(summary: &Summary) -> String {
    let following = &summary.following;
    let answer = if following.follows { "yes" } else { "no" };
    let accepted = following.accepted.words(&summary.kinds).into_iter().map(|words| format!("\n  {words}"));
    format!("follows its reference: {answer}; accepted are{}", accepted.collect::<String>())
}
