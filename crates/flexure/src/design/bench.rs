//! Gains on trial: what the loop does with them, and what that costs.

use rayon::prelude::*;

use crate::design::constraint::{Constraint, NOMINAL};
use crate::design::spec::Spec;
use crate::design::watch::Watch;
use crate::feasible;
use crate::files::Problems;
use crate::files::number::short;
use crate::laws::Controller;
use crate::margins::Change;
use crate::prove::sampled_data::{rate_in_tubes, reads_exactly};
use crate::sampled::Outlook;
use crate::scenario::Scenario;
use crate::simulate::{Criteria, Run, measure_together};
use crate::tune::penalised_error;

/// The loops that gains are tried in.
pub(super) struct Bench {
    /// The loop under each reference.
    pub scenarios: Vec<Scenario>,
    criteria: Vec<Criteria>,
    /// The same loops with something that they shall bear.
    corners: Vec<Corner>,
    /// Largest part of the instants at which a torque limit may act.
    at_limit: f64,
    /// The rate that tubes of the sampled loop shall have [1/s], if that is asked.
    pub sampled_rate: Option<f64>,
}

/// Something that a loop shall bear.
struct Corner {
    /// What it is, in words.
    what: String,
    change: Change,
    /// Whether the SPEC says so; else it is wished for.
    asked: bool,
    /// The loop under each reference with it.
    scenarios: Vec<Scenario>,
}

/// The sampled loops of a bench, gains aside.
pub(super) struct Outlooks<'a> {
    nominal: Vec<Outlook<'a>>,
    corners: Vec<Vec<Outlook<'a>>>,
    /// The corner with more delay, if there is one.
    late: Option<usize>,
}

/// Gains that were tried.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub controller: Controller,
    /// What it costs: the less the better, and what keeps every constraint costs less than anything that does not.
    pub cost: f64,
    /// Every constraint that was looked at.
    pub constraints: Vec<Constraint>,
    /// The runs; none of loops that are unstable as sampled.
    pub runs: Vec<Run>,
}

/// What it costs at least not to bear what is wished for, and to break a constraint: more than the logarithm of any error.
const FRAIL: f64 = 50.0;
const BROKEN: f64 = 100.0;
const DIVERGED: f64 = 200.0;
const UNSTABLE: f64 = 300.0;

/// Part of the rate that is looked for in a tube that is shown, about: on exact readings, and where they are off.
const SHOWN: [f64; 2] = [0.97, 0.8];

impl Trial {
    /// Whether every constraint is kept that was looked at, wishes aside.
    pub fn keeps(&self) -> bool {
        self.constraints.iter().all(Constraint::is_met)
    }
}

