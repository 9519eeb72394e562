//! A row: what comes of one run.

use std::ops::Range;

use serde::Serialize;

use super::{Sweep, Value};
use crate::files::Problems;
use crate::progress::Progress;
use crate::scenario::Scenario;
use crate::simulate::{Criteria, Run, measure_together};

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It follows its reference: inside every limit, to the end.
    Follows,
    /// It ends, and does not follow.
    Strays,
    /// Its numbers left all bounds.
    Diverges,
    /// Its numbers do not go together: it was not run.
    Refused,
}

impl Status {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Follows, Self::Strays, Self::Diverges, Self::Refused];

    /// Its name in the rows.
    pub fn name(self) -> &'static str {
        match self {
            Self::Follows => "follows",
            Self::Strays => "strays",
            Self::Diverges => "diverges",
            Self::Refused => "refused",
        }
    }

    /// What runs of it do, before their number.
    pub fn words(self) -> &'static str {
        match self {
            Self::Follows => "follow their reference",
            Self::Strays => "do not follow",
            Self::Diverges => "diverge",
            Self::Refused => "refused, as their numbers do not go together (`flexure sweep replay` says why)",
        }
    }

    pub(super) fn of(run: &Run) -> Self {
        match (&run.divergence, run.summary.following.follows) {
            (Some(_), _) => Self::Diverges,
            (None, true) => Self::Follows,
            (None, false) => Self::Strays,
        }
    }
}

/// A row of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Its index.
    pub row: u64,
    /// What is random in it.
    pub seed: u64,
    /// What became of it.
    pub status: Status,
    /// Values of the parameters.
    pub values: Vec<Value>,
    /// Values of the metrics; none where there is none.
    pub metrics: Vec<Option<f64>>,
}

impl Outcome {
    /// Runs rows, side by side where they are alike.
    ///
    /// # Errors
    /// [`Problems::interrupted`] if it was broken off.
    pub(super) fn of(sweep: &Sweep, rows: Range<u64>, progress: Progress<'_>) -> Result<Vec<Self>, Problems> {
        let prepared = |row| {
            let scenario = sweep.scenario(row)?;
            let criteria = Criteria::of(&scenario)?;
            Ok((scenario, criteria))
        };
        let prepared: Vec<Result<_, Problems>> = rows.clone().map(prepared).collect();
        let jobs: Vec<_> =
            prepared.iter().flatten().map(|(scenario, criteria)| (scenario, criteria)).collect();
        let mut runs = measure_together(&jobs, &|_, fraction| progress(fraction)).into_iter();
        let finished = |(row, prepared): (u64, &Result<(Scenario, Criteria), Problems>)| {
            let run = prepared.as_ref().ok().and_then(|(scenario, _)| Some((scenario, runs.next()?)));
            let Some((scenario, run)) = run else { return Ok(Self::refused(sweep, row)) };
            match run.and_then(|run| Self::with(sweep, row, scenario, &run)) {
                Err(problems) if !problems.is_interrupted() => Ok(Self::refused(sweep, row)),
                outcome => outcome,
            }
        };
        rows.zip(&prepared).map(finished).collect()
    }

    fn with(sweep: &Sweep, row: u64, scenario: &Scenario, run: &Run) -> Result<Self, Problems> {
        let metrics = sweep.metrics().iter().map(|metric| metric.value(scenario, run));
        let metrics = metrics.collect::<Result<_, _>>()?;
        Ok(Self { status: Status::of(run), metrics, ..Self::refused(sweep, row) })
    }

    /// A row that was not run.
    pub(super) fn refused(sweep: &Sweep, row: u64) -> Self {
        Self {
            row,
            seed: sweep.seed(row),
            status: Status::Refused,
            values: sweep.values(row),
            metrics: vec![None; sweep.metrics().len()],
        }
    }

    /// The metric of this name; none if it is not kept, or there is none.
    pub fn metric(&self, sweep: &Sweep, name: &str) -> Option<f64> {
        let column = sweep.metrics().iter().position(|metric| metric.name == name)?;
        self.metrics[column]
    }
}
