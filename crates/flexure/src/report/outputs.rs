//! Comparisons and certificates as files.

use std::io;
use std::path::{Path, PathBuf};

use crate::compare::{Leaderboard, Task};
use crate::files::{Problem, Unfinished, WriteError, create_folder, write_atomic};
use crate::margins::Margins;
use crate::prove::engine::Certificate;
use crate::report::{
    Scene, Viewed, assumptions, cost_figure, leaderboard_page, margins_figure, margins_page, score_map, view,
};
use crate::scenario::Scenario;

/// Writes a comparison into `folder`, which is created if missing: `compare.html`, its figures and `compare.csv`; returns
/// the paths.
///
/// # Errors
/// If a file cannot be written; none is ever half written.
pub fn write_leaderboard(
    folder: &Path,
    board: &Leaderboard,
    tasks: &[Task],
) -> Result<Vec<PathBuf>, WriteError> {
    create_folder(folder)?;
    let mut paths = vec![folder.join("compare.html"), folder.join("compare.csv")];
    let page = leaderboard_page(board, &assumptions(tasks.iter().map(|task| &task.scenario)));
    write_atomic(&paths[0], |out| out.write_all(page.as_bytes()))?;
    write_scores(&paths[1], board)?;
    for (name, figure) in [("compare-map", score_map(board)), ("compare-cost", cost_figure(board))] {
        paths.extend(write_figure(folder, name, &figure)?);
    }
    Ok(paths)
}

/// Writes a figure as `name.svg` and `name.png` into `folder`; returns their paths.
///
/// # Errors
/// If one cannot be written.
pub fn write_figure(folder: &Path, name: &str, figure: &Scene) -> Result<[PathBuf; 2], WriteError> {
    let paths = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
    write_atomic(&paths[0], |out| out.write_all(figure.svg().as_bytes()))?;
    write_atomic(&paths[1], |out| out.write_all(&figure.png().map_err(io::Error::other)?))?;
    Ok(paths)
}

/// Writes `NAME.margins.html` and its figures into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// If a file cannot be written; none is ever half written.
pub fn write_margins(
    folder: &Path,
    scenario: &Scenario,
    loops: &[Margins],
) -> Result<Vec<PathBuf>, WriteError> {
    create_folder(folder)?;
    let [page_name, ..] = &margins_names(scenario, loops.len())[..] else { return Ok(Vec::new()) };
    let mut paths = vec![folder.join(page_name)];
    let page = margins_page(loops, scenario, &assumptions([scenario].into_iter()));
    write_atomic(&paths[0], |out| out.write_all(page.as_bytes()))?;
    for (i, margins) in loops.iter().enumerate() {
        paths.extend(write_figure(
            folder,
            &margins_name(scenario, i, loops.len()),
            &margins_figure(margins),
        )?);
    }
    Ok(paths)
}

/// What the files of the margins of so many loops are called, the page first.
pub fn margins_names(scenario: &Scenario, loops: usize) -> Vec<String> {
    let figure =
        |i: usize| ["svg", "png"].map(|ending| format!("{}.{ending}", margins_name(scenario, i, loops)));
    std::iter::once(format!("{}.margins.html", scenario.name)).chain((0..loops).flat_map(figure)).collect()
}

/// What the figure of one of so many loops is called.
fn margins_name(scenario: &Scenario, i: usize, loops: usize) -> String {
    let number = if loops == 1 { String::new() } else { format!("-{}", i + 1) };
    format!("{}.margins{number}", scenario.name)
}

/// Writes the page of a run in motion, or of two side by side, as `NAME.view.html` or `NAME-and-NAME.view.html` into `folder`, which is created
/// if missing; returns its path, and warnings of robots whose links it has in another way than their URDFs say.
///
/// # Errors
/// As [`view`], and if it cannot be written; it is never half written.
pub fn write_view(folder: &Path, runs: &[Viewed<'_>]) -> Result<(PathBuf, Vec<Problem>), Unfinished> {
    let (page, warnings) = view(runs)?;
    create_folder(folder)?;
    let path = folder.join(view_name(runs.iter().map(|run| run.scenario)));
    write_atomic(&path, |out| out.write_all(page.as_bytes()))?;
    Ok((path, warnings))
}

/// What the page of runs of these scenarios is called.
pub fn view_name<'a>(scenarios: impl Iterator<Item = &'a Scenario>) -> String {
    let names: Vec<&str> = scenarios.map(|scenario| scenario.name.as_str()).collect();
    format!("{}.view.html", names.join("-and-"))
}

/// Writes the scores as CSV: a row a task and law; errors in rad, torques in N m, nothing for numbers that there are not.
fn write_scores(path: &Path, board: &Leaderboard) -> Result<(), WriteError> {
    const HEADER: [&str; 15] = [
        "task",
        "law",
        "rank",
        "penalised_error",
        "penalised_error_low",
        "penalised_error_high",
        "seeds",
        "follows",
        "rms_error",
        "max_error",
        "rms_torque",
        "needed_torque",
        "chatter",
        "saturated_fraction",
        "diverged_at",
    ];
    write_atomic(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(HEADER)?;
        for (task, score) in
            board.tasks.iter().flat_map(|task| task.scores.iter().map(move |score| (task, score)))
        {
            let numbers = [
                score.rank,
                score.penalised_error,
                score.error().low,
                score.error().high,
                score.seeds.len() as f64,
                f64::from(u8::from(score.follows)),
                score.rms_error,
                score.max_error,
                score.rms_torque,
                task.needed_torque,
                score.chatter,
                score.saturated_fraction,
                score.diverged_at.unwrap_or(f64::NAN),
            ];
            let text = |x: f64| if x.is_finite() { x.to_string() } else { String::new() };
            csv.write_record(
                [task.scenario.clone(), score.law.clone()].into_iter().chain(numbers.map(text)),
            )?;
        }
        csv.flush()
    })
}

/// Writes a certificate as JSON, its folder created if missing.
///
/// # Errors
/// If it cannot be written.
pub fn write_certificate(path: &Path, certificate: &Certificate) -> Result<(), WriteError> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        create_folder(folder)?;
    }
    write_atomic(path, |out| out.write_all(certificate.text().as_bytes()))
}
