//! Control laws on the same bench: the same tasks, the same search for gains, one leaderboard.
//!
//! Every law starts each task from [`Controller::default_for`](crate::laws::Controller::default_for) and may simulate the
//! same number of runs to find better gains ([`tune`](crate::tune::tune)), once for each of some seeds; random numbers of the search
//! and of the imperfections come from the seed, the same for every law and task. So a result depends on its task, its law, budget
//! and seeds, and on nothing else: not on what else is compared, nor on the number of threads. docs/comparison.md has the protocol
//! and what came of it.

mod entrant;
mod leaderboard;
mod ranking;
mod score;
mod task;

use rayon::prelude::*;

use crate::files::{Problem, Problems};
use crate::progress::{PartProgress, Parts, Progress};
use crate::sampled::probe;
use crate::scenario::Scenario;
use crate::scenario::agreement::against_hold;
use crate::simulate::{Criteria, measure_together};
use crate::tune::{has_random_points, tune_each};

pub use entrant::{Entrant, entrants};
pub use leaderboard::{Leaderboard, Loss, TaskScores, is_vcbc};
pub(crate) use ranking::median;
pub use ranking::{Spread, Standing, TIE, ranks, standings};
pub use score::{CHATTERS, Score, SeedScore, TunedGain};
pub use task::{Task, tasks};

/// Runs that each law may simulate on each task with each seed.
pub const BUDGET: usize = 40;

/// Seeds that each law is searched and run with.
pub const SEEDS: usize = 5;

/// How hard gains are searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Runs that each law may simulate on each task with each seed.
    pub budget: usize,
    /// The first seed; the others are the numbers after it.
    pub seed: u64,
    /// How many seeds, at least 1.
    pub seeds: usize,
}

impl Default for Search {
    fn default() -> Self {
        Self { budget: BUDGET, seed: 0, seeds: SEEDS }
    }
}

/// Compares laws on tasks, on all cores. `progress` is told how far each pair of task and law is, by its number, task by task. What
/// it breaks off has what was finished until then: see [`Leaderboard::unfinished`].
///
/// # Errors
/// If a task can be run with no law at all, and [`Problems::interrupted`] if no pair was finished. A law that cannot run a task that others can is in the leaderboard, with why.
pub fn compare(
    tasks: &[Task],
    entrants: &[Entrant],
    search: Search,
    progress: PartProgress<'_>,
) -> Result<Leaderboard, Problems> {
    let pairs: Vec<(&Task, &Entrant)> =
        tasks.iter().flat_map(|task| entrants.iter().map(move |entrant| (task, entrant))).collect();
    let watched = |(number, (task, entrant)): (usize, &(&Task, &Entrant))| {
        if progress(number, 0.0).is_break() {
            return (number, Err(Problems::interrupted()));
        }
        let score = score(task, **entrant, search, &|fraction| progress(number, fraction));
        // It is finished, whoever watches.
        let _ = progress(number, 1.0);
        (number, score)
    };
    // Begun one after the other: what is finished when it is broken off is whole tasks, but for the last.
    let mut tried: Vec<_> = pairs.iter().enumerate().par_bridge().map(watched).collect();
    tried.sort_by_key(|(number, _)| *number);
    let mut tried = tried.into_iter().map(|(_, score)| score);
    let (mut scored, mut unfinished) = (Vec::new(), Vec::new());
    for task in tasks {
        let of_task = entrants.iter().zip(tried.by_ref());
        let (of_task, broken): (Vec<_>, Vec<_>) =
            of_task.partition(|(_, score)| !score.as_ref().is_err_and(Problems::is_interrupted));
        let is_whole = broken.is_empty();
        if is_whole || !of_task.is_empty() {
            let found = TaskScores::new(task, finished(of_task)?);
            (if is_whole { &mut scored } else { &mut unfinished }).push(found);
        }
    }
    if scored.is_empty() && unfinished.is_empty() && !pairs.is_empty() {
        return Err(Problems::interrupted());
    }
    Ok(Leaderboard { unfinished, ..Leaderboard::new(search.budget, search.seed, scored) })
}

/// A law on a task, with the gains that the search finds with each seed.
fn score(task: &Task, entrant: Entrant, search: Search, progress: Progress<'_>) -> Result<Score, Problems> {
    let mut scenario = task.scenario.clone();
    scenario.controller = entrant.controller(&scenario.robot)?;
    if let Some((message, help)) = against_hold(&scenario.controller, scenario.hold) {
        return Err(scenario.places.problem("hold", "contradiction", message, help).into());
    }
    let is_random = task.is_random();
    // Where neither the run nor the search draws a number, every seed gives the same.
    let seeds = if is_random || has_random_points(search.budget) { search.seeds.max(1) } else { 1 };
    let parts = Parts::new(seeds);
    let tell = |number: usize, fraction: f64| progress(parts.with(number, fraction));
    let with_seed = |number: usize| {
        let more = number as u64;
        // The same noise for every law.
        let noise = if is_random { more } else { 0 };
        let mut own = scenario.clone();
        own.seed = own.seed.wrapping_add(noise);
        (own, search.seed.wrapping_add(more))
    };
    let mut starts: Vec<(Scenario, u64)> = (0..seeds).map(with_seed).collect();
    let tuned = tune_each(&starts, search.budget, &tell)?;
    for ((own, _), tuned) in starts.iter_mut().zip(&tuned) {
        own.controller = tuned.controller.clone();
    }
    let criteria: Vec<Criteria> =
        starts.iter().map(|(own, _)| Criteria::of(own)).collect::<Result<_, Problems>>()?;
    let jobs: Vec<_> = starts.iter().zip(&criteria).map(|((own, _), criteria)| (own, criteria)).collect();
    let runs = measure_together(&jobs, &|number, _| tell(number, 1.0));
    let found = starts.iter().zip(tuned.into_iter().zip(runs));
    let found: Vec<_> =
        found.map(|((_, seed), (tuned, run))| Ok((*seed, tuned, run?))).collect::<Result<_, Problems>>()?;
    Score::new(&entrant.name(), &found, |controller| {
        scenario.controller = controller.clone();
        probe(&scenario)
    })
}

/// The scores of a task; why it has none if no law could run it.
fn finished(tried: Vec<(&Entrant, Result<Score, Problems>)>) -> Result<Vec<Score>, Problems> {
    let all_failed = tried.iter().all(|(_, score)| score.is_err());
    let scores = tried.into_iter().map(|(entrant, score)| match score {
        Err(problems) if !all_failed => Ok(Score::failed(&entrant.name(), &problems.to_string())),
        score => score,
    });
    scores.collect()
}

/// What is wrong with asking for no seeds.
///
/// # Errors
/// If `seeds` is 0.
pub fn check_seeds(seeds: usize) -> Result<(), Problem> {
    if seeds > 0 {
        return Ok(());
    }
    let message = "the number of seeds is 0, must be at least 1";
    Err(Problem::new(
        "range",
        message,
        format!("{SEEDS} is the default; with fewer nobody knows what is luck"),
    ))
}

/// What is wrong with asking for no runs.
///
/// # Errors
/// If `budget` is 0.
pub fn check_budget(budget: usize) -> Result<(), Problem> {
    if budget > 0 {
        return Ok(());
    }
    let message = "the budget is 0 runs, must be at least 1";
    Err(Problem::new("range", message, format!("1 compares starting gains, {BUDGET} is the default")))
}
