//! Maximum likelihood of the innovations: Gauss–Newton steps with the prior as one more measurement, then the noise that makes
//! the innovations likeliest, and again.

use super::gain::{Alone, Gain, Noise};
use super::layer::{Layer, Total, total};
use super::parameters::{Parameter, Values};
use super::predictor::{Piece, Weighing};
use super::prior::Prior;
use super::step::Pace;
use crate::linalg::{Symmetric, cholesky, solved};
use crate::files::Problems;
use crate::logs::Log;
use crate::progress::{Progress, tell};

/// What is searched in.
pub(crate) struct Search<'a> {
    pub layer: &'a dyn Layer,
    pub logs: &'a [Log],
    pub pieces: &'a [Piece],
    pub prior: &'a Prior,
    /// Per joint the noise of the positions of link and motor \[rad\]; infinite where there is no encoder.
    pub position_noise: &'a [[f64; 2]],
    /// Per joint the size of the torque [N m].
    pub torque_size: &'a [f64],
    /// Where links are, to tell the inertias that gains go by.
    pub posture: &'a [f64],
}

/// What was found.
pub(crate) struct Found {
    pub values: Values,
    pub weighing: Weighing,
    /// Per joint the torque noise that makes the innovations likeliest [N m].
    pub torque_noise: Vec<f64>,
    /// The innovations at `values`, weighed as they are.
    pub total: Total,
    pub converged: bool,
}

/// Torque noise that is tried, as parts of the torque: powers of a quarter.
const LEVELS: i32 = 9;

/// Level of the first round: corrections that are large, and memory that is short.
const FIRST: i32 = 1;

/// Rounds of noise and values, and Gauss–Newton steps in each at most.
const ROUNDS: usize = 3;
const STEPS: usize = 12;

/// Largest change of a logarithm in a step, and of an offset in sampling periods.
const LONGEST: f64 = 0.7;
const LONGEST_OFFSET: f64 = 2.0;

/// A round ends where a step gains less than this of the logarithm of the likelihood.
const ENOUGH: f64 = 1e-3;

