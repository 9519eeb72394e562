//! How a law did on a task.

use serde::Serialize;

use crate::simulate::Run;
use crate::tune::Tuned;

/// Torque changes per control period above this part of the torque are chatter: there the [penalised
/// error](Score::penalised_error) is √2 times the error.
pub const CHATTERS: f64 = 0.05;

/// A law with the gains that the search found, on a task. Numbers of a loop that diverged, or that could not be run, are
/// NaN (null in JSON).
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
    /// When the loop diverged, in s; none if it ran to the end.
    pub diverged_at: Option<f64>,
    /// Why the law could not be run; none if it could.
    pub failure: Option<String>,
    /// Runs that the search simulated.
    pub evaluations: usize,
    /// The gains that it found.
    pub gains: Vec<TunedGain>,
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
    /// Of a law that was tuned, and its run with the gains that were found.
    pub(super) fn new(law: &str, tuned: &Tuned, run: &Run) -> Self {
        let (summary, diverged_at) = (&run.summary, run.divergence.map(|divergence| divergence.time));
        let ended = |figure: f64| if diverged_at.is_none() { figure } else { f64::NAN };
        // Costs of loops that diverged are far above the logarithm of any error.
        let penalised = |cost: f64| cost.exp();
        let gains = tuned.controller.gains();
        Self {
            law: law.to_owned(),
            rank: f64::NAN,
            penalised_error: ended(penalised(tuned.cost)),
            penalised_error_at_start: Some(penalised(tuned.start_cost))
                .filter(|error| *error < 1e10)
                .unwrap_or(f64::NAN),
            rms_error: summary.rms_e_l,
            max_error: summary.max_abs_e_l,
            rms_torque: ended(summary.rms_u_m),
            chatter: ended(summary.rms_torque_change / summary.rms_u_m.max(f64::MIN_POSITIVE)),
            saturated_fraction: ended(summary.saturated_fraction),
            diverged_at,
            failure: None,
            evaluations: tuned.evaluations,
            gains: gains
                .into_iter()
                .map(|(key, values)| TunedGain { key, values: values.to_vec() })
                .collect(),
        }
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
            diverged_at: None,
            failure: Some(why.to_owned()),
            evaluations: 0,
            gains: Vec::new(),
        }
    }

    /// Whether the loop ran to its end.
    pub fn finished(&self) -> bool {
        self.diverged_at.is_none() && self.failure.is_none()
    }

    /// Whether the torque jumps so much from one control instant to the next that it counts against the law.
    pub fn chatters(&self) -> bool {
        self.chatter > CHATTERS
    }
}
