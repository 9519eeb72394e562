//! What runs and experiments leave behind.

use std::path::{Path, PathBuf};

use crate::files::{Unfinished, WriteError, create_folder, folder_of, write_atomic};
use crate::report::{Practical, html, write_certificate, write_figure};
use crate::reproduce::{Certified, Experiment, certificate_name, report};
use crate::scenario::Scenario;
use crate::simulate::{Excerpt, TraceFile};

/// A trace of `scenario` on its way into `folder`, which is created if missing.
///
/// # Errors
/// If no file can be created there.
pub fn trace_file(folder: &Path, scenario: &Scenario, excerpt: Excerpt) -> Result<TraceFile, WriteError> {
    create_folder(folder)?;
    TraceFile::create(&folder.join(format!("{}.csv", scenario.name)), excerpt)
}

/// Keeps the trace of an experiment, and writes its figure beside it; returns the paths.
///
/// # Errors
/// If a file cannot be written; none is ever half written.
pub fn write_experiment(experiment: &Experiment, trace: TraceFile) -> Result<Vec<PathBuf>, WriteError> {
    let path = trace.path().to_owned();
    trace.keep()?;
    let [svg, png] = write_figure(folder_of(&path), &experiment.scenario.name, &experiment.figure)?;
    Ok(vec![path, svg, png])
}

/// Writes the certificates into `folder`, which is created if missing; returns their paths.
///
/// # Errors
/// If one cannot be written.
pub fn write_certificates(folder: &Path, certificates: &[Certified]) -> Result<Vec<PathBuf>, WriteError> {
    let mut paths = Vec::new();
    for Certified { scenario, proof, .. } in certificates {
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
/// As [`report`], and if it cannot be written.
pub fn write_report(
    folder: &Path,
    experiments: &[Experiment],
    certificates: &[Certified],
    practical: &[Practical],
) -> Result<PathBuf, Unfinished> {
    create_folder(folder)?;
    let path = folder.join("report.html");
    let page = html(&report(experiments, certificates, practical)?);
    write_atomic(&path, |out| out.write_all(page.as_bytes()))?;
    Ok(path)
}
