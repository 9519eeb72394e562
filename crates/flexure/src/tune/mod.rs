//! Gains by search: the same effort for every law.

mod search;

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

pub(crate) use search::together;
pub use search::{BestPoint, has_random_points, search};

use crate::feasible;
use crate::files::Problems;
use crate::laws::Controller;
use crate::progress::{Parts, Progress};
use crate::sampled::is_stable;
use crate::scenario::Scenario;
use crate::simulate::{Criteria, Run, Summary, measure_watched};

/// Gains that were searched for, and what they cost.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The law with the best gains.
    pub controller: Controller,
    /// [`cost`] of a run with them.
    pub cost: f64,
    /// [`cost`] of a run with the gains of the scenario.
    pub start_cost: f64,
    /// Its [penalised error](penalised_error); NaN if it diverges.
    pub start_error: f64,
    /// Gains whose cost the search asked for.
    pub evaluations: usize,
}

/// Largest factor, either way, by which the search changes the speed of the loop, and each gain beside it: e² ≈ 7.4.
const HALF_WIDTH: f64 = 2.0;

/// Torque changes per control period that are no chatter, as a part of the torque.
const CHATTER: f64 = 0.05;

/// Searches for the gains of the scenario's law that make its [`cost`] least, with at most `budget` runs. One
/// coordinate makes the whole loop faster or slower: it multiplies each gain by a power of the speed, which its unit says. Then every
/// vector of gains has a factor of its own, the same for all joints. What is searched is the logarithms of these factors.
///
/// ```
/// let mut scenario = flexure::Scenario::load("pendulum-tanh")?;
/// scenario.duration = 0.5; // s
/// let tuned = flexure::tune::tune(&scenario, 3, 0, &flexure::progress::unwatched)?; // three runs, seed 0
/// assert!(tuned.cost <= tuned.start_cost);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`run`](crate::simulate::run), and [`Problems::interrupted`] if it was broken off.
pub fn tune(
    scenario: &Scenario,
    budget: usize,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Tuned, Problems> {
    tune_from(scenario, budget, seed, &Costs::default(), progress)
}

/// What runs of one scenario cost, by the exponents of their gains: searches with other seeds begin with the same runs.
#[derive(Debug, Default)]
pub(crate) struct Costs(Mutex<HashMap<Vec<u64>, f64>>);

impl Costs {
    /// The cost at `exponents`, computed the first time; twice if it is asked for twice at a time.
    fn at(&self, exponents: &[f64], compute: impl FnOnce() -> f64) -> f64 {
        let key: Vec<u64> = exponents.iter().map(|x| x.to_bits()).collect();
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = known().get(&key).copied();
        found.unwrap_or_else(|| {
            let cost = compute();
            known().insert(key, cost);
            cost
        })
    }
}

/// As [`tune`], with what is known of the `costs` of this very scenario.
pub(crate) fn tune_from(
    scenario: &Scenario,
    budget: usize,
    seed: u64,
    costs: &Costs,
    progress: Progress<'_>,
) -> Result<Tuned, Problems> {
    let trial = feasible::pinned(scenario)?;
    let criteria = Criteria::of(&trial)?;
    // Whatever is wrong with the scenario is so for all gains.
    let start = measure_watched(&trial, &criteria, &|_| progress(0.0))?;
    let (start_cost, start_error) = (judged(&trial, &start), penalised_error(&start.summary));
    let gains: Vec<Vec<f64>> =
        scenario.controller.gains().into_iter().map(|(_, values)| values.to_vec()).collect();
    let powers = scenario.controller.speed_powers();
    let scaled = |exponents: &[f64]| {
        let (speed, own) = exponents.split_first().unwrap_or((&0.0, &[]));
        let factors = own.iter().zip(&powers).map(|(own, &power)| (own + f64::from(power) * speed).exp());
        let scaled = gains.iter().zip(factors).map(|(gain, x)| gain.iter().map(|g| g * x).collect());
        scenario.controller.with_gains(&scaled.collect::<Vec<Vec<f64>>>())
    };
    let (tried, broken) = (AtomicUsize::new(0), AtomicBool::new(false));
    let parts = Parts::new(budget.max(1));
    let at = |exponents: &Vec<f64>| {
        // What the search still asks for once it is broken off costs nothing.
        if broken.load(Ordering::Relaxed) {
            return f64::INFINITY;
        }
        let part = tried.fetch_add(1, Ordering::Relaxed).min(budget.saturating_sub(1));
        let watched = |fraction: f64| progress(parts.with(part, fraction));
        let cost = costs.at(exponents, || {
            let mut trial = trial.clone();
            trial.controller = scaled(exponents);
            match measure_watched(&trial, &criteria, &watched) {
                Ok(run) => judged(&trial, &run),
                Err(problems) => {
                    broken.fetch_or(problems.is_interrupted(), Ordering::Relaxed);
                    f64::INFINITY
                }
            }
        });
        // What is known already or ended early is done, too.
        parts.with(part, 1.0);
        cost
    };
    let all = |points: &[Vec<f64>]| points.par_iter().map(at).collect();
    let best = search(1 + gains.len(), HALF_WIDTH, budget, seed, &all);
    if broken.load(Ordering::Relaxed) {
        return Err(Problems::interrupted());
    }
    Ok(Tuned {
        controller: scaled(&best.at),
        cost: best.cost,
        start_cost,
        start_error,
        evaluations: best.evaluations,
    })
}

/// What a run of a scenario costs; one whose sampled loop is unstable has only ended before that shows.
fn judged(scenario: &Scenario, run: &Run) -> f64 {
    let unstable = run.summary.following.follows && !is_stable(scenario).unwrap_or(false);
    cost(run) + if unstable { LOST } else { 0.0 }
}

/// Added where a loop does not follow: more than the logarithms of any two errors from 1e-12 to 1e12 rad differ by.
const LOST: f64 = 100.0;

/// What it costs to diverge: more than any logarithm of finite numbers, which are below 710, and [`LOST`].
const DIVERGED: f64 = 1e4;

/// What a run costs: the logarithm of its [penalised error](penalised_error). A loop that does not
/// [follow](crate::simulate::Following) costs more than any that does, and one that diverges more than any that does not, the
/// more the earlier.
pub fn cost(run: &Run) -> f64 {
    if let Some(divergence) = run.divergence {
        return DIVERGED + 1e3 / (1.0 + divergence.time);
    }
    let lost = if run.summary.following.follows { 0.0 } else { LOST };
    penalised_error(&run.summary).ln() + lost
}

/// e √(1 + (c / 0.05)²) in rad, with e the root mean square error of the links and c how much the torque changes from one control
/// instant to the next, as a part of the torque: gains that track well by chattering are no good gains. At least 10⁻¹² rad; NaN
/// for a run that diverged.
pub fn penalised_error(summary: &Summary) -> f64 {
    let chatter = summary.rms_torque_change / summary.rms_u_m.max(f64::MIN_POSITIVE) / CHATTER;
    let error = if summary.rms_e_l.is_nan() { f64::NAN } else { summary.rms_e_l.max(1e-12) };
    error * (1.0 + chatter * chatter).sqrt()
}
