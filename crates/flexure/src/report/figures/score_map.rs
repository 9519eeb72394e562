//! Laws on tasks as a map: how many times the best law's error each has.

use crate::compare::{Leaderboard, Score, TaskScores, is_vcbc};
use crate::files::number::{NONE, significant};
use crate::report::draw::scene::{Anchor, Lettering, Scene};
use crate::report::draw::sheet::{MARGIN, page};
use crate::report::draw::style::{Color, GRID, INK, MUTED, PAPER_INK, SHADES, Stroke, WHITE, bold, letters};
use crate::report::draw::text;

const WIDTH: f64 = 1200.0;
/// Left end of the map: names of laws stand before it [px].
const LEFT: f64 = 300.0;
const ROW: f64 = 30.0;
/// Widest cell [px].
const WIDEST: f64 = 130.0;
/// Names of the tasks above the map [px].
const NAMES: f64 = 44.0;

/// Factors up to which each of [`SHADES`] is, the darkest first.
const UPTO: [f64; 6] = [1.02, 1.5, 3.0, 10.0, 100.0, f64::INFINITY];

/// A row a law, the best first, a column a task: the penalised error over that of the best law on the task, the darker the better.
pub fn score_map(board: &Leaderboard) -> Scene {
    let subtitle = "penalised error of each law over the smallest one of the task: 1 is the best; — where a law does not follow";
    let (mut scene, top) = page(WIDTH, "Who is best at what", subtitle);
    let top = top + shades(&mut scene, top) + NAMES;
    let cell = ((WIDTH - LEFT - MARGIN) / board.tasks.len().max(1) as f64).min(WIDEST);
    for (column, task) in board.tasks.iter().enumerate() {
        let middle = LEFT + cell * (column as f64 + 0.5);
        for (line, words) in in_two(&task.task).into_iter().rev().enumerate() {
            let lettering = fitting(&words, letters(13.0, INK), cell - 6.0);
            scene.text([middle, top - 9.0 - 16.0 * line as f64], &words, lettering, Anchor::Middle);
        }
    }
    for (row, standing) in board.ranking.iter().enumerate() {
        let y = top + ROW * row as f64;
        let name = if is_vcbc(&standing.law) { bold(13.5, INK) } else { letters(13.5, INK) };
        scene.text(
            [LEFT - 10.0, y + 0.5 * ROW + 5.0],
            &standing.law,
            fitting(&standing.law, name, LEFT - 26.0),
            Anchor::End,
        );
        for (column, task) in board.tasks.iter().enumerate() {
            let score = task.scores.iter().find(|score| score.law == standing.law);
            draw(
                &mut scene,
                [LEFT + cell * column as f64, y, cell, ROW],
                score.and_then(|score| factor(task, score)),
            );
        }
    }
    scene.height = top + ROW * board.ranking.len() as f64 + 20.0;
    scene
}

/// How many times the smallest error of the task that of a law is; none for a law that does not follow.
pub(crate) fn factor(task: &TaskScores, score: &Score) -> Option<f64> {
    let smallest = task.scores.iter().map(|score| score.error().median).fold(f64::INFINITY, f64::min);
    Some(score.error().median / smallest).filter(|factor| factor.is_finite())
}

fn draw(scene: &mut Scene, [x, y, width, height]: [f64; 4], factor: Option<f64>) {
    let (fill, ink, words) = match factor {
        None => (WHITE, MUTED, NONE.to_owned()),
        Some(factor) => {
            let shade = UPTO.iter().position(|upto| factor <= *upto).unwrap_or(UPTO.len() - 1);
            (SHADES[shade], on(shade), number(factor))
        }
    };
    scene.rectangle([x, y, width, height], fill, Stroke::solid(GRID, 1.0));
    scene.text([x + 0.5 * width, y + 0.5 * height + 4.7], &words, letters(13.0, ink), Anchor::Middle);
}

/// A factor in a few letters.
fn number(factor: f64) -> String {
    if factor < 1000.0 { significant(factor, if factor < 10.0 { 2 } else { 3 }) } else { "> 1000".to_owned() }
}

/// What is written on a shade.
fn on(shade: usize) -> Color {
    if shade < 2 { PAPER_INK[0] } else { PAPER_INK[1] }
}

/// The legend: each shade with the factors that it is for. Returns its height.
fn shades(scene: &mut Scene, top: f64) -> f64 {
    const SAMPLE: f64 = 26.0;
    const WORDS: Lettering = letters(13.0, INK);
    let mut x = MARGIN;
    let mut from = 1.0;
    for (shade, upto) in UPTO.iter().enumerate() {
        let words = match (shade, upto.is_finite()) {
            (0, _) => "best, or tied".to_owned(),
            (_, true) => format!(
                "{} to {}",
                significant(from, 2).trim_end_matches(".0"),
                significant(*upto, 2).trim_end_matches(".0")
            ),
            _ => format!("more than {}", significant(from, 3)),
        };
        scene.rectangle([x, top - 14.0, SAMPLE, 16.0], SHADES[shade], Stroke::solid(GRID, 1.0));
        scene.text([x + SAMPLE + 6.0, top - 1.0], &words, WORDS, Anchor::Start);
        x += SAMPLE + 6.0 + text::width(&words, WORDS) + 22.0;
        from = *upto;
    }
    22.0
}

/// A name in two lines, parted at the hyphen nearest to its middle.
fn in_two(name: &str) -> Vec<String> {
    let hyphens = name.match_indices('-').map(|(at, _)| at);
    let Some(at) = hyphens.min_by_key(|at| (2 * at).abs_diff(name.len())).filter(|_| name.len() > 8) else {
        return vec![name.to_owned()];
    };
    vec![name[..at].to_owned(), name[at + 1..].to_owned()]
}

/// Letters small enough for the room.
fn fitting(words: &str, lettering: Lettering, room: f64) -> Lettering {
    let size = (lettering.size * (room / text::width(words, lettering)).min(1.0)).max(8.0);
    Lettering { size, ..lettering }
}