impl Search<'_> {
    /// From `values`.
    ///
    /// # Errors
    /// If it was broken off.
    pub fn run(&self, mut values: Values, progress: Progress<'_>) -> Result<Found, Problems> {
        let n = values.joints.len();
        let mut levels = vec![FIRST; n];
        let mut converged = false;
        for round in 0..ROUNDS {
            let mut weighing = self.weighing(&values, &levels);
            let innovations = self.total(&values, &weighing, false);
            weighing.weights = weights(&innovations);
            let told = |step: usize| {
                tell(progress, (round as f64 + step as f64 / STEPS as f64) / ROUNDS as f64)
            };
            (values, converged) = self.climb(values, &weighing, &told)?;
            levels = self.levels(&values);
        }
        let mut weighing = self.weighing(&values, &levels);
        weighing.weights = weights(&self.total(&values, &weighing, false));
        (values, converged) = {
            let (values, last) = self.climb(values, &weighing, &|_| Ok(()))?;
            (values, last || converged)
        };
        let total = self.total(&values, &weighing, true);
        let torque_noise = (0..n).map(|i| self.torque_noise(i, levels[i])).collect();
        Ok(Found { values, weighing, torque_noise, total, converged })
    }

    fn total(&self, values: &Values, weighing: &Weighing, informed: bool) -> Total {
        let fitted = self.pieces.iter().filter(|piece| !piece.held_out);
        total(self.layer, self.logs, fitted, values, weighing, informed)
    }

    fn torque_noise(&self, joint: usize, level: i32) -> f64 {
        self.torque_size[joint] * 0.25_f64.powi(level)
    }

    /// Gains at the noise of `levels`, weights of one.
    fn weighing(&self, values: &Values, levels: &[i32]) -> Weighing {
        let h = self.logs.iter().map(|log| log.period).fold(0.0, f64::max);
        let inertia = self.layer.alone(self.posture);
        let alone = |i: usize| {
            let joint = &values.joints[i];
            let of = |parameter: Parameter| joint[parameter.place()];
            Alone {
                inertia: [inertia[i], of(Parameter::MotorInertia)],
                stiffness: of(Parameter::Stiffness),
                damping: [of(Parameter::LinkDamping), of(Parameter::MotorDamping)],
            }
        };
        let joints = 0..values.joints.len();
        let gain = |i: usize| -> Gain {
            let noise = Noise { torque: self.torque_noise(i, levels[i]), position: self.position_noise[i] };
            alone(i).gain(&noise, h).unwrap_or_default()
        };
        let rate = joints.clone().map(|i| alone(i).rate()).fold(0.0, f64::max);
        Weighing {
            gains: joints.clone().map(gain).collect(),
            weights: vec![[1.0, 0.0, 1.0]; joints.len()],
            pace: Pace::of(1.5 * rate, h),
        }
    }

    /// Per joint the level of torque noise whose gain makes the innovations likeliest.
    fn levels(&self, values: &Values) -> Vec<i32> {
        let n = values.joints.len();
        let mut best = vec![(f64::INFINITY, FIRST); n];
        for level in 0..LEVELS {
            let innovations = self.total(values, &self.weighing(values, &vec![level; n]), false);
            for (i, best) in best.iter_mut().enumerate() {
                let surprise = determinant(innovations.covariance(i)).ln();
                if surprise < best.0 {
                    *best = (surprise, level);
                }
            }
        }
        best.into_iter().map(|(_, level)| level).collect()
    }

    /// Gauss–Newton with the damping of Marquardt; whether it came to an end.
    fn climb(
        &self,
        mut values: Values,
        weighing: &Weighing,
        told: &dyn Fn(usize) -> Result<(), Problems>,
    ) -> Result<(Values, bool), Problems> {
        let mut here = self.total(&values, weighing, true);
        let mut damping = 1e-4;
        for step in 0..STEPS {
            told(step)?;
            let (information, score) = self.with_prior(&here, &values);
            let cost = self.cost(&here, &values);
            let mut moved = None;
            while damping < 1e6 {
                let Some(step) = damped(&information, &score, damping) else {
                    damping *= 10.0;
                    continue;
                };
                let gain: f64 = step.iter().zip(&score).map(|(step, score)| 0.5 * step * score).sum();
                if gain < ENOUGH {
                    return Ok((values, true));
                }
                let there = values.moved(&self.limited(&step, &values));
                let total = self.total(&there, weighing, true);
                if self.cost(&total, &there) < cost {
                    moved = Some((there, total));
                    damping = (0.1 * damping).max(1e-9);
                    break;
                }
                damping *= 10.0;
            }
            let Some((there, total)) = moved else { return Ok((values, false)) };
            (values, here) = (there, total);
        }
        Ok((values, false))
    }

    /// `step` with every part inside its bound.
    fn limited(&self, step: &[f64], values: &Values) -> Vec<f64> {
        let logarithms = values.joints.len() * Parameter::COUNT;
        step.iter()
            .enumerate()
            .map(|(i, &step)| {
                let most = match i.checked_sub(logarithms) {
                    None => LONGEST,
                    Some(log) => LONGEST_OFFSET * self.logs[log].period,
                };
                step.clamp(-most, most)
            })
            .collect()
    }

    fn cost(&self, total: &Total, values: &Values) -> f64 {
        let cost = total.cost + self.prior.distance(values).iter().map(|x| 0.5 * x * x).sum::<f64>();
        if cost.is_finite() { cost } else { f64::INFINITY }
    }

    /// Information and score with those of the prior.
    pub fn with_prior(&self, total: &Total, values: &Values) -> (Symmetric<f64>, Vec<f64>) {
        let size = values.unknowns();
        let spread = &self.prior.spread;
        let information = Symmetric::from_fn(size, |i, j| {
            let own = if i == j { (spread[i] * spread[i]).recip() } else { 0.0 };
            total.information[i * size + j] + own
        });
        let pull = self.prior.distance(values);
        let score = total.score();
        let score = score.iter().zip(pull.iter().zip(spread)).map(|(score, (x, spread))| score - x / spread);
        (information, score.collect())
    }
}

/// Determinant of a covariance of link and motor; of the one that is measured if the other is not.
fn determinant([l, both, m]: [f64; 3]) -> f64 {
    let floor = f64::MIN_POSITIVE;
    match (l > 0.0, m > 0.0) {
        (true, true) => (l * m - both * both).max(floor),
        _ => l.max(m).max(floor),
    }
}

/// Inverse covariances of the innovations, joint by joint.
fn weights(total: &Total) -> Vec<[f64; 3]> {
    (0..total.squares.len())
        .map(|i| {
            let [l, both, m] = total.covariance(i);
            let inverse = |x: f64| if x > 0.0 { x.recip() } else { 0.0 };
            if l > 0.0 && m > 0.0 && l * m > both * both {
                let determinant = l * m - both * both;
                [m / determinant, -both / determinant, l / determinant]
            } else {
                [inverse(l), 0.0, inverse(m)]
            }
        })
        .collect()
}

/// (information + damping · its diagonal)⁻¹ score; none where that is not definite.
fn damped(information: &Symmetric<f64>, score: &[f64], damping: f64) -> Option<Vec<f64>> {
    let scale: Vec<f64> = (0..score.len()).map(|i| information.at(i, i).sqrt().recip()).collect();
    let scaled = Symmetric::from_fn(score.len(), |i, j| {
        information.at(i, j) * scale[i] * scale[j] + if i == j { damping } else { 0.0 }
    });
    let right: Vec<f64> = score.iter().zip(&scale).map(|(score, scale)| score * scale).collect();
    let step = solved(&cholesky(&scaled)?, &right);
    let step: Vec<f64> = step.iter().zip(&scale).map(|(step, scale)| step * scale).collect();
    step.iter().all(|x| x.is_finite()).then_some(step)
}
