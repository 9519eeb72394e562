//! How a law did on a task.

use serde::Serialize;

use crate::compare::ranking::Spread;
use crate::files::Problems;
use crate::laws::Controller;
use crate::sampled::Sampled;
use crate::simulate::Run;
use crate::tune::{Tuned, penalised_error};

/// Torque changes per control period above this part of the torque are chatter: there the [penalised
/// error](Score::penalised_error) is √2 times the error.
pub const CHATTERS: f64 = 0.05;

/// A law with the gains that the search found, on a task. Numbers are those of the seed with the median penalised error; those of a
/// loop that diverged, or that could not be run, are NaN (null in JSON).
#[derive(Clone, Debug, Serialize)]
pub struct Score {
    /// Name of the law.
    pub law: String,
    /// Position on the task, 1 for the best; laws that tie share the mean of their positions.
    pub rank: f64,
    /// What ranks: root mean square error times √(1 + (chatter / 0.05)²), in rad: what the search made small.
    pub penalised_error: f64,
    /// Penalised error with the starting gains, in rad.
    pub penalised_error_at_start: f64,
    /// Root mean square over time of |q_l − q_ld|, the largest over the joints, in rad.
    pub rms_error: f64,
    /// Largest |q_l − q_ld| over joints and time, in rad.
    pub max_error: f64,
    /// Root mean square of the motor torque over time, the largest over the joints [N m].
    pub rms_torque: f64,
    /// Root mean square change of the torque from one control instant to the next, as a part of `rms_torque`.
    pub chatter: f64,
    /// Fraction of control periods in which a torque limit was active.
    pub saturated_fraction: f64,
    /// Whether it follows its reference with every seed and is stable as it is sampled: only then is it ranked.
    pub follows: bool,
    /// Why not, in words.
    pub reasons: Vec<String>,
    /// When the loop diverged, in s; none if it ran to the end.
    pub diverged_at: Option<f64>,
    /// Why the law could not be run; none if it could.
    pub failure: Option<String>,
    /// Runs that the search simulated.
    pub evaluations: usize,
    /// The gains that it found.
    pub gains: Vec<TunedGain>,
    /// Whether small errors shrink with them in the loop that holds its torque for a control period; none for laws in continuous
    /// time, and one that could not be run.
    pub sampled: Option<Sampled>,
    /// What came of each seed, in their order; one where no seed can matter.
    pub seeds: Vec<SeedScore>,
}

/// What a search with one seed found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeedScore {
    /// The seed.
    pub seed: u64,
    /// Penalised error in rad.
    pub penalised_error: f64,
    /// Root mean square error of the links in rad.
    pub rms_error: f64,
    /// Whether the loop follows.
    pub follows: bool,
}

/// A gain, one number per joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TunedGain {
    /// Key below `[controller]` in scenario files.
    pub key: String,
    /// Its values, in the unit that the key has in scenario files.
    pub values: Vec<f64>,
}

impl Score {
    /// Of a law that was tuned with some seeds, and its runs with the gains that were found; `probe` looks at the sampled loop with
    /// such gains.
    ///
    /// # Errors
    /// Those of `probe`.
    pub(super) fn new(
        law: &str,
        found: &[(u64, Tuned, Run)],
        probe: impl FnOnce(&Controller) -> Result<Option<Sampled>, Problems>,
    ) -> Result<Self, Problems> {
        let of_seed = |(seed, _, run): &(u64, Tuned, Run)| SeedScore {
            seed: *seed,
            penalised_error: penalised_error(&run.summary),
            rms_error: run.summary.rms_e_l,
            follows: run.summary.following.follows,
        };
        let seeds: Vec<SeedScore> = found.iter().map(of_seed).collect();
        let follows = seeds.iter().all(|seed| seed.follows);
        let median = Spread::of(&seeds.iter().map(|seed| seed.penalised_error).collect::<Vec<_>>()).median;
        let shown = if follows {
            seeds.iter().position(|seed| seed.penalised_error.to_bits() == median.to_bits())
        } else {
            seeds.iter().position(|seed| !seed.follows)
        };
        let Some((_, tuned, run)) = found.get(shown.unwrap_or(0)) else {
            return Ok(Self::failed(law, "no seeds"));
        };
        let (summary, diverged_at) = (&run.summary, run.divergence.map(|divergence| divergence.time));
        let ended = |figure: f64| if diverged_at.is_none() { figure } else { f64::NAN };
        let sampled = probe(&tuned.controller)?;
        let unstable = sampled.as_ref().filter(|sampled| !sampled.stable);
        let told = summary.following.reasons.iter().map(|reason| reason.words.clone());
        let gains = tuned.controller.gains();
        Ok(Self {
            law: law.to_owned(),
            rank: f64::NAN,
            penalised_error: penalised_error(summary),
            penalised_error_at_start: tuned.start_error,
            rms_error: summary.rms_e_l,
            max_error: summary.max_abs_e_l,
            rms_torque: ended(summary.rms_u_m),
            chatter: ended(summary.rms_torque_change / summary.rms_u_m.max(f64::MIN_POSITIVE)),
            saturated_fraction: ended(summary.saturated_fraction),
            follows: follows && unstable.is_none(),
            reasons: unstable.map(Sampled::line).into_iter().chain(told).collect(),
            diverged_at,
            failure: None,
            evaluations: tuned.evaluations,
            gains: gains
                .into_iter()
                .map(|(key, values)| TunedGain { key, values: values.to_vec() })
                .collect(),
            sampled,
            seeds,
        })
    }

    /// Of a law that could not be run.
    pub fn failed(law: &str, why: &str) -> Self {
        Self {
            law: law.to_owned(),
            rank: f64::NAN,
            penalised_error: f64::NAN,
            penalised_error_at_start: f64::NAN,
            rms_error: f64::NAN,
            max_error: f64::NAN,
            rms_torque: f64::NAN,
            chatter: f64::NAN,
            saturated_fraction: f64::NAN,
            follows: false,
            reasons: Vec::new(),
            diverged_at: None,
            failure: Some(why.to_owned()),
            evaluations: 0,
            gains: Vec::new(),
            sampled: None,
            seeds: Vec::new(),
        }
    }

    /// Whether the loop follows with every seed.
    pub fn finished(&self) -> bool {
        self.follows
    }

    /// What ranks: the penalised error over the seeds in rad; infinite for a loop that does not follow with every seed.
    pub fn error(&self) -> Spread {
        if !self.follows {
            return Spread::of(&[]);
        }
        Spread::of(&self.seeds.iter().map(|seed| seed.penalised_error).collect::<Vec<_>>())
    }

    /// Root mean square error over the seeds in rad.
    pub fn rms_errors(&self) -> Spread {
        Spread::of(&self.seeds.iter().map(|seed| seed.rms_error).collect::<Vec<_>>())
    }

    /// Whether the torque jumps so much from one control instant to the next that it counts against the law.
    pub fn chatters(&self) -> bool {
        self.chatter > CHATTERS
    }
}
