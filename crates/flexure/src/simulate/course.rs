//! A run on its way: what it is judged by so far, and what comes of it.

use std::time::Instant as Clock;

use crate::imperfections::Imperfection;
use crate::scenario::Scenario;
use crate::simulate::assembly;
use crate::simulate::criteria::Criteria;
use crate::simulate::figures::Figures;
use crate::simulate::following::{Following, Watch};
use crate::simulate::interface::{Loop, Observed};
use crate::simulate::run::Run;
use crate::simulate::simulation::Divergence;
use crate::simulate::summary::Summary;
use crate::simulate::trace::Trace;

/// A run of a scenario from its first control instant to its last.
pub(super) struct Course<'a> {
    scenario: &'a Scenario,
    started: Clock,
    observed: Observed,
    figures: Figures,
    watch: Watch,
    divergence: Option<Divergence>,
    /// When it was broken off \[s\].
    broken_off: Option<f64>,
    /// Instants that are still to come.
    left: u32,
}

impl<'a> Course<'a> {
    /// Of `held`, the loop of `scenario`, held to `criteria`; nothing has happened yet.
    pub(super) fn new(scenario: &'a Scenario, held: &dyn Loop, criteria: &Criteria) -> Self {
        let limits = assembly::acting_limits(scenario);
        Self {
            scenario,
            started: Clock::now(),
            observed: Observed::new(held.joints()),
            figures: Figures::new(limits.clone()),
            watch: Watch::new(criteria.clone(), limits),
            divergence: None,
            broken_off: None,
            left: scenario.periods() + 1,
        }
    }

    /// Whether there is another instant to go to.
    pub(super) fn goes_on(&self) -> bool {
        self.left > 0 && self.divergence.is_none() && self.broken_off.is_none()
    }

    /// Takes in the instant that the loop has come to, which is observed by `observe`, with the contraction rate there [1/s], NaN for none;
    /// gives the fraction of the run that is done.
    pub(super) fn record(&mut self, observe: impl FnOnce(&mut Observed), rate: f64) -> f64 {
        observe(&mut self.observed);
        self.figures.record(&self.observed, rate);
        self.watch.record(&self.observed);
        self.left -= 1;
        self.observed.t / self.scenario.duration
    }

    /// The loop diverged on the way to the next instant.
    pub(super) fn diverge(&mut self, divergence: Divergence) {
        self.divergence = Some(divergence);
    }

    /// Somebody breaks it off. The last instant is the end of the run, whoever watches.
    pub(super) fn break_off(&mut self) {
        if self.left > 0 {
            self.broken_off = Some(self.observed.t);
        }
    }

    /// What came of it, without a trace.
    pub(super) fn run(self, held: &dyn Loop) -> Run {
        let Self { scenario, figures, watch, divergence, broken_off, .. } = self;
        let seconds = self.started.elapsed().as_secs_f64();
        let following = watch.verdict(&scenario.robot.joints, divergence.as_ref(), broken_off);
        let summary = summary(scenario, &figures, following, held, divergence.is_some(), seconds);
        Run { summary, trace: Trace::default(), divergence, broken_off, faults: held.faults() }
    }
}

fn summary(
    scenario: &Scenario,
    figures: &Figures,
    following: Following,
    held: &dyn Loop,
    diverged: bool,
    wall_seconds: f64,
) -> Summary {
    // Errors of a run that diverged are beyond those that were recorded: no number stands for them.
    let ended = |error: f64| if diverged { f64::NAN } else { error };
    let rate = figures.seen(figures.rate);
    Summary {
        name: scenario.name.clone(),
        controller: scenario.controller.kind().to_owned(),
        phi: scenario.controller.phi().map(str::to_owned),
        plant: scenario.plant.options(),
        imperfections: scenario.imperfections.iter().map(Imperfection::kind).collect(),
        following,
        max_abs_e_l: ended(figures.max_abs_e_l),
        rms_e_l: ended(figures.rms_e_l()),
        final_abs_e_l: ended(figures.final_abs_e_l),
        settling_time: figures.settled_since.filter(|_| !diverged),
        max_abs_u_m: figures.seen(figures.max_abs_u_m),
        rms_u_m: figures.rms_u_m(),
        rms_torque_change: figures.rms_torque_change(),
        saturated_fraction: figures.limited_fraction(),
        suspended_fraction: figures.suspended_fraction(),
        stops: figures.stops,
        rate_pointwise: if rate.is_finite() { rate } else { f64::NAN },
        rate_certified: None,
        energy_drift: held.energy_drift(),
        steps: held.steps(),
        wall_seconds,
        kinds: scenario.robot.kinds(),
    }
}
