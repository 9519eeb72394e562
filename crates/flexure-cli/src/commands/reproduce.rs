//! `flexure reproduce`: the main job.

use std::path::{Path, PathBuf};

use flexure::files::prepare;
use flexure::prove::summary::ProofSummary;
use flexure::report::{certificate_table, summary_table};
use flexure::reproduce::{
    Certified, REPRODUCED, certificates, reproduce as experiments, write_certificates, write_experiment,
    write_report,
};
use rayon::prelude::*;
use serde::Serialize;

use super::print;
use super::run::{Outcome, objections};
use crate::failure::Failure;
use crate::progress::Progress;

#[derive(Serialize)]
struct Reproduction<'a> {
    scenarios: Vec<Outcome<'a>>,
    certificates: Vec<ProofSummary>,
    certificate_files: Vec<PathBuf>,
    report: PathBuf,
}

pub fn reproduce(out: &Path, json: bool) -> Result<(), Failure> {
    prepare(out)?;
    let experiments = {
        let name = format!("{} experiments", REPRODUCED.len());
        let progress = Progress::new(&name, REPRODUCED.len());
        experiments(&|i, fraction| progress.set(i, fraction))?
    };
    let files: Vec<_> = experiments
        .par_iter()
        .map(|experiment| write_experiment(out, experiment))
        .collect::<Result<_, _>>()?;
    let certified = certificates()?;
    let certificate_files = write_certificates(out, &certified)?;
    let report = write_report(out, &experiments, &certified)?;
    let certificates: Vec<_> = certified.iter().map(Certified::summary).collect();
    if json {
        let scenarios = experiments.iter().zip(files).map(|(e, files)| Outcome::new(e, files)).collect();
        print::json(&Reproduction { scenarios, certificates, certificate_files, report })?;
    } else {
        let summaries: Vec<_> = experiments.iter().map(|e| e.run.summary.clone()).collect();
        print::line(&summary_table(&summaries))?;
        print::line(&certificate_table(&certificates))?;
        print::line(&format!(
            "wrote {}, and figures (svg, png), traces (csv) and certificates (json) beside it",
            report.display()
        ))?;
    }
    let objections: Vec<_> = experiments.iter().flat_map(objections).map(Into::into).collect();
    if objections.is_empty() { Ok(()) } else { Err(Failure::No(objections)) }
}
