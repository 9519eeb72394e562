//! What a run leaves behind: traces, figures and the report.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::atomic::{WriteError, write_atomic};
use crate::certify::Certificate;
use crate::compare::{Leaderboard, Task};
use crate::experiment::{Certified, Experiment, assumptions, certificate_name, report};
use crate::report::{Scene, chatter_figure, effort_figure, html, leaderboard_page};
use crate::trace::Trace;

/// Writes trace and figure of an experiment into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// If a file cannot be written; none is ever half written.
pub fn write_experiment(folder: &Path, experiment: &Experiment) -> Result<Vec<PathBuf>, WriteError> {
    create(folder)?;
    let name = &experiment.scenario.name;
    let trace = folder.join(format!("{name}.csv"));
    write_trace(&trace, &experiment.run.trace)?;
    let [svg, png] = write_figure(folder, name, &experiment.figure)?;
    Ok(vec![trace, svg, png])
}

/// Writes a figure as `name.svg` and `name.png`; returns their paths.
fn write_figure(folder: &Path, name: &str, figure: &Scene) -> Result<[PathBuf; 2], WriteError> {
    let paths = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
    write_atomic(&paths[0], |out| out.write_all(figure.svg().as_bytes()))?;
    write_atomic(&paths[1], |out| out.write_all(&figure.png().map_err(io::Error::other)?))?;
    Ok(paths)
}

/// Writes the certificates into `folder`, which is created if missing; returns their paths.
///
/// # Errors
/// If one cannot be written.
pub fn write_certificates(folder: &Path, certificates: &[Certified]) -> Result<Vec<PathBuf>, WriteError> {
    let mut paths = Vec::new();
    for Certified { scenario, proof } in certificates {
        if let Some(certificate) = proof.verdict.proved() {
            let path = folder.join(certificate_name(&scenario.name));
            write_certificate(&path, certificate)?;
            paths.push(path);
        }
    }
    Ok(paths)
}

/// Writes `report.html` into `folder`, which is created if missing; returns its path.
///
/// # Errors
/// If it cannot be written.
pub fn write_report(
    folder: &Path,
    experiments: &[Experiment],
    certificates: &[Certified],
) -> Result<PathBuf, WriteError> {
    create(folder)?;
    let path = folder.join("report.html");
    let page = html(&report(experiments, certificates));
    write_atomic(&path, |out| out.write_all(page.as_bytes()))?;
    Ok(path)
}

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
    create(folder)?;
    let mut paths = vec![folder.join("compare.html"), folder.join("compare.csv")];
    let page = leaderboard_page(board, &assumptions(tasks.iter().map(|task| &task.scenario)));
    write_atomic(&paths[0], |out| out.write_all(page.as_bytes()))?;
    write_scores(&paths[1], board)?;
    for (name, figure) in [("effort", effort_figure(board)), ("chatter", chatter_figure(board))] {
        paths.extend(write_figure(folder, &format!("compare-{name}"), &figure)?);
    }
    Ok(paths)
}

/// Writes the scores as CSV: a row a task and law; errors in rad, torques in N m, nothing for numbers that there are not.
fn write_scores(path: &Path, board: &Leaderboard) -> Result<(), WriteError> {
    const HEADER: [&str; 11] = [
        "task",
        "law",
        "rank",
        "penalised_error",
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
                score.rms_error,
                score.max_error,
                score.rms_torque,
                task.needed_torque,
                score.chatter,
                score.saturated_fraction,
                score.diverged_at.unwrap_or(f64::NAN),
            ];
            let text = |x: f64| if x.is_nan() { String::new() } else { x.to_string() };
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
        create(folder)?;
    }
    write_atomic(path, |out| {
        serde_json::to_writer_pretty(&mut *out, certificate).map_err(io::Error::from)?;
        writeln!(out)
    })
}

/// Writes a trace as CSV: a header of column names, then a row an instant, numbers with the fewest digits that restore
/// them exactly. Units are those of docs/notation.md.
///
/// # Errors
/// If it cannot be written.
pub fn write_trace(path: &Path, trace: &Trace) -> Result<(), WriteError> {
    write_atomic(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(trace.columns().iter().map(|column| &column.name))?;
        let mut digits = ryu::Buffer::new();
        for i in 0..trace.len() {
            for column in trace.columns() {
                csv.write_field(digits.format(column.values[i]))?;
            }
            csv.write_record(None::<&[u8]>)?;
        }
        csv.flush()
    })
}

/// Creates `folder` if it is missing, and a file in it that is gone again: to know before a long run that its outputs
/// can be written.
///
/// # Errors
/// If they cannot.
pub fn prepare(folder: &Path) -> Result<(), WriteError> {
    create(folder)?;
    tempfile::tempfile_in(folder)
        .map(drop)
        .map_err(|cause| WriteError::Folder { folder: folder.into(), cause })
}

fn create(folder: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(folder).map_err(|cause| WriteError::Folder { folder: folder.into(), cause })
}
