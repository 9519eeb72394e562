//! From scores to positions.

use flexure_core::control::Signals;
use serde::Serialize;

use crate::compare::entrant::Entrant;
use crate::compare::leaderboard::TaskScores;
use crate::compare::score::Score;

/// Errors within this factor of each other are a tie.
pub const TIE: f64 = 1.01;

/// A number over seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The smallest.
    pub low: f64,
    /// The one in the middle, the lower of two; infinite (null in JSON) where there is none.
    pub median: f64,
    /// The largest.
    pub high: f64,
}

impl Spread {
    /// Of some numbers; what is no number counts as infinite.
    pub fn of(values: &[f64]) -> Self {
        let mut values: Vec<f64> =
            values.iter().map(|x| if x.is_nan() { f64::INFINITY } else { *x }).collect();
        values.sort_by(f64::total_cmp);
        let at = |i: usize| values.get(i).copied().unwrap_or(f64::INFINITY);
        Self {
            low: at(0),
            median: at(values.len().saturating_sub(1) / 2),
            high: at(values.len().saturating_sub(1)),
        }
    }

    /// Whether this, whose median is not smaller, cannot be told from `best`: they overlap, or nearly.
    pub fn ties_with(&self, best: &Self) -> bool {
        self.low <= TIE * best.high
    }
}

/// Ranks of a law over all tasks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Standing {
    /// Name of the law.
    pub law: String,
    /// 1 for the smallest mean rank; laws whose mean ranks overlap over the seeds share a place with the first of them.
    pub place: usize,
    /// Mean over the tasks of its positions there.
    pub mean_rank: f64,
    /// The smallest mean rank with a single seed.
    pub mean_rank_low: f64,
    /// The largest.
    pub mean_rank_high: f64,
    /// Tasks that it is the best on, ties included.
    pub wins: usize,
    /// Median over the tasks of its penalised error over the smallest one; infinite (null in JSON) where it does not
    /// follow on half of them.
    pub median_factor: f64,
    /// Tasks on which it does not follow with every seed, or could not be run.
    pub unfinished: usize,
    /// What the law reads of the motion: `q_l`, `dq_l`, `q_m`, `dq_m`.
    pub reads: Vec<&'static str>,
    /// What is proved of it, in continuous time and for the robot of its model: tracking, regulation, part of the errors, or nothing; none of unknown laws.
    pub proved: Option<&'static str>,
}

/// Positions by the median of the error, the smallest first. What overlaps with the first of a group, or is within [`TIE`] of it,
/// shares the mean of the positions that the group takes; what has no number shares the last ones.
pub fn ranks(errors: &[Spread]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..errors.len()).collect();
    order.sort_by(|&a, &b| errors[a].median.total_cmp(&errors[b].median));
    let mut ranks = vec![0.0; errors.len()];
    let mut from = 0;
    while let Some(&first) = order.first() {
        let (tied, rest): (Vec<_>, Vec<_>) =
            order.iter().partition(|&&i| errors[i].ties_with(&errors[first]));
        // Positions from + 1 to from + tied.
        let mean = from as f64 + 0.5 * (tied.len() as f64 + 1.0);
        for &i in &tied {
            ranks[i] = mean;
        }
        from += tied.len();
        order = rest;
    }
    ranks
}

/// The laws of `tasks`, all of which have the same ones in the same order, by mean rank.
pub fn standings(tasks: &[TaskScores]) -> Vec<Standing> {
    let laws = tasks.first().map_or(0, |task| task.scores.len());
    let by_seed = seeded(tasks);
    let mut standings: Vec<Standing> = (0..laws).map(|law| standing(tasks, &by_seed, law)).collect();
    standings.sort_by(|a, b| a.mean_rank.total_cmp(&b.mean_rank));
    let mut first = 0;
    for i in 0..standings.len() {
        if standings[i].mean_rank_low > standings[first].mean_rank_high + ROUNDING {
            first = i;
        }
        standings[i].place = first + 1;
    }
    standings
}

/// Mean ranks are sums of halves over a count: nothing but rounding is smaller.
const ROUNDING: f64 = 1e-9;

/// Mean ranks of the laws with each seed alone. A task without so many seeds is the same with all of them.
fn seeded(tasks: &[TaskScores]) -> Vec<Vec<f64>> {
    let of_task = |task: &TaskScores, seed: usize| {
        let error = |score: &Score| {
            let error =
                score.seeds.get(seed).or(score.seeds.last()).map_or(f64::NAN, |run| run.penalised_error);
            Spread::of(&[if score.finished() { error } else { f64::NAN }])
        };
        ranks(&task.scores.iter().map(error).collect::<Vec<_>>())
    };
    let laws = tasks.first().map_or(0, |task| task.scores.len());
    let seeds = tasks.iter().flat_map(|task| &task.scores).map(|score| score.seeds.len()).max().unwrap_or(0);
    let with_seed = |seed: usize| {
        let mut sums = vec![0.0; laws];
        for task in tasks {
            sums.iter_mut().zip(of_task(task, seed)).for_each(|(sum, rank)| *sum += rank);
        }
        sums.into_iter().map(|sum| sum / tasks.len() as f64).collect()
    };
    (0..seeds).map(with_seed).collect()
}

fn standing(tasks: &[TaskScores], by_seed: &[Vec<f64>], law: usize) -> Standing {
    let scores: Vec<&Score> = tasks.iter().map(|task| &task.scores[law]).collect();
    let pairs = || tasks.iter().zip(&scores);
    let factor = |(task, score): (&TaskScores, &&Score)| {
        let factor = score.error().median / task.smallest();
        if factor.is_nan() { f64::INFINITY } else { factor }
    };
    let mean_rank = scores.iter().map(|score| score.rank).sum::<f64>() / tasks.len() as f64;
    let about = Entrant::named(&scores[0].law).ok().and_then(Entrant::about);
    let alone = || by_seed.iter().map(|ranks| ranks[law]);
    Standing {
        law: scores[0].law.clone(),
        place: 0,
        mean_rank,
        mean_rank_low: alone().fold(mean_rank, f64::min),
        mean_rank_high: alone().fold(mean_rank, f64::max),
        wins: pairs().filter(|(task, score)| task.is_best(score)).count(),
        median_factor: median(pairs().map(factor).collect()),
        unfinished: scores.iter().filter(|score| !score.finished()).count(),
        reads: about.map(|about| signals(about.reads)).unwrap_or_default(),
        proved: about.map(|about| about.claim.in_words()),
    }
}

/// The signals that are read, as traces name them.
fn signals(reads: Signals) -> Vec<&'static str> {
    let Signals { q_l, q_m, v_l, v_m } = reads;
    let named = [(q_l, "q_l"), (v_l, "dq_l"), (q_m, "q_m"), (v_m, "dq_m")];
    named.into_iter().filter(|(read, _)| *read).map(|(_, name)| name).collect()
}

/// Of at least one value.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) }
}
