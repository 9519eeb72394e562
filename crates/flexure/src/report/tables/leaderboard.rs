//! A comparison of laws on a terminal.

use std::fmt::Write;

use comfy_table::{Cell, Row};

use super::columns::laid_out;
use super::summary::{headed, right};
use crate::compare::{Leaderboard, Score, Spread, Standing, TIE, TaskScores};
use crate::files::number::{NONE, short, significant};

/// Columns that a task takes about.
const TASK: usize = 25;

/// Errors of every law on every task, then the ranking, in so many columns, without colours.
pub fn leaderboard_table(board: &Leaderboard, width: usize) -> String {
    let blocks = board.tasks.len().div_ceil((width / TASK).max(1)).max(1);
    let matrices = board.tasks.chunks(board.tasks.len().div_ceil(blocks).max(1));
    let laws: Vec<&str> = board.ranking.iter().map(|standing| standing.law.as_str()).collect();
    let mut text =
        String::from("root mean square error of the links [mrad]: median over seeds, smallest … largest\n");
    for tasks in matrices {
        text.push_str(&matrix(&laws, tasks, width));
        text.push('\n');
    }
    for task in &board.unfinished {
        let laws: Vec<&str> = task.scores.iter().map(|score| score.law.as_str()).collect();
        let _ = writeln!(text, "not all laws were finished on {}; of those that were:", task.task);
        text.push_str(&matrix(&laws, std::slice::from_ref(task), width));
        text.push('\n');
    }
    text.push_str(
        "* best of the task or tied, ~ torque chatters (counts against the law), — does not follow\n",
    );
    text.push_str(&seeds(board));
    text.push('\n');
    if !board.ranking.is_empty() {
        text.push_str(&ranking(board, width));
    }
    for task in board.hopeless() {
        let _ = write!(text, "\nno law follows on {}:", task.task);
        for score in &task.scores {
            let why = score.failure.as_ref().or(score.reasons.first());
            let _ = write!(text, "\n  {}: {}", score.law, why.map_or("", String::as_str));
        }
    }
    for task in board.tasks.iter().filter(|task| task.scores.iter().any(|score| score.failure.is_none())) {
        for score in &task.scores {
            if let Some(why) = &score.failure {
                let _ = write!(text, "\n{} could not run on {}: {why}", score.law, task.task);
            }
        }
    }
    text
}

fn matrix(laws: &[&str], tasks: &[TaskScores], width: usize) -> String {
    let titles = tasks.iter().map(|task| task.task.replacen('-', "\n", 1)).collect::<Vec<_>>();
    let mut table = headed(["law"].into_iter().chain(titles.iter().map(String::as_str)));
    for law in laws {
        let cells = tasks.iter().map(|task| {
            let score = task.scores.iter().find(|score| score.law == *law);
            right(score.map_or(NONE.to_owned(), |score| error(task, score)))
        });
        table.add_row(Row::from(std::iter::once(Cell::new(law)).chain(cells).collect::<Vec<_>>()));
    }
    laid_out(&table, 1, width)
}

/// An error in mrad with its marks.
fn error(task: &TaskScores, score: &Score) -> String {
    if !score.finished() {
        return NONE.to_owned();
    }
    let best = if task.is_best(score) { "*" } else { "" };
    let chatters = if score.chatters() { "~" } else { "" };
    let median = significant(1e3 * score.rms_error, 3);
    let range = range(&score.rms_errors()).map_or_else(String::new, |range| format!("\n{range}"));
    format!("{median}{chatters}{best}{range}")
}

/// From the smallest to the largest in mrad, where seeds matter.
pub(crate) fn range(errors: &Spread) -> Option<String> {
    let matters = errors.high > TIE * errors.low;
    let number = |error: f64| significant(1e3 * error, 2);
    matters.then(|| format!("{}…{}", number(errors.low), number(errors.high)))
}

/// Over how many seeds.
fn seeds(board: &Leaderboard) -> String {
    let line = |task: &TaskScores| {
        let what = match (task.seeds, task.random) {
            (0 | 1, false) => "one seed: neither its runs nor the search draw a number",
            (_, false) => return None,
            (_, true) => "seeds change its noise as well as the search",
        };
        Some(format!("{}: {what}\n", task.task))
    };
    let most = board.tasks.iter().chain(&board.unfinished).map(|task| task.seeds).max().unwrap_or(0);
    let first = format!("{most} seed{} from {} on\n", if most == 1 { "" } else { "s" }, board.seed);
    std::iter::once(first).chain(board.tasks.iter().filter_map(line)).collect()
}

/// Smallest and largest mean rank with a single seed.
pub(crate) fn ranks_with_one(standing: &Standing) -> String {
    let [low, high] = [standing.mean_rank_low, standing.mean_rank_high].map(|rank| short(rank, 3));
    if low == high { low } else { format!("{low} … {high}") }
}

/// A law's place; none if it follows on no task.
pub(crate) fn place(board: &Leaderboard, standing: &Standing) -> String {
    if standing.unfinished < board.tasks.len() { standing.place.to_string() } else { NONE.to_owned() }
}

/// The largest spectral radius of a law's sampled loops over the tasks.
pub(crate) fn spectral_radius(board: &Leaderboard, law: &str) -> String {
    let scores = board.tasks.iter().flat_map(|task| &task.scores).filter(|score| score.law == law);
    let radii = scores.filter_map(|score| score.sampled.as_ref()).map(|sampled| sampled.spectral_radius);
    radii.max_by(f64::total_cmp).map_or(NONE.to_owned(), |radius| short(radius, 5))
}

/// What the law of a standing measures: the whole motion, or what it reads of it.
pub(crate) fn measured(standing: &Standing) -> String {
    const WHOLE: usize = 4;
    match &*standing.reads {
        [] => NONE.to_owned(),
        reads if reads.len() == WHOLE => "all".to_owned(),
        reads => reads.join(" "),
    }
}

/// What the ranking's columns do not say by themselves.
const LEGEND: &str = "
laws whose mean ranks with one seed overlap share a place
spectral radius: of the sampled loop, the largest over tasks and instants; a loop whose
small errors grow on the whole way does not follow, more than 1 in passing is borne
proved: of the law in continuous time, for the robot of its model and gains that meet its
conditions, which a search does not ask for; nothing is proved of these tasks";

fn ranking(board: &Leaderboard, width: usize) -> String {
    let titles = [
        "place",
        "law",
        "mean\nrank",
        "with one\nseed",
        "best on\ntasks",
        "median factor\nto the best",
        "does not\nfollow on",
        "spectral\nradius",
        "measures",
        "proved",
    ];
    let mut table = headed(titles.into_iter());
    for standing in &board.ranking {
        let factor = Some(standing.median_factor).filter(|factor| factor.is_finite());
        let numbers = [
            short(standing.mean_rank, 3),
            ranks_with_one(standing),
            standing.wins.to_string(),
            factor.map_or(NONE.to_owned(), |factor| significant(factor, 3)),
            standing.unfinished.to_string(),
            spectral_radius(board, &standing.law),
        ];
        let first = [right(place(board, standing)), Cell::new(&standing.law)];
        let last = [Cell::new(measured(standing)), Cell::new(standing.proved.unwrap_or(NONE))];
        table.add_row(Row::from(first.into_iter().chain(numbers.map(right)).chain(last).collect::<Vec<_>>()));
    }
    laid_out(&table, 2, width) + LEGEND
}
