//! Steps of Gauss and Newton with every part inside its bounds.

use super::parameters::{Parameter, Values};
use crate::linalg::{Symmetric, cholesky, solved};

/// Largest change of an offset in a step, in sampling periods.
const LONGEST_OFFSET: f64 = 2.0;

/// Between which bounds each part of a step from `values` is; `periods` are the sampling periods of the logs \[s\].
pub(crate) fn bounds(values: &Values, periods: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    let of = |joint: &[f64; Parameter::COUNT], parameter: Parameter| {
        // What one side loses the other gains, however little it has.
        let all_of = |sides: [Parameter; 2]| {
            [-0.8, sides.map(|side| joint[side.place()]).iter().sum::<f64>() / joint[parameter.place()]]
        };
        match parameter {
            Parameter::Stiffness => [-1.0, 0.5],
            Parameter::MotorInertia => [-0.5, 1.0],
            Parameter::LinkDamping | Parameter::MotorDamping => {
                all_of([Parameter::LinkDamping, Parameter::MotorDamping])
            }
            Parameter::LinkFriction | Parameter::MotorFriction => {
                all_of([Parameter::LinkFriction, Parameter::MotorFriction])
            }
        }
    };
    let parts = values.joints.iter().flat_map(|joint| Parameter::ALL.map(|parameter| of(joint, parameter)));
    let offsets = periods.map(|period| LONGEST_OFFSET * period).map(|most| [-most, most]);
    parts.chain(offsets).collect()
}

/// (information + damping · its diagonal)⁻¹ score with every part inside its bounds: those that would leave them stay there, and
/// the others make the best of it. With it what it promises of the logarithm of the likelihood. None where that is not definite.
pub(crate) fn damped(
    information: &Symmetric<f64>,
    score: &[f64],
    damping: f64,
    bounds: &[[f64; 2]],
) -> Option<(Vec<f64>, f64)> {
    let scale: Vec<f64> = (0..score.len()).map(|i| information.at(i, i).sqrt().recip()).collect();
    let mut step = vec![0.0; score.len()];
    let mut free: Vec<usize> = (0..score.len()).collect();
    loop {
        let scaled = Symmetric::from_fn(free.len(), |a, b| {
            let (i, j) = (free[a], free[b]);
            information.at(i, j) * scale[i] * scale[j] + if i == j { damping } else { 0.0 }
        });
        for &i in &free {
            step[i] = 0.0;
        }
        let pulled = times(information, &step);
        let right: Vec<f64> = free.iter().map(|&i| (score[i] - pulled[i]) * scale[i]).collect();
        let solution = solved(&cholesky(&scaled)?, &right);
        free.iter().zip(solution).for_each(|(&i, x)| step[i] = x * scale[i]);
        let before = free.len();
        free.retain(|&i| {
            let inside = step[i].clamp(bounds[i][0], bounds[i][1]);
            let is_free = (bounds[i][0]..=bounds[i][1]).contains(&step[i]);
            step[i] = inside;
            is_free
        });
        if free.len() == before {
            break;
        }
    }
    let curved = times(information, &step);
    let gain: f64 =
        step.iter().zip(score.iter().zip(curved)).map(|(x, (score, pull))| x * (score - 0.5 * pull)).sum();
    (gain > 0.0 && gain.is_finite()).then_some((step, gain))
}

/// `a` `x`.
fn times(a: &Symmetric<f64>, x: &[f64]) -> Vec<f64> {
    (0..x.len()).map(|i| x.iter().enumerate().map(|(j, x)| a.at(i, j) * x).sum()).collect()
}
