//! What laws pay for their errors.

use super::score_map::factor;
use crate::compare::{Leaderboard, Score, is_vcbc, median};
use crate::report::draw::marker::Marker;
use crate::report::draw::scatter::{Item, Scatter, legend};
use crate::report::draw::scene::Scene;
use crate::report::draw::sheet::{MARGIN, page};

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 460.0;

/// Errors of the laws against their motor torques, over all tasks: a mark a law, both the median over the tasks that it follows on, the error over
/// that of the best law of the task, the torque over what the reference takes of the model. Laws that follow nowhere have
/// their marks beside the title.
pub fn cost_figure(board: &Leaderboard) -> Scene {
    let laws: Vec<String> = board.laws().map(str::to_owned).collect();
    let marker = |law: usize| Marker::new(law, is_vcbc(&laws[law]));
    let entries: Vec<_> = laws.iter().enumerate().map(|(i, law)| (law.clone(), marker(i))).collect();
    let subtitle = "medians over the tasks that a law follows on; lower left is better; dotted: what the references themselves take, by the model";
    let (mut scene, top) = page(WIDTH, "What a small error costs", subtitle);
    let top = top + legend(&mut scene, [MARGIN, top], &entries) - 8.0;
    scene.height = top + HEIGHT + 6.0;
    let mut points: Vec<(usize, Item)> = Vec::new();
    let mut aside = Vec::new();
    for (law, name) in laws.iter().enumerate() {
        match medians(board, name) {
            Some([x, y]) => points.push((law, Item { x, y, marker: marker(law) })),
            None => aside.push(marker(law)),
        }
    }
    // v-CBC last: on top of the others.
    points.sort_by_key(|(law, _)| is_vcbc(&laws[*law]));
    Scatter {
        place: [0.5 * MARGIN, top, WIDTH - MARGIN, HEIGHT],
        title: "",
        x_label: "rms motor torque / rms torque of the reference",
        y_label: "error / error of the best law",
        points: points.into_iter().map(|(_, item)| item).collect(),
        line: 1.0,
        aside: ("follow nowhere:", aside),
    }
    .draw(&mut scene);
    scene
}

/// Torque and error of a law, as [`cost_figure`] has them; none if it follows nowhere.
fn medians(board: &Leaderboard, law: &str) -> Option<[f64; 2]> {
    let scores = board.tasks.iter().filter_map(|task| {
        let score: &Score = task.scores.iter().find(|score| score.law == law && score.finished())?;
        Some([score.rms_torque / task.needed_torque, factor(task, score)?])
    });
    let scores: Vec<[f64; 2]> = scores.filter(|score| score.iter().all(|x| x.is_finite())).collect();
    let of = |side: usize| median(scores.iter().map(|score| score[side]).collect());
    (!scores.is_empty()).then(|| [of(0), of(1)])
}
