//! Gains by search: the same effort for every law.

mod bench;
mod local;
mod search;

use bench::{Bench, Climb};
use local::Local;
use search::Search;
pub(crate) use search::together;
pub use search::{BestPoint, has_random_points, search};

use crate::files::Problems;
use crate::laws::Controller;
use crate::progress::{PartProgress, Progress};
use crate::sampled::is_stable;
use crate::scenario::Scenario;
use crate::simulate::{Run, Summary, in_turns};

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
    let mut tuned = tune_each(&[(scenario.clone(), seed)], budget, &|_, fraction| progress(fraction))?;
    Ok(tuned.remove(0))
}

/// As [`tune`] for several scenarios side by side, with a seed of the search each. They differ in their own seeds alone: what is known of the
/// gains of one is known of those with the same. `progress` is told how far each is, by its place.
pub(crate) fn tune_each(
    starts: &[(Scenario, u64)],
    budget: usize,
    progress: PartProgress<'_>,
) -> Result<Vec<Tuned>, Problems> {
    let bench = Bench::new(starts, budget, progress)?;
    let begun = bench.started()?;
    let dimension = bench.dimension();
    let mut searches: Vec<Search> =
        starts.iter().map(|(_, seed)| Search::new(dimension, HALF_WIDTH, budget, *seed)).collect();
    for points in [Search::first, Search::scattered] {
        let points: Vec<Vec<Vec<f64>>> = searches.iter().map(points).collect();
        let asked =
            points.iter().enumerate().flat_map(|(place, points)| points.iter().map(move |at| (place, at)));
        let mut costs = bench.costs(&asked.collect::<Vec<_>>())?.into_iter();
        for (search, points) in searches.iter_mut().zip(&points) {
            search.consider_all(points, &costs.by_ref().take(points.len()).collect::<Vec<_>>());
        }
    }
    let climbs = searches.into_iter().enumerate().map(|(place, search)| Climb {
        bench: &bench,
        place,
        local: Local::begin(search),
        at: None,
        broken: false,
    });
    let found = in_turns(climbs.collect());
    if found.iter().any(|climb| climb.broken) {
        return Err(Problems::interrupted());
    }
    let tuned = |(climb, (start_cost, start_error)): (Climb<'_>, (f64, f64))| {
        let best = climb.local.best();
        Tuned {
            controller: bench.scaled(&best.at),
            cost: best.cost,
            start_cost,
            start_error,
            evaluations: best.evaluations,
        }
    };
    Ok(found.into_iter().zip(begun).map(tuned).collect())
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
