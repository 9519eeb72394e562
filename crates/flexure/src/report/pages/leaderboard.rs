//! The page of a comparison of laws.

use maud::{Markup, html as markup};

use super::kit::{Page, Section, Verdict, figure};
use super::runs::{AssumedNumber, assumptions};
use crate::compare::{Leaderboard, Loss, Score, Standing, TaskScores, is_vcbc};
use crate::files::number::{NONE, engineering, short, significant};
use crate::report::figures::cost::cost_figure;
use crate::report::figures::score_map::score_map;
use crate::report::tables::leaderboard::{measured, place, range, ranks_with_one, spectral_radius};

const TITLE: &str = "Control laws of flexible-joint robots on the same bench";

/// The page: who is best at what, ranking, where v-CBC loses, errors, what they cost, gains and what was assumed. The same comparison gives
/// the same page, byte for byte.
pub fn leaderboard_page(board: &Leaderboard, assumed: &[AssumedNumber]) -> String {
    let map = markup! { "The deeper the blue the better; cells with a dash: the law does not follow. Rows in the order of the mean rank; v-CBC in bold." };
    let lead = markup! { (figure(&score_map(board).svg(), &map)) (introduction(board)) };
    let losses =
        board.has_vcbc().then(|| Section::new("losses", "Where v-CBC is not the best", losses(board)));
    let mut sections = vec![Section::new("ranking", "Ranking", ranking(board))];
    sections.extend(losses);
    sections.extend([
        Section::new("figures", "What an error costs", cost(board)),
        Section::new("errors", "Errors", errors(board)),
        Section::new("gains", "Gains that were found", gains(board)).folded(),
        Section::new("assumptions", "Assumptions", assumptions(assumed)).folded(),
    ]);
    Page { title: TITLE, verdict: Some(&verdict(board)), lead, sections, provenance: provenance(board) }
        .html()
}

/// Who is first, and where v-CBC is; it is good if some law follows on every task.
fn verdict(board: &Leaderboard) -> Verdict {
    let tasks = board.tasks.len();
    let hopeless = board.hopeless().count();
    let words = |standing: &Standing| {
        let of = counted(tasks, "task");
        format!(
            "{}, mean rank {}, follows on {} of {of}, best on {}",
            standing.law,
            short(standing.mean_rank, 3),
            tasks - standing.unfinished,
            standing.wins
        )
    };
    let Some(first) = board.ranking.first() else {
        return Verdict { good: Some(false), words: "No law was ranked.".to_owned() };
    };
    let is_other = |standing: &&Standing| is_vcbc(&standing.law) && standing.law != first.law;
    let vcbc = board.ranking.iter().find(|standing| is_vcbc(&standing.law)).filter(is_other);
    let beside: Vec<_> = board.ranking[1..]
        .iter()
        .filter(|standing| standing.place == first.place)
        .map(|standing| standing.law.as_str())
        .collect();
    let said = [
        Some(format!("First of {}: {}.", counted(board.laws().count(), "law"), words(first))),
        (!beside.is_empty()).then(|| format!("It shares the place with {}.", beside.join(", "))),
        vcbc.map(|vcbc| format!("The best v-CBC is at place {}: {}.", vcbc.place, words(vcbc))),
        (hopeless > 0).then(|| format!("On {} no law follows.", counted(hopeless, "task"))),
    ];
    let said: Vec<String> = said.into_iter().flatten().collect();
    Verdict { good: Some(hopeless == 0), words: said.join(" ") }
}

fn introduction(board: &Leaderboard) -> Markup {
    markup! {
        p {
            (counted(board.laws().count(), "law")) " on " (counted(board.tasks.len(), "task"))
            ". Each law starts each task from gains made by one rule from stiffness and inertias, and may simulate "
            (counted(board.budget, "run")) " to find better ones"
            @if seeds(board) > 1 { ", with each of " (counted(seeds(board), "seed")) }
            ". What the search makes small, and what ranks, is the "
            em { "penalised error" } ": the root mean square error of the links times √(1 + (c / 0.05)²), with c the change of \
            the torque from one control instant to the next as a part of the torque. Chattering is no way to win. \
            Only loops that follow their reference with every seed, by the verdict on runs, are ranked."
        }
    }
}

