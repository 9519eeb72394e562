//! Rows whose plants were moved by steps of the midpoint rule, beside what they are by collocation.

use std::ops::Range;

use serde::Serialize;

use super::{Status, Sweep};
use crate::files::number::engineering;
use crate::files::{Problem, Problems};
use crate::progress::Progress;
use crate::scenario::{Integration, Scenario};
use crate::simulate::{Criteria, Run, measure_together};

/// What collocation makes of some rows of a sweep by midpoint steps, whose errors nobody estimates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Collocated {
    /// Rows that were run both ways.
    pub rows: u64,
    /// Rows of them that have another status by collocation.
    pub other_status: u64,
    /// Largest factor between the root mean square errors of the links, either way; none where every row diverges.
    pub rms_e_l: Option<f64>,
    /// The same of the motor torques.
    pub rms_u_m: Option<f64>,
}

/// Rows are looked at in so many equal parts of the sweep: the first by midpoint steps in each …
const ROWS: u64 = 8;

/// … if it is one of so many.
const TRIED: usize = 64;

impl Sweep {
    /// Whether the first row asks for midpoint steps.
    pub(crate) fn is_by_midpoint(&self) -> bool {
        self.scenario(0).is_ok_and(|scenario| is_by_midpoint(&scenario))
    }

    /// Runs a few rows both ways; none where none of these asks for midpoint steps on smooth plants.
    ///
    /// # Errors
    /// [`Problems::interrupted`] if it was broken off.
    pub fn beside_collocation(&self, progress: Progress<'_>) -> Result<Option<Collocated>, Problems> {
        let parts = self.rows().min(ROWS);
        let part = |i: u64| i * self.rows() / parts..(i + 1) * self.rows() / parts;
        let first = |rows: Range<u64>| {
            rows.take(TRIED).filter_map(|row| self.scenario(row).ok()).find(is_by_midpoint)
        };
        // Rows whose numbers do not go together are refused, and neither way is a run.
        let found = (0..parts).filter_map(|i| first(part(i)));
        let both: Vec<([Scenario; 2], Criteria)> = found
            .filter_map(|scenario| {
                let criteria = Criteria::of(&scenario).ok()?;
                Some(([scenario.by_collocation(), scenario], criteria))
            })
            .collect();
        let jobs: Vec<_> =
            both.iter().flat_map(|(both, criteria)| both.iter().map(move |one| (one, criteria))).collect();
        let mut runs = measure_together(&jobs, &|_, fraction| progress(fraction)).into_iter();
        let mut pairs: Vec<[Run; 2]> = Vec::new();
        while let (Some(collocation), Some(midpoint)) = (runs.next(), runs.next()) {
            match (collocation, midpoint) {
                (Ok(collocation), Ok(midpoint)) => pairs.push([collocation, midpoint]),
                (Err(problems), _) | (_, Err(problems)) if problems.is_interrupted() => return Err(problems),
                _ => {}
            }
        }
        let factor = |of: fn(&Run) -> f64| {
            let each = pairs.iter().map(|[a, b]| (of(a) / of(b)).max(of(b) / of(a)));
            each.filter(|factor| factor.is_finite()).reduce(f64::max)
        };
        Ok((!pairs.is_empty()).then(|| Collocated {
            rows: pairs.len() as u64,
            other_status: pairs.iter().filter(|[a, b]| Status::of(a) != Status::of(b)).count() as u64,
            rms_e_l: factor(|run| run.summary.rms_e_l),
            rms_u_m: factor(|run| run.summary.rms_u_m),
        }))
    }
}

impl Collocated {
    /// What it says, in a line.
    pub fn line(&self) -> String {
        let Self { rows, other_status, rms_e_l, rms_u_m } = self;
        let factors = [("errors", rms_e_l), ("torques", rms_u_m)];
        let factors = factors.iter().filter_map(|(what, factor)| Some((what, factor.as_ref()?)));
        let factors: Vec<String> = factors
            .map(|(what, factor)| format!("; {what} by a factor of {}", engineering(*factor)))
            .collect();
        format!(
            "by midpoint steps, whose errors nobody estimates: {rows} rows by collocation differ in status {other_status} times{}",
            factors.concat()
        )
    }

    /// That rows of `sweep` are not what they are by collocation, if some have another status.
    pub fn disagreement(&self, sweep: &Sweep) -> Option<Problem> {
        let Self { rows, other_status, .. } = self;
        let message = format!(
            "{}: {other_status} of {rows} rows have another status by collocation: midpoint steps are too long for these loops",
            sweep.name()
        );
        let help = "remove integration = \"midpoint\": numbers of this sweep are not to be relied on";
        (*other_status > 0).then(|| Problem::new("midpoint", message, help))
    }
}

/// Whether the plant of a scenario is moved by midpoint steps where it need not be.
fn is_by_midpoint(scenario: &Scenario) -> bool {
    scenario.integration == Integration::Midpoint && !scenario.is_rough()
}
