//! The robot under the logged torque, window by window.

use rayon::prelude::*;

use crate::files::Problems;
use crate::logs::Log;
use crate::replay::closed_loop::Signals;
use crate::replay::start::Starts;
use crate::scenario::Scenario;

/// Predicts each sample of `log` from the beginning of its window of `horizon` s.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at least one, at most the samples"
)]
pub(super) fn prediction(scenario: &Scenario, log: &Log, horizon: f64) -> Result<Signals, Problems> {
    let n = log.joints;
    let driven = scenario.driven()?;
    let starts = Starts::new(scenario, log)?;
    let window = (horizon / log.period).round().clamp(1.0, log.samples() as f64) as usize;
    let windows: Vec<usize> = (0..log.samples()).step_by(window).collect();
    let moved: Vec<Vec<f64>> = windows
        .par_iter()
        .map(|&first| {
            let last = (first + window).min(log.samples()) - 1;
            let start = starts.at(first);
            let u_m = &log.u_m[first * n..last * n];
            let rest = driven.motion(&start, first as u64, log.period, u_m).expect("as many joints");
            [start, rest].concat()
        })
        .collect();
    let motions = moved.concat();
    let part = |side: usize| {
        motions.chunks_exact(4 * n).flat_map(|x| x[side * n..(side + 1) * n].to_vec()).collect()
    };
    Ok(Signals { q_l: part(0), q_m: part(1), u_m: log.u_m.clone() })
}
