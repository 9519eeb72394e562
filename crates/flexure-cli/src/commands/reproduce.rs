//! `flexure reproduce`: the main job.

use std::path::{Path, PathBuf};

use flexure::files::{Problems, WriteError, prepare};
use flexure::prove::summary::ProofSummary;
use flexure::report::{Practical, certificate_table, practical_table, summary_table};
use flexure::reproduce::{
    Certified, Experiment, REPRODUCED, certificates, practical, reproduce as experiments, write_certificates,
    write_experiment, write_report,
};
use rayon::prelude::*;
use serde::Serialize;

use super::objections::objections;
use super::print;
use super::ran::Outcome;
use crate::failure::Failure;
use crate::progress::Progress;

#[derive(Serialize)]
struct Reproduction<'a> {
    scenarios: Vec<Outcome<'a>>,
    certificates: Vec<ProofSummary>,
    certificate_files: Vec<PathBuf>,
    practical: Vec<Practical>,
    report: PathBuf,
}

pub fn reproduce(out: &Path, json: bool) -> Result<(), Failure> {
    prepare(out)?;
    let experiments = {
        let name = format!("{} experiments", REPRODUCED.len());
        let progress = Progress::new(&name, REPRODUCED.map(|_| 1.0));
        experiments(out, &|i, fraction| progress.set(i, fraction))?
    };
    let (finished, broken_off): (Vec<_>, Vec<_>) =
        experiments.into_iter().partition(|(experiment, _)| experiment.run.broken_off.is_none());
    let (experiments, files): (Vec<_>, Vec<_>) = finished
        .into_par_iter()
        .map(|(experiment, trace)| {
            let files = write_experiment(&experiment, trace)?;
            Ok((experiment, files))
        })
        .collect::<Result<Vec<_>, WriteError>>()?
        .into_iter()
        .unzip();
    if experiments.is_empty() {
        return Err(Problems::interrupted().into());
    }
    if !broken_off.is_empty() {
        return interrupted(&experiments, files, json);
    }
    let certified = certificates()?;
    let certificate_files = write_certificates(out, &certified)?;
    let practical = practical(&experiments)?;
    let report = write_report(out, &experiments, &certified, &practical)?;
    let certificates: Vec<_> = certified.iter().map(Certified::summary).collect();
    if json {
        let scenarios = experiments.iter().zip(files).map(|(e, files)| Outcome::new(e, files)).collect();
        print::json(&Reproduction { scenarios, certificates, certificate_files, practical, report })?;
    } else {
        print::line(&table(&experiments))?;
        print::line(&practical_table(&practical, print::columns()))?;
        print::line(&certificate_table(&certificates, print::columns()))?;
        print::line(&format!(
            "wrote {}, and figures (svg, png), traces (csv) and certificates (json) beside it",
            report.display()
        ))?;
    }
    let objections: Vec<_> = experiments.iter().flat_map(objections).map(Into::into).collect();
    if objections.is_empty() { Ok(()) } else { Err(Failure::No(objections)) }
}

/// The experiments that were finished.
#[derive(Serialize)]
struct Finished<'a> {
    scenarios: Vec<Outcome<'a>>,
}

fn interrupted(experiments: &[Experiment], files: Vec<Vec<PathBuf>>, json: bool) -> Result<(), Failure> {
    let message =
        format!("broken off: {} of {} experiments were finished", experiments.len(), REPRODUCED.len());
    if json {
        let scenarios = experiments.iter().zip(files).map(|(e, files)| Outcome::new(e, files)).collect();
        print::json(&Finished { scenarios })?;
    } else {
        print::line(&message)?;
        print::line(&table(experiments))?;
    }
    Err(Failure::interrupted(message, "their traces and figures are written, no report is"))
}

fn table(experiments: &[Experiment]) -> String {
    let summaries: Vec<_> = experiments.iter().map(|e| e.run.summary.clone()).collect();
    summary_table(&summaries, print::columns())
}
