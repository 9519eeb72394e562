//! What `--json` says of a run.

use std::path::PathBuf;

use flexure::prove::sampled_data::beside::InTube;
use flexure::reproduce::Experiment;
use flexure::sampled::Sampled;
use flexure::simulate::{FaultLog, Summary};
use serde::Serialize;

use super::collocated::Collocated;

/// A summary and where the files are.
#[derive(Serialize)]
pub struct Outcome<'a> {
    #[serde(flatten)]
    pub summary: &'a Summary,
    /// Time of divergence in s; none if the loop ran to the end.
    pub diverged_at: Option<f64>,
    /// Whether the loop is stable that holds its torque for a control period; none for laws in continuous time.
    pub sampled: Option<&'a Sampled>,
    /// What the guard kept of its stops; not there without a guard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faults: Option<&'a FaultLog>,
    /// Where it was in its tube; not there without `--tube`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tube: Option<&'a InTube>,
    /// What collocation makes of it; there for runs by midpoint steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collocated: Option<&'a Collocated>,
    pub files: Vec<PathBuf>,
    /// Its page and the figure of that; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pages: Vec<PathBuf>,
}

impl<'a> Outcome<'a> {
    pub fn new(experiment: &'a Experiment, files: Vec<PathBuf>) -> Self {
        let diverged_at = experiment.run.divergence.map(|divergence| divergence.time);
        let run = &experiment.run;
        Self {
            summary: &run.summary,
            diverged_at,
            sampled: experiment.sampled.as_ref(),
            faults: run.faults.as_ref(),
            tube: None,
            collocated: None,
            files,
            pages: Vec::new(),
        }
    }
}