fn ranking(board: &Leaderboard) -> Markup {
    markup! {
        div.scroll { table.numbers {
            thead { tr {
                th { "law" } th { "place" } th { "mean rank" } th { "mean rank" br; span.unit { "with one seed" } } th { "best on" br; span.unit { "tasks" } }
                th { "median factor" br; span.unit { "to the best" } } th { "does not follow on" br; span.unit { "tasks" } }
                th { "spectral radius" br; span.unit { "of the sampled loop" } } th { "measures" } th { "proved" }
            } }
            tbody { @for standing in &board.ranking { tr {
                th scope="row" { (name(&standing.law)) }
                td { (place(board, standing)) } td { (short(standing.mean_rank, 3)) } td { (ranks_with_one(standing)) } td { (standing.wins) }
                td { (finite(standing.median_factor)) } td { (standing.unfinished) }
                td { (spectral_radius(board, &standing.law)) } td { (measured(standing)) } td { (standing.proved.unwrap_or(NONE)) }
            } } }
        } }
        p.note {
            "Measures: what the law reads of the motion; all is positions and velocities of links and motors (q_l, dq_l, q_m, dq_m). \
             Proved: what holds of the law in continuous time for the robot of its model, where its gains meet the law's own conditions, which a search does not ask for, by an error equation or a storage function that the project's tests take along \
             the closed loop; everything else in this table was simulated, and nothing is proved of these tasks. "
            "Mean rank: over the tasks, 1 for the smallest penalised error, the median over the seeds. Errors that overlap over the \
             seeds with those of the best of a group, or are within 1 % of them, tie and share the mean of their ranks, and so do \
             laws that do not follow, at the end. Laws whose mean ranks with one seed overlap share a place with the first of them. \
             Median factor: a law's penalised error over the best law's; — if the law does not follow on half of the tasks. \
             Spectral radius: of the loop that holds its torque for a control period, the largest over the tasks and over the \
             instants that were looked at. Loops whose small errors do not shrink over the whole way are not ranked, whether they follow \
             until the run ends or not; more than 1 at an instant that they pass is borne."
        }
    }
}

fn losses(board: &Leaderboard) -> Markup {
    let losses = board.losses();
    markup! {
        @if losses.is_empty() {
            p { "Nowhere: on every task a v-CBC has the smallest penalised error, or ties with it." }
        } @else {
            div.scroll { table {
                thead { tr {
                    th { "task" } th { "best law" } th { "best v-CBC" } th { "factor" } th { "laws ahead" }
                } }
                tbody { @for loss in &losses { tr {
                    th scope="row" { (loss.task.task) }
                    td { (named_error(loss.winner)) }
                    td { @match loss.vcbc { Some(vcbc) => (named_error(vcbc)), None => "no v-CBC follows" } }
                    td { (finite(loss.factor())) }
                    td { (ahead(loss)) }
                } } }
            } }
            p.note {
                "Factor: the penalised error of the best v-CBC that took part over that of the best law. Root mean square errors \
                 beside the names; ~ marks torques that chatter."
                @let others = board.tasks.len() - losses.len();
                @if others == 1 { " On the other task v-CBC is the best or ties with the best." }
                @if others > 1 { " On the other " (others) " tasks v-CBC is the best or ties with the best." }
            }
        }
    }
}

fn ahead(loss: &Loss<'_>) -> String {
    format!("{} of {}", loss.better, loss.task.scores.iter().filter(|score| !is_vcbc(&score.law)).count())
}

fn named_error(score: &Score) -> String {
    let chatters = if score.chatters() { " ~" } else { "" };
    format!("{}, {} mrad{chatters}", score.law, significant(1e3 * score.rms_error, 3))
}

fn errors(board: &Leaderboard) -> Markup {
    markup! {
        div.scroll { table.numbers {
            thead { tr {
                th { "rms error" br; span.unit { "[mrad]" } }
                @for task in &board.tasks { th { (task.task.replace('-', " ")) } }
            } }
            tbody { @for standing in &board.ranking { tr {
                th scope="row" { (name(&standing.law)) }
                @for task in &board.tasks { (cell(task, &standing.law)) }
            } } }
        } }
        p.note {
            strong { "Bold" } ": best of the task by the penalised error, or tied with it. ~: the torque chatters, the penalised \
            error is more than √2 times what stands here. —: the loop does not follow. Small: the smallest and the largest over \
            the seeds, where they differ by more than 1 %. " (seed_note(board))
        }
        div.scroll { table {
            thead { tr { th { "task" } th { "conditions" } th { "rms torque" br; span.unit { "of the reference [N m]" } } } }
            tbody { @for task in &board.tasks { tr {
                th scope="row" { (task.task) } td { (task.conditions) } td { (engineering(task.needed_torque)) }
            } } }
        } }
        @for (task, score) in failures(board) {
            p { (score.law) " could not be run on " (task.task) ": " (score.failure.as_deref().unwrap_or_default()) }
        }
        @if lost(board).next().is_some() {
            details { summary { "Why loops do not follow" }
                ul { @for (task, score) in lost(board) {
                    li { (task.task) ", " (score.law) ": " (score.reasons.join("; ")) }
                } }
            }
        }
    }
}

