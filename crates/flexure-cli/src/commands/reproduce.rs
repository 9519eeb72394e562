//! `flexure reproduce`: the main job.

use std::path::{Path, PathBuf};

use flexure::experiment::{REPRODUCED, reproduce as experiments};
use flexure::io::{prepare, write_experiment, write_report};
use flexure::report::summary_table;
use rayon::prelude::*;
use serde::Serialize;

use super::print;
use super::run::{Outcome, diverged};
use crate::failure::Failure;
use crate::progress::Progress;

#[derive(Serialize)]
struct Reproduction<'a> {
    scenarios: Vec<Outcome<'a>>,
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
    let report = write_report(out, &experiments)?;
    if json {
        let scenarios = experiments.iter().zip(files).map(|(e, files)| Outcome::new(e, files)).collect();
        print::json(&Reproduction { scenarios, report })?;
    } else {
        let summaries: Vec<_> = experiments.iter().map(|e| e.run.summary.clone()).collect();
        print::line(&summary_table(&summaries))?;
        print::line(&format!(
            "wrote {}, and figures (svg, png) and traces (csv) beside it",
            report.display()
        ))?;
    }
    let diverged: Vec<_> = experiments.iter().filter_map(diverged).map(Into::into).collect();
    if diverged.is_empty() { Ok(()) } else { Err(Failure::No(diverged)) }
}
