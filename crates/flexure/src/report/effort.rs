//! What laws pay for their errors: a panel for each task of a comparison.

use super::marker::Marker;
use super::scatter::{Item, Scatter, legend};
use super::scene::Scene;
use super::sheet::{MARGIN, page};
use crate::compare::{CHATTERS, Leaderboard, Score, TaskScores, is_vcbc};

const WIDTH: f64 = 1200.0;
const COLUMNS: usize = 3;
const HEIGHT: f64 = 330.0;

/// What a figure shows along x.
struct Price {
    title: &'static str,
    subtitle: &'static str,
    label: &'static str,
    of: fn(&Score) -> f64,
    line: fn(&TaskScores) -> f64,
}

const EFFORT: Price = Price {
    title: "Error against effort",
    subtitle: "one mark a law, with the gains that the search found, side by side where they would cover each other; lower left \
               is better; dotted: what the reference itself takes, by the model",
    label: "rms motor torque [N m]",
    of: |score| score.rms_torque,
    line: |task| task.needed_torque,
};

const CHATTER: Price = Price {
    title: "Error against chatter",
    subtitle: "how much the torque changes from one control instant to the next, as a part of the torque; right of the dotted \
               line it counts against a law",
    label: "torque change per period / torque (rms)",
    of: |score| score.chatter,
    line: |_| CHATTERS,
};

/// Error of the links against motor torque, both root mean squares, on logarithmic axes: a panel a task, a mark a law.
/// Laws that do not follow have their marks beside the panel's title.
pub fn effort_figure(board: &Leaderboard) -> Scene {
    figure(board, &EFFORT)
}

/// Error of the links against how much the torque jumps, as [`effort_figure`].
pub fn chatter_figure(board: &Leaderboard) -> Scene {
    figure(board, &CHATTER)
}

fn figure(board: &Leaderboard, price: &Price) -> Scene {
    let laws: Vec<String> = board.laws().map(str::to_owned).collect();
    let marker = |law: usize| Marker::new(law, is_vcbc(&laws[law]));
    let entries: Vec<_> = laws.iter().enumerate().map(|(i, law)| (law.clone(), marker(i))).collect();
    let mut scene = page(WIDTH, price.title, price.subtitle);
    let top = 84.0 + legend(&mut scene, [MARGIN, 84.0], &entries) - 8.0;
    let columns = COLUMNS.min(board.tasks.len()).max(1);
    let width = (WIDTH - MARGIN) / columns as f64;
    scene.height = top + HEIGHT * board.tasks.len().div_ceil(columns) as f64 + 6.0;
    for (i, task) in board.tasks.iter().enumerate() {
        let corner =
            [0.5 * MARGIN + width * (i % columns) as f64, top + HEIGHT * (i / columns) as f64, width, HEIGHT];
        panel(task, price, corner, &marker).draw(&mut scene);
    }
    scene
}

fn panel<'a>(
    task: &'a TaskScores,
    price: &Price,
    place: [f64; 4],
    marker: &dyn Fn(usize) -> Marker,
) -> Scatter<'a> {
    let all = || task.scores.iter().enumerate();
    let point = |(law, score): (usize, &Score)| Item {
        x: (price.of)(score),
        y: 1e3 * score.rms_error,
        marker: marker(law),
    };
    // v-CBC last: on top of the others.
    let mut shown: Vec<_> = all().filter(|(_, score)| score.finished()).collect();
    shown.sort_by_key(|(_, score)| is_vcbc(&score.law));
    Scatter {
        place,
        title: &task.task,
        x_label: price.label,
        y_label: "rms error [mrad]",
        points: shown.into_iter().map(point).collect(),
        line: (price.line)(task),
        aside: (
            "do not follow:",
            all().filter(|(_, score)| !score.finished()).map(|(law, _)| marker(law)).collect(),
        ),
    }
}
