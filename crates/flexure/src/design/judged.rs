//! Gains that a search has chosen, with what only the chosen are looked at for.

use crate::design::bench::{Bench, Trial};
use crate::design::constraint::{Constraint, Kind};
use crate::design::search::Found;
use crate::design::tube::Tube;
use crate::design::watch::Watch;
use crate::files::Problems;
use crate::progress::Progress;
use crate::prove::question::{Proof, Question, prove_watched};
use crate::prove::sampled_data::widest_tube;
use crate::scenario::Scenario;

/// Gains with the proof of their rate, and with what they lose although small errors shrink.
pub(super) struct Judged {
    pub trial: Trial,
    /// The loop under the first reference.
    pub tuned: Scenario,
    /// None where none can be, and where it was broken off.
    pub proof: Option<Proof>,
    /// What is proved of the sampled loop under every reference, where that is asked for and the rest is kept.
    pub tube: Option<Tube>,
    /// Everything that was looked at.
    pub constraints: Vec<Constraint>,
    /// Whether more would have been looked at.
    pub broken_off: bool,
}

impl Judged {
    /// `trial`, of which a rate may be `asked` [1/s]; nothing more is looked at where the search was `broken_off`. `proving` is told how far
    /// proofs of the sampled loop are.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn of(
        trial: Trial,
        bench: &Bench,
        asked: Option<f64>,
        broken_off: bool,
        watch: &Watch<'_>,
        proving: Progress<'_>,
    ) -> Result<Self, Problems> {
        let tuned = bench.scenarios[0].under(&trial.controller);
        let constraints = trial.constraints.clone();
        let mut judged = Self { trial, tuned, proof: None, tube: None, constraints, broken_off };
        if broken_off {
            judged.not_looked_at(bench);
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
        match bench.sampled_rate {
            Some(asked) if judged.keeps() && !judged.broken_off => judged.sampled(bench, asked, proving)?,
            _ if judged.broken_off => judged.not_looked_at(bench),
            _ => {}
        }
        Ok(judged)
    }

    /// The best of what was `found`; where a tube of the sampled loop is asked and the best has none, the first that has one of the second,
    /// third, fifth, ninth … best: neighbours are alike, and a proof takes long.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn chosen(
        found: Found,
        bench: &Bench,
        asked: Option<f64>,
        watch: &Watch<'_>,
        proving: Progress<'_>,
    ) -> Result<Self, Problems> {
        let Found { best, kept, broken_off, .. } = found;
        let judge = |trial: Trial| Self::of(trial, bench, asked, broken_off, watch, proving);
        let mut first = judge(best)?;
        let lacks_a_tube = |judged: &Self| {
            judged.constraints.iter().any(|broken| broken.kind == Kind::SampledRate && !broken.is_met())
        };
        let mut place = 1;
        while !first.broken_off && lacks_a_tube(&first) && place < kept.len() {
            let other = judge(kept[place].clone())?;
            if other.keeps() {
                return Ok(other);
            }
            first.broken_off = other.broken_off;
            place *= 2;
        }
        Ok(first)
    }

    /// Looks for a tube of the sampled loop in which motions come closer at `asked` 1/s, under each reference.
    fn sampled(&mut self, bench: &Bench, asked: f64, proving: Progress<'_>) -> Result<(), Problems> {
        let count = bench.scenarios.len() as f64;
        let mut tubes = Vec::new();
        for (scenario, i) in bench.scenarios.iter().zip(0_u32..) {
            let scenario = scenario.under(&self.trial.controller);
            let told = |fraction: f64| proving((f64::from(i) + fraction) / count);
            match widest_tube(&scenario, asked, &told)? {
                None => {
                    self.broken_off = true;
                    self.not_looked_at(bench);
                    return Ok(());
                }
                Some(Err(none)) => {
                    self.sampled_is_open(asked, format!("none was proved: {}", none.at));
                    return Ok(());
                }
                Some(Ok(tube)) => tubes.push(tube),
            }
        }
        self.tube = Tube::of(&tubes);
        let rate = self.tube.map_or(0.0, |tube| tube.rate);
        self.constrain(Constraint::sampled_rate(rate, asked, None));
        Ok(())
    }

    /// Where a tube of the sampled loop is asked, and it was broken off before one was looked for.
    fn not_looked_at(&mut self, bench: &Bench) {
        if let Some(asked) = bench.sampled_rate {
            self.sampled_is_open(asked, "broken off before a tube was found".to_owned());
        }
    }

    /// Nothing is proved of the rate of the sampled loop, and why.
    fn sampled_is_open(&mut self, asked: f64, why: String) {
        self.constrain(Constraint::sampled_rate(0.0, asked, Some(why)));
    }

    /// Puts `constraint` in the place of what was guessed of it.
    fn constrain(&mut self, constraint: Constraint) {
        self.constraints.retain(|other| other.kind != constraint.kind);
        self.constraints.push(constraint);
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
