//! Gains that a search has chosen, with what only the chosen are looked at for.

use crate::design::bench::{Bench, Trial};
use crate::design::constraint::{Constraint, Kind};
use crate::design::watch::Watch;
use crate::files::Problems;
use crate::prove::question::{Proof, Question, prove_watched};
use crate::scenario::Scenario;

/// Gains with the proof of their rate, and with what they lose although small errors shrink.
pub(super) struct Judged {
    pub trial: Trial,
    /// The loop under the first reference.
    pub tuned: Scenario,
    /// None where none can be, and where it was broken off.
    pub proof: Option<Proof>,
    /// Everything that was looked at.
    pub constraints: Vec<Constraint>,
    /// Whether more would have been looked at.
    pub broken_off: bool,
}

impl Judged {
    /// `trial`, of which a rate may be `asked` [1/s]; nothing more is looked at where the search was `broken_off`.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn of(
        trial: Trial,
        bench: &Bench,
        asked: Option<f64>,
        broken_off: bool,
        watch: &Watch<'_>,
    ) -> Result<Self, Problems> {
        let tuned = bench.scenarios[0].under(&trial.controller);
        let constraints = trial.constraints.clone();
        let mut judged = Self { trial, tuned, proof: None, constraints, broken_off };
        if broken_off {
            return Ok(judged);
        }
        judged.proof = prove_watched(&judged.tuned, &Question::default(), &|_| watch.go_on()).ok();
        if let Some(asked) = asked {
            judged.constraints.push(Constraint::rate(judged.rate().unwrap_or(0.0), asked));
        }
        if judged.trial.keeps() {
            match bench.lost_at(&judged.trial.controller, watch) {
                Err(problems) if problems.is_interrupted() => judged.broken_off = true,
                lost => judged.constraints.extend(lost?),
            }
        }
        Ok(judged)
    }

    /// The rate that is proved [1/s].
    pub fn rate(&self) -> Option<f64> {
        Some(self.proof.as_ref()?.verdict.proved()?.contraction_rate.as_ref()?.approximate())
    }

    /// Whether every constraint that is asked is kept.
    pub fn keeps(&self) -> bool {
        self.constraints.iter().all(Constraint::is_met)
    }

    /// Whether it is, the rate aside.
    pub fn keeps_the_rest(&self) -> bool {
        self.constraints.iter().all(|constraint| constraint.kind == Kind::Rate || constraint.is_met())
    }
}
