//! Control laws on the same bench: the same tasks, the same search for gains, one leaderboard.
//!
//! Every law starts each task from [`Controller::default_for`](crate::laws::Controller::default_for) and may simulate the
//! same number of runs to find better gains ([`tune`]); random numbers of the search come from one
//! seed, the same for every law and task. So a result depends on its task, its law, budget and seed, and on nothing else:
//! not on what else is compared, nor on the number of threads. docs/comparison.md has the protocol and what came of it.

mod entrant;
mod leaderboard;
mod ranking;
mod score;
mod task;

use std::ops::ControlFlow;

use rayon::prelude::*;

use crate::files::{Problem, Problems};
use crate::progress::{PartProgress, Progress};
use crate::simulate::measure;
use crate::tune::tune;

pub use entrant::{Entrant, entrants};
pub use leaderboard::{Leaderboard, Loss, TaskScores, is_vcbc};
pub use ranking::{Standing, TIE, ranks, standings};
pub use score::{CHATTERS, Score, TunedGain};
pub use task::{Task, tasks};

/// Runs that each law may simulate on each task.
pub const BUDGET: usize = 40;

/// Compares laws on tasks, on all cores. `progress` is told how far each pair of task and law is, by its number, task by task.
///
/// # Errors
/// If a task can be run with no law at all. A law that cannot run a task that others can is in the leaderboard, with why.
pub fn compare(
    tasks: &[Task],
    entrants: &[Entrant],
    budget: usize,
    seed: u64,
    progress: PartProgress<'_>,
) -> Result<Leaderboard, Problems> {
    let pairs: Vec<(&Task, &Entrant)> =
        tasks.iter().flat_map(|task| entrants.iter().map(move |entrant| (task, entrant))).collect();
    let tried: Vec<Result<Score, Problems>> = pairs
        .par_iter()
        .enumerate()
        .map(|(number, (task, entrant))| {
            let score = score(task, **entrant, budget, seed, &|fraction| progress(number, fraction));
            match progress(number, 1.0) {
                ControlFlow::Continue(()) => score,
                ControlFlow::Break(()) => Err(Problems::interrupted()),
            }
        })
        .collect();
    if let Some(Err(broken_off)) = tried.iter().find(|score| is_interrupted(score)) {
        return Err(broken_off.clone());
    }
    let mut tried = tried.into_iter();
    let scored: Result<Vec<TaskScores>, Problems> = tasks
        .iter()
        .map(|task| {
            let of_task: Vec<_> = tried.by_ref().take(entrants.len()).collect();
            Ok(TaskScores::new(task, finished(entrants, of_task)?))
        })
        .collect();
    Ok(Leaderboard::new(budget, seed, scored?))
}

fn is_interrupted(score: &Result<Score, Problems>) -> bool {
    score.as_ref().is_err_and(Problems::is_interrupted)
}

/// A law on a task, with the gains that the search finds.
fn score(
    task: &Task,
    entrant: Entrant,
    budget: usize,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Score, Problems> {
    let mut scenario = task.scenario.clone();
    scenario.controller = entrant.controller(&scenario.robot)?;
    let tuned = tune(&scenario, budget, seed, progress)?;
    scenario.controller = tuned.controller.clone();
    let run = measure(&scenario)?;
    Ok(Score::new(&entrant.name(), &tuned, &run))
}

/// The scores of a task; why it has none if no law could run it.
fn finished(entrants: &[Entrant], tried: Vec<Result<Score, Problems>>) -> Result<Vec<Score>, Problems> {
    let all_failed = tried.iter().all(Result::is_err);
    let scores = entrants.iter().zip(tried).map(|(entrant, score)| match score {
        Err(problems) if !all_failed => Ok(Score::failed(&entrant.name(), &problems.to_string())),
        score => score,
    });
    scores.collect()
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
