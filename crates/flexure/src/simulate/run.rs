//! A scenario as a simulated run: from its file to trace and summary.

use std::time::Instant as Clock;

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::feasible;
use crate::files::{Problem, Problems};
use crate::imperfections::Imperfection;
use crate::laws::{self, AnyLaw, BlockRates, any_law};
use crate::robot::{PairVisitor, with_pair};
use crate::scenario::Scenario;
use crate::simulate::figures::Figures;
use crate::simulate::recorder::{Columns, Recorder};
use crate::simulate::summary::Summary;
use crate::simulate::trace::Trace;
use crate::simulate::{Divergence, Instant, Outcome, assembly};

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What it is judged by.
    pub summary: Summary,
    /// Every control instant; empty if only the figures were asked for.
    pub trace: Trace,
    /// Set if the loop diverged before the end; trace and summary then end there.
    pub divergence: Option<Divergence>,
}

/// Simulates a scenario. `progress` is told the fraction done, now and then.
///
/// # Errors
/// If the robot has more joints than this program was built for, its links cannot contain its coupled rotors, or the
/// samples of the reference make no path.
pub fn run(scenario: &Scenario, progress: &(dyn Fn(f64) + Sync)) -> Result<Run, Problems> {
    simulate(scenario, progress, true)
}

/// Simulates a scenario for its figures alone: no trace, no rates. Faster, for many runs.
///
/// # Errors
/// As [`run`].
pub fn measure(scenario: &Scenario) -> Result<Run, Problems> {
    simulate(scenario, &|_| (), false)
}

fn simulate(scenario: &Scenario, progress: &(dyn Fn(f64) + Sync), traced: bool) -> Result<Run, Problems> {
    let simulated = assembly::simulated(scenario);
    with_pair(&scenario.robot, &simulated, Simulate { scenario, progress, traced })?
}

struct Simulate<'a> {
    scenario: &'a Scenario,
    progress: &'a (dyn Fn(f64) + Sync),
    traced: bool,
}

impl PairVisitor for Simulate<'_> {
    type Output = Result<Run, Problems>;

    fn visit<L: Links<f64, N> + Clone + Sync, const N: usize>(
        self,
        model: Fjr<f64, L, N>,
        simulated: Fjr<f64, L, N>,
    ) -> Self::Output {
        let Self { scenario, progress, traced } = self;
        let started = Clock::now();
        let plant = assembly::plant(scenario, simulated);
        let start = assembly::initial(scenario);
        if !plant.carries_its_rotors(&start.q_l) {
            return Err(too_heavy(scenario).into());
        }
        let law: AnyLaw<f64, N> = any_law(&scenario.controller, |x| x);
        let reference = feasible::reference::<N>(scenario)?;
        let torque =
            |_: f64, x: &Motion<f64, N>, q_ld: &Vector<Jet<f64, 5>, N>| laws::torque(&law, &model, x, q_ld);
        let mut controller = assembly::controller(scenario, &model, &reference, torque, &start);
        let mut recorder = traced.then(|| Recorder::new(N, columns(scenario, &law)));
        let mut figures = Figures::new(assembly::torque_limit(scenario));
        let mut observe = |instant: &Instant<'_, N>| {
            let errors = match (&law, &recorder) {
                (AnyLaw::Vcbc(law), Some(_)) => {
                    let command = laws::command(law, &model, instant.motion, &instant.action.reference);
                    let rate = BlockRates::at(&model, law, &instant.motion.q_l, &command).overall();
                    Some((command, rate))
                }
                _ => None,
            };
            figures.record(instant, errors.map_or(f64::NAN, |(_, rate)| rate));
            if let Some(recorder) = &mut recorder {
                recorder.record(&model, instant, errors.as_ref().map(|(command, rate)| (command, *rate)));
            }
            progress(instant.t / scenario.duration);
        };
        let settings = assembly::settings(scenario);
        let pushes = assembly::pushes(scenario);
        let outcome = settings.run(&plant, start, &pushes, &mut controller, &mut observe);
        let trace = recorder.map(Recorder::finish).unwrap_or_default();
        let summary = summary(scenario, &figures, &outcome, started.elapsed().as_secs_f64());
        Ok(Run { summary, trace, divergence: outcome.divergence })
    }
}

/// What is recorded of a run.
fn columns<const N: usize>(scenario: &Scenario, law: &AnyLaw<f64, N>) -> Columns {
    let Scenario { imperfections, estimator, disturbance_observer, guard, .. } = scenario;
    Columns {
        errors: matches!(law, AnyLaw::Vcbc(_)),
        devices: imperfections.iter().any(Imperfection::is_of_devices)
            || estimator.is_some()
            || disturbance_observer.is_some()
            || guard.is_some(),
    }
}

fn summary<const N: usize>(
    scenario: &Scenario,
    figures: &Figures<N>,
    outcome: &Outcome,
    wall_seconds: f64,
) -> Summary {
    // Errors of a run that diverged are beyond those that were recorded: no number stands for them.
    let ended = |error: f64| if outcome.divergence.is_none() { error } else { f64::NAN };
    let rate = figures.seen(figures.rate);
    Summary {
        name: scenario.name.clone(),
        controller: scenario.controller.kind().to_owned(),
        phi: scenario.controller.phi().map(str::to_owned),
        plant: scenario.plant.options(),
        imperfections: scenario.imperfections.iter().map(Imperfection::kind).collect(),
        max_abs_e_l: ended(figures.max_abs_e_l),
        rms_e_l: ended(figures.rms_e_l()),
        final_abs_e_l: ended(figures.final_abs_e_l),
        settling_time: figures.settled_since.filter(|_| outcome.divergence.is_none()),
        max_abs_u_m: figures.seen(figures.max_abs_u_m),
        rms_u_m: figures.rms_u_m(),
        rms_torque_change: figures.rms_torque_change(),
        saturated_fraction: figures.limited_fraction(),
        suspended_fraction: figures.suspended_fraction(),
        stops: figures.stops,
        rate_measured: if rate.is_finite() { rate } else { f64::NAN },
        rate_certified: None,
        energy_drift: outcome.energy_drift,
        steps: outcome.steps,
        wall_seconds,
    }
}

fn too_heavy(scenario: &Scenario) -> Problem {
    let message = format!(
        "with coupled rotors the mass matrix of {} is not positive definite at the start",
        scenario.robot.name
    );
    let help = "rotors have motor_inertia / gear_ratio² about their axes, and link inertias must contain the rotors that \
                the links carry: a gear ratio is too small, or the links lack their motors";
    scenario.places.problem("plant.rotor_coupling", "rotors", message, help)
}