impl Bench {
    /// The loops of `scenarios`, and what `spec` wants them to bear.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn new(scenarios: &[Scenario], spec: &Spec) -> Result<Self, Problems> {
        let scenarios = scenarios.iter().map(feasible::pinned).collect::<Result<Vec<_>, _>>()?;
        let criteria = scenarios.iter().map(Criteria::of).collect::<Result<_, _>>()?;
        let corner = |(what, change, asked): (String, Change, bool)| {
            let changed = scenarios.iter().map(|scenario| change.of(scenario)).collect();
            Corner { what, change, asked, scenarios: changed }
        };
        let corners = wanted(scenarios[0].control_period, spec).into_iter().map(corner).collect();
        let at_limit = scenarios[0].accept.at_limit.unwrap_or(0.0);
        Ok(Self { scenarios, criteria, corners, at_limit, sampled_rate: spec.sampled_rate })
    }

    /// Looks at the sampled loops, gains aside: once for all trials.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn outlooks(&self) -> Result<Outlooks<'_>, Problems> {
        fn of(scenarios: &[Scenario]) -> Result<Vec<Outlook<'_>>, Problems> {
            scenarios.par_iter().map(Outlook::new).collect()
        }
        let corners =
            self.corners.par_iter().map(|corner| of(&corner.scenarios)).collect::<Result<_, _>>()?;
        let is_late = |corner: &Corner| matches!(corner.change, Change::Delay(more) if more > 0.0);
        let late = self.corners.iter().position(is_late);
        Ok(Outlooks { nominal: of(&self.scenarios)?, corners, late })
    }

    /// Tries `controller`; `cost` makes one of the error in rad of a loop that keeps its constraints. Corners are looked at where it
    /// would else cost less than `best`.
    ///
    /// # Errors
    /// As [`Scenario::open`], and [`Problems::interrupted`] if `watch` breaks it off.
    pub fn try_out(
        &self,
        outlooks: &Outlooks<'_>,
        controller: Controller,
        cost: impl Fn(f64) -> f64,
        best: f64,
        watch: &Watch<'_>,
    ) -> Result<Trial, Problems> {
        watch.check()?;
        let radius = outlooks.nominal(&controller);
        let mut constraints: Vec<_> =
            radius.map(|radius| Constraint::radius(NOMINAL.to_owned(), radius)).into_iter().collect();
        if let Some(unstable) = constraints.iter().find(|constraint| !constraint.is_kept()) {
            let cost = UNSTABLE + bounded(unstable.value - 1.0);
            return Ok(Trial { controller, cost, constraints, runs: Vec::new() });
        }
        let rate = self.sampled_rate.zip(radius).map(|(asked, radius)| self.outlook(asked, radius));
        constraints.extend(rate);
        let runs = self.runs(&self.scenarios, &controller, watch)?;
        let diverged = |(run, scenario): (&Run, &Scenario)| Some((run.divergence?.time, scenario.duration));
        if let Some((time, duration)) = runs.iter().zip(&self.scenarios).find_map(diverged) {
            constraints.push(Constraint::diverged(time, duration));
            let cost = DIVERGED + bounded(1.0 / (time + 1e-3));
            return Ok(Trial { controller, cost, constraints, runs });
        }
        constraints.extend(Constraint::of_runs(&runs, self.at_limit));
        let error = runs.iter().map(|run| penalised_error(&run.summary)).fold(0.0, f64::max);
        let kept = cost(error);
        // Where others than the best may be chosen, corners of all are looked at.
        let best = if self.sampled_rate.is_some() { f64::INFINITY } else { best };
        if broken(&constraints, true) == 0.0 && kept < best {
            watch.check()?;
            constraints.extend(self.borne(outlooks, &controller));
        }
        let (excess, frail) = (broken(&constraints, true), broken(&constraints, false));
        let cost = if excess > 0.0 {
            BROKEN + bounded(excess)
        } else if frail > 0.0 {
            FRAIL + 0.5 * bounded(frail)
        } else {
            kept
        };
        Ok(Trial { controller, cost, constraints, runs })
    }

    /// What a tube of a loop in which small errors grow by `radius` in a control period may have of the rate that is `asked` \[1/s\].
    fn outlook(&self, asked: f64, radius: f64) -> Constraint {
        let scenario = &self.scenarios[0];
        let [exact, off] = SHOWN;
        let shown = if reads_exactly(scenario) { exact } else { off };
        let decay = -radius.ln() / scenario.control_period;
        let rate = shown * rate_in_tubes(decay);
        let [shrink, has, wanted] = [decay, rate, asked].map(|rate| short(rate, 4));
        let note = format!(
            "small errors shrink by {shrink} 1/s, so that a tube may have about {has} 1/s, and {wanted} 1/s are asked"
        );
        Constraint::outlook(rate, asked, (rate < asked).then_some(note))
    }

    /// The spectral radius at each corner that is looked at.
    fn borne(&self, outlooks: &Outlooks<'_>, controller: &Controller) -> Vec<Constraint> {
        let radii: Vec<Option<f64>> =
            outlooks.corners.par_iter().map(|corner| largest(corner.iter(), controller)).collect();
        let named = self.corners.iter().zip(radii);
        let constraint = |(corner, radius): (&Corner, Option<f64>)| {
            Some(Constraint::radius(corner.what.clone(), radius?).asked(corner.asked))
        };
        named.filter_map(constraint).collect()
    }

    /// What the loop does not bear although small errors shrink in it: each corner in which some run does not follow.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn lost_at(&self, controller: &Controller, watch: &Watch<'_>) -> Result<Vec<Constraint>, Problems> {
        let lost = |corner: &Corner| {
            let runs = self.runs(&corner.scenarios, controller, watch)?;
            let reason = runs.iter().flat_map(|run| &run.summary.following.reasons).next();
            Ok(reason.map(|reason| Constraint::lost(&corner.what, &reason.words).asked(corner.asked)))
        };
        let lost: Vec<_> = self.corners.par_iter().map(lost).collect::<Result<_, Problems>>()?;
        Ok(lost.into_iter().flatten().collect())
    }

    /// How many things the loops shall bear.
    pub fn corners(&self) -> usize {
        self.corners.len()
    }

    fn runs(
        &self,
        scenarios: &[Scenario],
        controller: &Controller,
        watch: &Watch<'_>,
    ) -> Result<Vec<Run>, Problems> {
        let scenarios: Vec<Scenario> = scenarios.iter().map(|scenario| scenario.under(controller)).collect();
        let jobs: Vec<_> = scenarios.iter().zip(&self.criteria).collect();
        measure_together(&jobs, &|_, _| watch.go_on()).into_iter().collect()
    }
}

