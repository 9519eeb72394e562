//! From scores to positions.

use serde::Serialize;

use crate::compare::leaderboard::TaskScores;
use crate::compare::score::Score;

/// Errors within this factor of the best of a group are a tie.
pub const TIE: f64 = 1.01;

/// Ranks of a law over all tasks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Standing {
    /// Name of the law.
    pub law: String,
    /// 1 for the smallest mean rank; laws with the same mean rank share a place.
    pub place: usize,
    /// Mean over the tasks of its positions there.
    pub mean_rank: f64,
    /// Tasks that it is the best on, ties included.
    pub wins: usize,
    /// Median over the tasks of its penalised error over the smallest one; infinite (null in JSON) where it does not
    /// finish half of them.
    pub median_factor: f64,
    /// Tasks on which it diverged, or could not be run.
    pub unfinished: usize,
}

/// Positions by error, the smallest first; errors within [`TIE`] of the first of a group share the mean of the
/// positions that they take, and what has no number shares the last ones.
pub fn ranks(errors: &[f64]) -> Vec<f64> {
    let sortable = |i: usize| if errors[i].is_nan() { f64::INFINITY } else { errors[i] };
    let mut order: Vec<usize> = (0..errors.len()).collect();
    order.sort_by(|&a, &b| sortable(a).total_cmp(&sortable(b)));
    let mut ranks = vec![0.0; errors.len()];
    let mut from = 0;
    while from < order.len() {
        let limit = TIE * sortable(order[from]);
        let tied = order[from..].iter().take_while(|&&i| sortable(i) <= limit).count();
        // Positions from + 1 to from + tied.
        let mean = from as f64 + 0.5 * (tied as f64 + 1.0);
        order[from..from + tied].iter().for_each(|&i| ranks[i] = mean);
        from += tied;
    }
    ranks
}

/// The laws of `tasks`, all of which have the same ones in the same order, by mean rank.
pub fn standings(tasks: &[TaskScores]) -> Vec<Standing> {
    let laws = tasks.first().map_or(0, |task| task.scores.len());
    let mut standings: Vec<Standing> = (0..laws).map(|law| standing(tasks, law)).collect();
    standings.sort_by(|a, b| a.mean_rank.total_cmp(&b.mean_rank));
    for i in 0..standings.len() {
        let shared = i > 0 && same(standings[i].mean_rank, standings[i - 1].mean_rank);
        standings[i].place = if shared { standings[i - 1].place } else { i + 1 };
    }
    standings
}

/// Mean ranks are sums of halves over a count: nothing but rounding is smaller.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

fn standing(tasks: &[TaskScores], law: usize) -> Standing {
    let scores: Vec<&Score> = tasks.iter().map(|task| &task.scores[law]).collect();
    let factor = |(task, score): (&TaskScores, &&Score)| {
        let factor = score.penalised_error / task.smallest();
        if factor.is_nan() { f64::INFINITY } else { factor }
    };
    let factors: Vec<f64> = tasks.iter().zip(&scores).map(factor).collect();
    Standing {
        law: scores[0].law.clone(),
        place: 0,
        mean_rank: scores.iter().map(|score| score.rank).sum::<f64>() / tasks.len() as f64,
        wins: factors.iter().filter(|factor| **factor <= TIE).count(),
        median_factor: median(factors),
        unfinished: scores.iter().filter(|score| !score.finished()).count(),
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) }
}
