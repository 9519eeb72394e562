//! Everything that a comparison found.

use serde::Serialize;

use crate::compare::ranking::{Spread, Standing, TIE, ranks, standings};
use crate::compare::score::Score;
use crate::compare::task::Task;
use crate::laws::VCBC;

/// Laws on tasks: the contract of `compare --json`.
///
/// ```
/// use std::ops::ControlFlow;
/// use flexure::compare::{Search, Task, compare, entrants};
///
/// let mut scenario = flexure::Scenario::load("pendulum-tanh")?;
/// scenario.duration = 0.5; // s
/// let laws = entrants(&["vcbc:tanh", "pd"].map(str::to_owned))?;
/// // Two runs for each law; nobody watches.
/// let search = Search { budget: 2, ..Search::default() };
/// let board = compare(&[Task::new(&scenario)?], &laws, search, &|_, _| ControlFlow::Continue(()))?;
/// assert_eq!(board.ranking[0].law, "vcbc:tanh");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
pub struct Leaderboard {
    /// Runs that each law might simulate on each task, for each seed.
    pub budget: usize,
    /// The first of the seeds.
    pub seed: u64,
    /// The laws by mean rank, the best first.
    pub ranking: Vec<Standing>,
    /// The tasks, in the order that they were given in.
    pub tasks: Vec<TaskScores>,
    /// Of a comparison that was broken off, tasks that some of the laws were finished on, with those; no part of the ranking.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unfinished: Vec<TaskScores>,
}

/// A task and how every law did on it.
#[derive(Clone, Debug, Serialize)]
pub struct TaskScores {
    /// Name of the task.
    pub task: String,
    /// Name of its scenario.
    pub scenario: String,
    /// Whether its imperfections draw random numbers, so that seeds matter to its runs and not only to searches.
    pub random: bool,
    /// Seeds that each law was searched and run with: one where no seed can matter.
    pub seeds: usize,
    /// Robot, control period and what stands between this loop and the ideal one.
    pub conditions: String,
    /// Root mean square of the motor torque that the reference takes by the model that the laws know, the largest over
    /// the joints [N m].
    pub needed_torque: f64,
    /// The laws, in the same order on every task.
    pub scores: Vec<Score>,
}

/// A task on which a law that is no v-CBC was better than every v-CBC that took part.
#[derive(Clone, Copy, Debug)]
pub struct Loss<'a> {
    /// The task that was lost.
    pub task: &'a TaskScores,
    /// Score of the best law on it.
    pub winner: &'a Score,
    /// The best v-CBC; none if no v-CBC follows.
    pub vcbc: Option<&'a Score>,
    /// Laws that are no v-CBC and better than the best one.
    pub better: usize,
}

impl Leaderboard {
    /// Ranks the laws, which are the same in the same order on every task.
    pub fn new(budget: usize, seed: u64, tasks: Vec<TaskScores>) -> Self {
        Self { budget, seed, ranking: standings(&tasks), tasks, unfinished: Vec::new() }
    }

    /// The laws in the order that they were given in.
    pub fn laws(&self) -> impl Iterator<Item = &str> {
        self.tasks.iter().take(1).flat_map(|task| task.scores.iter().map(|score| score.law.as_str()))
    }

    /// Tasks on which no law follows.
    pub fn hopeless(&self) -> impl Iterator<Item = &TaskScores> {
        self.tasks.iter().filter(|task| !task.scores.iter().any(Score::finished))
    }

    /// The tasks that v-CBC took part in and was not the best on, ties aside.
    pub fn losses(&self) -> Vec<Loss<'_>> {
        self.tasks.iter().filter_map(TaskScores::loss).collect()
    }

    /// Whether v-CBC took part.
    pub fn has_vcbc(&self) -> bool {
        self.laws().any(is_vcbc)
    }
}

impl TaskScores {
    /// Of a task: fills in the ranks.
    pub fn new(task: &Task, scores: Vec<Score>) -> Self {
        let (name, scenario) = (task.name().to_owned(), task.scenario.name.clone());
        let conditions = task.conditions();
        let seeds = scores.iter().map(|score| score.seeds.len()).max().unwrap_or(0);
        let (random, needed_torque) = (task.is_random(), task.needed_torque);
        Self::ranked(Self { task: name, scenario, random, seeds, conditions, needed_torque, scores })
    }

    /// With the rank of each law filled in, 1 for the smallest penalised error; loops that do not follow have the last one.
    pub fn ranked(mut self) -> Self {
        let errors: Vec<Spread> = self.scores.iter().map(Score::error).collect();
        self.scores.iter_mut().zip(ranks(&errors)).for_each(|(score, rank)| score.rank = rank);
        self
    }

    /// The smallest median of the penalised error in rad; infinite if no law follows.
    pub fn smallest(&self) -> f64 {
        self.best().median
    }

    fn best(&self) -> Spread {
        let errors = self.scores.iter().map(Score::error);
        errors.min_by(|a, b| a.median.total_cmp(&b.median)).unwrap_or(Spread::of(&[]))
    }

    /// Whether a law of this task is the best on it, or ties with the best.
    pub fn is_best(&self, score: &Score) -> bool {
        score.finished() && score.error().ties_with(&self.best())
    }

    fn loss(&self) -> Option<Loss<'_>> {
        let finished = || self.scores.iter().filter(|score| score.finished());
        let by_error = |a: &&Score, b: &&Score| a.penalised_error.total_cmp(&b.penalised_error);
        let winner = finished().min_by(by_error)?;
        let vcbc = finished().filter(|score| is_vcbc(&score.law)).min_by(by_error);
        let took_part = self.scores.iter().any(|score| is_vcbc(&score.law));
        let lost = took_part && vcbc.is_none_or(|vcbc| !self.is_best(vcbc));
        let own = vcbc.map_or(f64::INFINITY, |vcbc| vcbc.error().low);
        let better = finished().filter(|score| score.error().high * TIE < own).count();
        lost.then_some(Loss { task: self, winner, vcbc, better })
    }
}

impl Loss<'_> {
    /// How many times smaller the winner's penalised error is; infinite if no v-CBC follows.
    pub fn factor(&self) -> f64 {
        self.vcbc.map_or(f64::INFINITY, |vcbc| vcbc.penalised_error / self.winner.penalised_error)
    }
}

/// Whether a law of this name is v-CBC.
pub fn is_vcbc(law: &str) -> bool {
    law.split(':').next() == Some(VCBC)
}
