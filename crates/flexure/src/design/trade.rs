//! What each gain trades: the same loop with a quarter more of it.

use rayon::prelude::*;
use serde::Serialize;

use crate::design::bench::{Bench, Outlooks, Trial};
use crate::design::watch::{Effort, Watch, side_by_side};
use crate::files::Problems;
use crate::laws::Controller;

/// What a quarter more of a gain does, in all joints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trade {
    /// The gain, as a key of `[controller]`.
    pub gain: String,
    /// Its values, a joint each.
    pub values: Vec<f64>,
    /// What becomes of the loop; none if it is unstable as sampled then, or diverges, or nobody waited for it.
    pub effect: Option<Effect>,
}

/// How figures of the loop change, each as a factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Of the root mean square error of the links.
    pub error: f64,
    /// Of the largest torque.
    pub torque: f64,
    /// Of the root mean square change of the torque from one control instant to the next.
    pub chatter: f64,
    /// Of the rate at which small errors shrink in the sampled loop; none where that is not looked at.
    pub decay: Option<f64>,
}

/// How much more of a gain is tried.
pub(super) const MORE: f64 = 1.25;

/// The gains of `controller`, of which nobody has seen what they trade.
pub(super) fn untraded(controller: &Controller) -> Vec<Trade> {
    let gains = controller.gains().into_iter();
    gains.map(|(gain, values)| Trade { gain, values: values.to_vec(), effect: None }).collect()
}

/// What each gain that was on `trial` trades.
///
/// # Errors
/// As [`Scenario::open`](crate::Scenario::open).
pub(super) fn trades(
    bench: &Bench,
    outlooks: &Outlooks<'_>,
    trial: &Trial,
    watch: &Watch<'_>,
    effort: Effort,
) -> Result<Vec<Trade>, Problems> {
    let gains = trial.controller.gains();
    let one = |(number, (gain, values)): (usize, &(String, &[f64]))| {
        let more = trial.controller.with_gain(number, MORE);
        let other = match bench.try_out(outlooks, more.clone(), f64::ln, f64::NEG_INFINITY, watch) {
            Err(problems) if problems.is_interrupted() => None,
            other => Some(other?),
        };
        watch.add(effort.trial * side_by_side(gains.len()) / gains.len() as f64);
        let after = other.as_ref().and_then(figures);
        let effect = after.zip(figures(trial)).map(|(after, before)| Effect {
            error: after[0] / before[0],
            torque: after[1] / before[1],
            chatter: after[2] / before[2],
            decay: decay(outlooks, &more)
                .zip(decay(outlooks, &trial.controller))
                .map(|(more, own)| more / own),
        });
        Ok(Trade { gain: gain.clone(), values: values.to_vec(), effect })
    };
    gains.par_iter().enumerate().map(one).collect()
}

/// Logarithm by which small errors shrink in a control period.
fn decay(outlooks: &Outlooks<'_>, controller: &Controller) -> Option<f64> {
    outlooks.nominal(controller).map(|growth| -growth.ln())
}

/// Error, torque and chatter, each the largest of all runs; none without runs or if one diverged.
fn figures(trial: &Trial) -> Option<[f64; 3]> {
    let whole = !trial.runs.is_empty() && trial.runs.iter().all(|run| run.divergence.is_none());
    whole.then(|| {
        let largest = |of: fn(&crate::simulate::Summary) -> f64| {
            trial.runs.iter().map(|run| of(&run.summary)).fold(0.0, f64::max)
        };
        [
            largest(|summary| summary.rms_e_l),
            largest(|summary| summary.max_abs_u_m),
            largest(|summary| summary.rms_torque_change),
        ]
    })
}