impl Outlooks<'_> {
    /// By what small errors grow in the loops under `controller` in a control period, at most; none if no loop is looked at.
    pub fn nominal(&self, controller: &Controller) -> Option<f64> {
        largest(self.nominal.iter(), controller)
    }

    /// A first idea of that, with the delay that they shall bear beyond their own; 0 if no loop is looked at, so that it is run.
    pub fn first_idea(&self, controller: &Controller) -> f64 {
        let late = self.late.map_or(&[][..], |late| &self.corners[late]);
        let ideas = self.nominal.iter().chain(late).map(|outlook| outlook.first_idea(controller));
        whole(ideas).unwrap_or(0.0)
    }
}

fn largest<'a>(outlooks: impl Iterator<Item = &'a Outlook<'a>>, controller: &Controller) -> Option<f64> {
    whole(outlooks.map(|outlook| outlook.growth(controller)))
}

/// The largest of those that there are; what is no number is infinite.
fn whole(radii: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    radii.flatten().map(|radius| if radius.is_nan() { f64::INFINITY } else { radius }).reduce(f64::max)
}

/// By how much constraints that are `asked`, or those that are wished for, are broken together; 0 if all are kept.
fn broken(constraints: &[Constraint], asked: bool) -> f64 {
    constraints.iter().filter(|constraint| constraint.asked == asked).map(Constraint::excess).sum()
}

/// From 0 to 99, growing with `x` from 0 on.
fn bounded(x: f64) -> f64 {
    if x.is_finite() { 99.0 * x / (1.0 + x) } else { 99.0 }
}

/// What a loop shall bear where nobody says: half a control period more delay, a fifth less and a quarter more torque, masses that are
/// off by a twentieth and springs by a tenth. It is wished for; what is asked comes first.
const DELAY: f64 = 0.5;
const GAIN: [f64; 2] = [0.8, 1.25];
const MASS: f64 = 0.05;
const STIFFNESS: f64 = 0.1;

/// What a loop with control periods of `period` in s shall bear by `spec`: in words, the change, and whether it is asked.
fn wanted(period: f64, spec: &Spec) -> Vec<(String, Change, bool)> {
    let mut wanted = Vec::new();
    if let Some([shortest, longest]) = spec.delay.filter(|[shortest, longest]| shortest < longest) {
        let what = format!("the shortest delay, {} ms", short(1e3 * shortest, 4));
        wanted.push((what, Change::Delay(shortest - longest), true));
    }
    let delay = spec.margins.delay.unwrap_or(DELAY * period);
    if delay > 0.0 {
        let what = format!("{} ms more delay", short(1e3 * delay, 4));
        wanted.push((what, Change::Delay(delay), spec.margins.delay.is_some()));
    }
    let mut factors = |what: &str, change: fn(f64) -> Change, factors: [f64; 2], asked: bool| {
        for factor in factors.into_iter().filter(|factor| (factor - 1.0).abs() > 0.0) {
            wanted.push((format!("{} times the {what}", short(factor, 4)), change(factor), asked));
        }
    };
    let either_way = |part: f64| [1.0 - part, 1.0 + part];
    let (gain, mass, stiffness) = (spec.margins.gain, spec.uncertainty.mass, spec.uncertainty.stiffness);
    factors("torque", Change::TorqueGain, gain.unwrap_or(GAIN), gain.is_some());
    factors("masses", Change::Mass, either_way(mass.unwrap_or(MASS)), mass.is_some());
    factors(
        "stiffnesses",
        Change::Stiffness,
        either_way(stiffness.unwrap_or(STIFFNESS)),
        stiffness.is_some(),
    );
    wanted
}
