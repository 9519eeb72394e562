//! A scenario as a simulated run: from its file to trace and summary.

use std::ops::ControlFlow;

use crate::files::Problems;
use crate::progress::{Progress, unwatched};
use crate::scenario::Scenario;
use crate::simulate::course::Course;
use crate::simulate::criteria::Criteria;
use crate::simulate::fault_log::FaultLog;
use crate::simulate::interface::{Loop, Signal};
use crate::simulate::own_law::{OwnLaw, OwnShaping};
use crate::simulate::simulation::Divergence;
use crate::simulate::sink::Sink;
use crate::simulate::summary::Summary;
use crate::simulate::trace::Trace;

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Errors, torques and rates that the run is judged by.
    pub summary: Summary,
    /// Every control instant; empty if it went elsewhere ([`run_into`]), or only the figures were asked for.
    pub trace: Trace,
    /// Set if the loop diverged before the end; trace and summary then end there.
    pub divergence: Option<Divergence>,
    /// When it was broken off \[s\], if it was: trace and summary end there, and it does not count as following.
    pub broken_off: Option<f64>,
    /// What the guard kept of its stops; none without a guard.
    pub faults: Option<FaultLog>,
}

impl Scenario {
    /// Simulates it from beginning to end: [`run`] that nobody watches.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn simulate(&self) -> Result<Run, Problems> {
        run(self, &unwatched)
    }

    /// The columns of the trace of its runs: what a [`Sink`] is given the numbers of.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn signals(&self) -> Result<Vec<Signal>, Problems> {
        Ok(self.open()?.signals().to_vec())
    }
}

/// Simulates a scenario. `progress` is told the fraction done at every control instant; what it breaks off ends there
/// ([`Run::broken_off`]).
///
/// # Errors
/// As [`Scenario::open`].
pub fn run(scenario: &Scenario, progress: Progress<'_>) -> Result<Run, Problems> {
    Ok(traced(scenario, scenario.open()?, &Criteria::of(scenario)?, progress))
}

/// As [`run`], but that the rows of the trace go to `sinks` as they are made, and stay nowhere else: what a run holds does not grow
/// with its duration then. Each sink is given every row, until one of them breaks the run off.
///
/// # Errors
/// As [`Scenario::open`].
pub fn run_into(
    scenario: &Scenario,
    sinks: &mut [&mut dyn Sink],
    progress: Progress<'_>,
) -> Result<Run, Problems> {
    Ok(simulated(scenario, scenario.open()?, &Criteria::of(scenario)?, progress, Some(sinks)))
}

/// As [`run`], with the law of the caller in the place of the scenario's own.
///
/// # Errors
/// As [`Scenario::open`].
pub fn run_with(scenario: &Scenario, law: OwnLaw, progress: Progress<'_>) -> Result<Run, Problems> {
    let mut run = traced(scenario, scenario.open_with(law)?, &Criteria::of(scenario)?, progress);
    (run.summary.controller, run.summary.phi) = ("own".to_owned(), None);
    Ok(run)
}

/// As [`run`], with the shaping function of the caller in the place of that of the scenario's v-CBC law.
///
/// # Errors
/// As [`Scenario::open_shaped`].
pub fn run_shaped(
    scenario: &Scenario,
    shaping: &OwnShaping,
    progress: Progress<'_>,
) -> Result<Run, Problems> {
    let held = scenario.open_shaped(shaping)?;
    let mut run = traced(scenario, held, &Criteria::of(scenario)?, progress);
    run.summary.phi = Some("own".to_owned());
    Ok(run)
}

/// Simulates a scenario for its figures alone: no trace, no rates. Faster, for many runs.
///
/// # Errors
/// As [`Scenario::open`].
pub fn measure(scenario: &Scenario) -> Result<Run, Problems> {
    measure_by(scenario, &Criteria::of(scenario)?)
}

/// As [`measure`], held to `criteria`: for many runs that are held to the same ones.
///
/// # Errors
/// As [`Scenario::open`].
pub fn measure_by(scenario: &Scenario, criteria: &Criteria) -> Result<Run, Problems> {
    Ok(simulated(scenario, scenario.open()?, criteria, &unwatched, None))
}

/// As [`measure_by`], with `progress` told the fraction done at every control instant.
///
/// # Errors
/// As [`Scenario::open`], and [`Problems::interrupted`] if it was broken off: figures of a part of a run say nothing of the
/// whole.
pub fn measure_watched(
    scenario: &Scenario,
    criteria: &Criteria,
    progress: Progress<'_>,
) -> Result<Run, Problems> {
    let run = simulated(scenario, scenario.open()?, criteria, progress, None);
    if run.broken_off.is_some() { Err(Problems::interrupted()) } else { Ok(run) }
}

/// Moves `held`, the loop of `scenario`, from beginning to end, and keeps its trace.
fn traced(scenario: &Scenario, held: Box<dyn Loop>, criteria: &Criteria, progress: Progress<'_>) -> Run {
    let mut trace = Trace::from(held.signals());
    let run = simulated(scenario, held, criteria, progress, Some(&mut [&mut trace]));
    Run { trace, ..run }
}

/// Moves `held`, the loop of `scenario`, from beginning to end; nothing but what it is judged by is read without `sinks`.
fn simulated(
    scenario: &Scenario,
    mut held: Box<dyn Loop>,
    criteria: &Criteria,
    progress: Progress<'_>,
    sinks: Option<&mut [&mut dyn Sink]>,
) -> Run {
    let mut course = Course::new(scenario, &*held, criteria);
    let mut reader = sinks.map(|sinks| Reader::new(&*held, sinks));
    while course.goes_on() {
        if let Err(diverged) = held.step() {
            course.diverge(diverged);
            break;
        }
        let (rate, taken) = match &mut reader {
            Some(reader) => reader.read(&*held),
            None => (f64::NAN, ControlFlow::Continue(())),
        };
        let done = course.record(|observed| held.observe(observed).expect("made for it"), rate);
        if progress(done).is_break() || taken.is_break() {
            course.break_off();
        }
    }
    course.run(&*held)
}

/// Reads every signal at every instant, for every sink.
struct Reader<'a, 'b> {
    sinks: &'a mut [&'b mut dyn Sink],
    row: Vec<f64>,
    /// The column of the contraction rate, if there is one.
    rate: Option<usize>,
}

impl<'a, 'b> Reader<'a, 'b> {
    fn new(held: &dyn Loop, sinks: &'a mut [&'b mut dyn Sink]) -> Self {
        let signals = held.signals();
        let rate = signals.iter().position(|signal| signal.name == "rate");
        Self { sinks, row: vec![0.0; signals.len()], rate }
    }

    /// Reads a row; returns the contraction rate [1/s], NaN for none, and whether a sink breaks off.
    fn read(&mut self, held: &dyn Loop) -> (f64, ControlFlow<()>) {
        held.read(&mut self.row).expect("a slot per signal");
        let mut taken = ControlFlow::Continue(());
        for sink in self.sinks.iter_mut() {
            if sink.take(&self.row).is_break() {
                taken = ControlFlow::Break(());
            }
        }
        (self.rate.map_or(f64::NAN, |column| self.row[column]), taken)
    }
}