fn cell(task: &TaskScores, law: &str) -> Markup {
    let score = task.scores.iter().find(|score| score.law == law);
    markup! {
        td {
            @match score.filter(|score| score.finished()) {
                None => (NONE),
                Some(score) => {
                    @let error = significant(1e3 * score.rms_error, 3);
                    @if task.is_best(score) { strong { (error) } } @else { (error) }
                    @if score.chatters() { "\u{202f}~" }
                    @if let Some(range) = range(&score.rms_errors()) { br; span.unit { (range) } }
                }
            }
        }
    }
}

/// Loops that ran and do not follow.
fn lost(board: &Leaderboard) -> impl Iterator<Item = (&TaskScores, &Score)> {
    let scores = board.tasks.iter().flat_map(|task| task.scores.iter().map(move |score| (task, score)));
    scores.filter(|(_, score)| !score.follows && score.failure.is_none())
}

/// The most seeds that a law was run with.
fn seeds(board: &Leaderboard) -> usize {
    board.tasks.iter().map(|task| task.seeds).max().unwrap_or(0)
}

/// What seeds change.
fn seed_note(board: &Leaderboard) -> String {
    let names = |of: &dyn Fn(&TaskScores) -> bool| {
        let names: Vec<&str> = board.tasks.iter().filter(|task| of(task)).map(|task| &*task.task).collect();
        names.join(", ")
    };
    let (random, single) = (names(&|task| task.random), names(&|task| task.seeds < 2));
    let random = match random.as_str() {
        "" => {
            "Seeds change the search alone: no imperfection of these tasks draws random numbers.".to_owned()
        }
        names => format!("Seeds change the search, and the random numbers of the imperfections of {names}."),
    };
    if single.is_empty() {
        random
    } else {
        format!("{random} One seed is enough for {single}: no number is drawn there.")
    }
}

fn failures(board: &Leaderboard) -> impl Iterator<Item = (&TaskScores, &Score)> {
    let scores = board.tasks.iter().flat_map(|task| task.scores.iter().map(move |score| (task, score)));
    scores.filter(|(_, score)| score.failure.is_some())
}

fn cost(board: &Leaderboard) -> Markup {
    let caption = markup! { "Dark rims: v-CBC. Marks that would cover each other stand side by side. On the dotted line a law spends nothing on feedback." };
    figure(&cost_figure(board).svg(), &caption)
}

fn gains(board: &Leaderboard) -> Markup {
    markup! {
        p { "One number per joint, in the units of scenario files, of the seed with the median error. Start and end: penalised error with the gains that the \
             search began with, and with these." }
        @for task in &board.tasks {
            details { summary { (task.task) }
                div.scroll { table {
                    thead { tr { th { "law" } th { "start" br; span.unit { "[mrad]" } } th { "end" br; span.unit { "[mrad]" } }
                        th { "runs" } th { "gains" } } }
                    tbody { @for score in &task.scores { tr {
                        th scope="row" { (name(&score.law)) }
                        td { (finite(1e3 * score.penalised_error_at_start)) } td { (finite(1e3 * score.penalised_error)) }
                        td { (score.evaluations) }
                        td { @for gain in &score.gains { code { (gain.key) } " " (values(&gain.values)) "; " } }
                    } } }
                } }
            }
        }
    }
}

fn values(values: &[f64]) -> String {
    values.iter().map(|value| short(*value, 3)).collect::<Vec<_>>().join(", ")
}

fn provenance(board: &Leaderboard) -> Markup {
    markup! { ul {
        li { "flexure " (env!("CARGO_PKG_VERSION")) }
        li { "Budget " (board.budget) " runs for each law, task and seed; " (counted(seeds(board), "seed")) " from " (board.seed) " on. The same build writes \
              the same page, byte for byte, on any number of threads." }
        li { "Protocol and what it leaves out: docs/comparison.md." }
    } }
}

/// v-CBC stands out.
fn name(law: &str) -> Markup {
    markup! { @if is_vcbc(law) { em { (law) } } @else { (law) } }
}

fn finite(value: f64) -> String {
    if value.is_finite() { significant(value, 3) } else { NONE.to_owned() }
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
