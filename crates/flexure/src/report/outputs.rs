//! Pages, figures and certificates as files.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::{RunTold, Scene, Verdict, Viewed, assumptions, cost_figure, leaderboard_page, score_map, view};
use crate::compare::{Leaderboard, Task};
use crate::design::Design;
use crate::files::{Problem, Unfinished, WriteError, create_folder, folder_of, write_atomic};
use crate::identify::Identified;
use crate::margins::Margins;
use crate::progress::Progress;
use crate::prove::engine::Certificate;
use crate::prove::summary::ProofSummary;
use crate::report::figures::certificate::certificate_figure;
use crate::report::figures::constraints::constraints_figure;
use crate::report::figures::identified::identified_figure;
use crate::report::figures::margins::margins_figure;
use crate::report::figures::spread::spread_figure;
use crate::report::pages::certify::certify_page;
use crate::report::pages::identify::identify_page;
use crate::report::pages::margins::margins_page;
use crate::report::pages::run::run_page;
use crate::report::pages::sweep::sweep_page;
use crate::report::pages::tune::tune_page;
use crate::report::tables::leaderboard::measured;
use crate::scenario::Scenario;
use crate::sweep::{Statistics, Sweep};

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

/// What the files of a page with so many figures are called, the page first. `stem` is of what the page is and of which command.
pub fn page_names(stem: &str, figures: usize) -> Vec<String> {
    let figure = |i| ["svg", "png"].map(|ending| format!("{}.{ending}", figure_name(stem, i, figures)));
    std::iter::once(format!("{stem}.html")).chain((0..figures).flat_map(figure)).collect()
}

/// What one of so many figures of a page is called.
fn figure_name(stem: &str, i: usize, figures: usize) -> String {
    if figures == 1 { stem.to_owned() } else { format!("{stem}-{}", i + 1) }
}

/// Writes a page and its figures into `folder`, which is created if missing; returns their paths.
fn write_page(folder: &Path, stem: &str, page: &str, figures: &[Scene]) -> Result<Vec<PathBuf>, WriteError> {
    create_folder(folder)?;
    let mut paths = vec![folder.join(format!("{stem}.html"))];
    write_atomic(&paths[0], |out| out.write_all(page.as_bytes()))?;
    for (i, figure) in figures.iter().enumerate() {
        paths.extend(write_figure(folder, &figure_name(stem, i, figures.len()), figure)?);
    }
    remove_stale(folder, stem, &paths);
    Ok(paths)
}

/// Removes pictures that a page of that name had before and has no more: they would be taken for those of the new one.
fn remove_stale(folder: &Path, stem: &str, written: &[PathBuf]) {
    let both = |name: String| ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
    let is_stale = |paths: &[PathBuf; 2]| paths.iter().all(|path| path.is_file() && !written.contains(path));
    let numbered = (1..).map(|i: usize| both(format!("{stem}-{i}"))).take_while(|paths| paths[0].is_file());
    for paths in std::iter::once(both(stem.to_owned())).chain(numbered.collect::<Vec<_>>()).filter(is_stale) {
        for path in paths {
            // What cannot be removed stays.
            let _ = fs::remove_file(path);
        }
    }
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
    let figures: Vec<Scene> = loops.iter().map(margins_figure).collect();
    let page = margins_page(loops, &figures, scenario, &assumptions([scenario].into_iter()));
    write_page(folder, &stem(&scenario.name, "margins"), &page, &figures)
}

/// Writes `NAME.certify.html` and its figure into `folder`, which is created if missing; returns the paths. For the figure the scenario is run.
///
/// # Errors
/// As [`write_margins`], and [`Problems::interrupted`](crate::files::Problems::interrupted) if `progress` breaks the run off.
pub fn write_certified(
    folder: &Path,
    scenario: &Scenario,
    summary: &ProofSummary,
    verdict: &Verdict,
    certificate: Option<&Path>,
    progress: Progress<'_>,
) -> Result<Vec<PathBuf>, Unfinished> {
    let figure = match certificate_figure(scenario, summary, progress) {
        Err(problems) if problems.is_interrupted() => return Err(problems.into()),
        figure => figure,
    };
    let beside = certificate.is_some_and(|path| folder_of(path) == folder);
    let name = certificate.and_then(Path::file_name).map(|name| name.to_string_lossy());
    let page = certify_page(scenario, summary, verdict, &figure, name.as_deref(), beside);
    let figures = figure.as_ref().map_or(&[][..], std::slice::from_ref);
    Ok(write_page(folder, &stem(&scenario.name, "certify"), &page, figures)?)
}

/// Writes `NAME.run.html` and its figure into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// As [`write_margins`].
pub fn write_ran(folder: &Path, told: &RunTold<'_>) -> Result<Vec<PathBuf>, WriteError> {
    let figures = std::slice::from_ref(told.figure);
    write_page(folder, &stem(&told.scenario.name, "run"), &run_page(told), figures)
}

/// Writes `NAME.tune.html` and its figures into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// As [`write_margins`].
pub fn write_tuned(
    folder: &Path,
    scenario: &Scenario,
    design: &Design,
    objection: Option<&Problem>,
    file: Option<&Path>,
) -> Result<Vec<PathBuf>, WriteError> {
    let figures = [constraints_figure(design)];
    let page = tune_page(scenario, design, objection, &figures[0], file);
    write_page(folder, &stem(&scenario.name, "tune"), &page, &figures)
}

/// Writes `ROBOT.identify.html` and its figure into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// As [`write_margins`].
pub fn write_identified(
    folder: &Path,
    found: &Identified,
    objection: Option<&Problem>,
    file: Option<&Path>,
) -> Result<Vec<PathBuf>, WriteError> {
    let figures = [identified_figure(found)];
    let page = identify_page(found, objection, &figures[0], file);
    write_page(folder, &stem(&found.robot, "identify"), &page, &figures)
}

/// Writes `NAME.sweep.html` and its figure into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// As [`write_margins`].
pub fn write_swept(
    folder: &Path,
    sweep: &Sweep,
    statistics: &Statistics,
) -> Result<Vec<PathBuf>, WriteError> {
    let figures = [spread_figure(sweep, statistics)];
    let page = sweep_page(sweep, statistics, &figures[0]);
    write_page(folder, &stem(sweep.name(), "sweep"), &page, &figures)
}

/// What the files of a command's page or picture about `name` are called, without their endings: in the folder, whatever is in the name.
pub fn stem(name: &str, command: &str) -> String {
    format!("{}.{command}", name.replace(['/', '\\'], "_"))
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

/// Writes the scores as CSV: a row a task and law; errors in rad, torques in N m, nothing for numbers that there are not. What a law
/// measures and what is proved of it, in continuous time, is the same on every task.
fn write_scores(path: &Path, board: &Leaderboard) -> Result<(), WriteError> {
    const HEADER: [&str; 17] = [
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
        "measures",
        "proved",
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
            let standing = board.ranking.iter().find(|standing| standing.law == score.law);
            let about = [
                standing.map_or_else(String::new, measured),
                standing.and_then(|standing| standing.proved).unwrap_or_default().to_owned(),
            ];
            let first = [task.scenario.clone(), score.law.clone()];
            csv.write_record(first.into_iter().chain(numbers.map(text)).chain(about))?;
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

/// Writes the text of the file of a tube or a funnel, its folder created if missing.
///
/// # Errors
/// If it cannot be written.
pub fn write_document(path: &Path, text: &str) -> Result<(), WriteError> {
    create_folder(folder_of(path))?;
    write_atomic(path, |out| out.write_all(text.as_bytes()))
}
