//! Maximum likelihood of the innovations: Gauss–Newton steps with the prior as one more measurement, then the noise that makes
//! the innovations likeliest, and again; at the end a look beyond the minimum, and where it finds less, on from there.

use std::ops::RangeInclusive;

use rayon::prelude::*;

use super::bounded::{bounds, damped};
use super::gain::{Noise, Posture};
use super::layer::{Layer, Total, total};
use super::parameters::{Parameter, Values, unknown};
use super::predictor::{Piece, Weighing};
use super::prior::Prior;
use super::scan::scanned;
use super::step::Pace;
use crate::files::Problems;
use crate::linalg::{Dense, Symmetric, cholesky, solved};
use crate::logs::Log;
use crate::progress::Progress;

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
}

/// What was found.
pub(crate) struct Found {
    pub values: Values,
    /// What is found from there with gains that believe the model less and more; none where links are seen.
    pub doubting: Vec<Values>,
    pub weighing: Weighing,
    /// Per joint the torque noise that makes the innovations likeliest [N m].
    pub torque_noise: Vec<f64>,
    /// The innovations at `values`, weighed as they are.
    pub total: Total,
    pub converged: bool,
}

/// Torque noise that is tried, as parts of the torque: these powers of a quarter, with encoders of both sides and with those of the
/// motors alone. Where nothing disturbs, less would be likelier still; but then what a model never has, the instants at which
/// friction turns among it, would be believed to a part in ten thousand.
const LEVELS: [RangeInclusive<i32>; 2] = [1..=3, 3..=4];

/// Other levels that an estimate without link encoders is held against.
const DOUBTING: [i32; 2] = [3, 5];

/// The least noise of encoders, as a part of what they have.
const LEAST: f64 = 1e-3;

/// Rounds of noise and values before the last, looks beyond the minimum after it, and Gauss–Newton steps in each, at most.
const ROUNDS: usize = 3;
const LOOKS: usize = 4;
const STEPS: usize = 12;

/// A round ends where a step promises less than this of the logarithm of the likelihood: a fifth of an error bar. Beyond that,
/// instants at which friction turns make the likelihood rough.
const ENOUGH: f64 = 0.02;

/// A step that promises less than this and gains nothing ends a round, too.
const ROUGH: f64 = 1.0;

/// Where links are seen and nothing is gained the search has come to its end if all that is promised is less than this for each unknown:
/// they move by 0.4 standard deviations, an eighth of a printed error bar, on the average. Without link encoders valleys lead farther.
const ROUGH_EACH: f64 = 0.08;

impl Search<'_> {
    /// From `values`.
    ///
    /// # Errors
    /// If it was broken off.
    pub fn run(&self, mut values: Values, progress: Progress<'_>) -> Result<Found, Problems> {
        let n = values.joints.len();
        let told = |round: usize, step: usize| {
            let fraction =
                (round as f64 + step as f64 / STEPS as f64) / (ROUNDS + LOOKS + DOUBTING.len()) as f64;
            if progress(fraction).is_break() { Err(Problems::interrupted()) } else { Ok(()) }
        };
        let (mut levels, mut weighing);
        (values, levels, weighing) = self.first(&values, &|step| told(0, step))?;
        for round in 1..ROUNDS {
            (values, _) = self.climb(values, &mut weighing, ROUGH, &|step| told(round, step))?;
            levels = self.levels(&values, &levels);
            weighing = self.weighed(&values, &levels);
        }
        let mut converged = false;
        for look in 0..LOOKS {
            let before = values.clone();
            (values, converged) =
                self.climb(values, &mut weighing, ENOUGH, &|step| told(ROUNDS + look, step))?;
            if self.of_links() {
                // Where springs are seen to bend, the regression started beside the deepest minimum.
                if converged || values == before {
                    break;
                }
                continue;
            }
            let (information, _) = self.with_prior(&self.total(&values, &weighing, true), &values);
            let (there, better) = scanned(&values, &valleys(&information, n), |there| {
                told(ROUNDS + look, STEPS - 1)?;
                Ok::<_, Problems>(self.cost(&self.total(there, &weighing, false), there))
            })?;
            if better >= ROUGH {
                (values, converged) = (there, false);
            } else if converged || values == before {
                break;
            }
        }
        let total = self.total(&values, &weighing, true);
        let mut doubting = Vec::new();
        for (k, level) in DOUBTING.into_iter().enumerate().filter(|_| !self.of_links()) {
            let mut weighing = self.weighed(&values, &vec![level; n]);
            let told = |step| told(ROUNDS + LOOKS + k, step);
            doubting.push(self.climb(values.clone(), &mut weighing, ENOUGH, &told)?.0);
        }
        let torque_noise = (0..n).map(|i| self.torque_noise(i, levels[i])).collect();
        Ok(Found { values, doubting, weighing, torque_noise, total, converged })
    }

    /// Sampling periods of the logs \[s\].
    fn periods(&self) -> impl Iterator<Item = f64> {
        self.logs.iter().map(|log| log.period)
    }

    /// Whether links have encoders.
    fn of_links(&self) -> bool {
        self.logs[0].q_l.is_some()
    }

    fn total(&self, values: &Values, weighing: &Weighing, informed: bool) -> Total {
        let fitted = self.pieces.iter().filter(|piece| !piece.held_out);
        total(self.layer, self.logs, fitted, values, weighing, informed)
    }

    fn torque_noise(&self, joint: usize, level: i32) -> f64 {
        self.torque_size[joint] * 0.25_f64.powi(level)
    }

    /// Gains at the noise of `levels`, in the posture of each piece, and weights of one.
    fn weighing(&self, values: &Values, levels: &[i32]) -> Weighing {
        let n = values.joints.len();
        let noise: Vec<_> = (0..n)
            .map(|i| Noise { torque: self.torque_noise(i, levels[i]), position: self.position_noise[i] })
            .collect();
        let found: Vec<_> = self
            .pieces
            .par_iter()
            .map(|piece| {
                let log = &self.logs[piece.log];
                let posture = self.posture(values, log, piece.counted.midpoint(piece.end));
                let gain = posture.gain(&noise, log.period);
                (posture.rate().unwrap_or(0.0), gain.unwrap_or_else(|| Dense::zeros(4 * n, 2 * n)))
            })
            .collect();
        let rate = found.iter().map(|(rate, _)| *rate).fold(0.0, f64::max);
        let h = self.logs.iter().map(|log| log.period).fold(0.0, f64::max);
        Weighing {
            gains: found.into_iter().map(|(_, gain)| gain).collect(),
            weights: vec![[1.0, 0.0, 1.0]; n],
            pace: Pace::of(1.3 * rate, h),
        }
    }

    /// The robot at sample `k` of `log`.
    fn posture(&self, values: &Values, log: &Log, k: usize) -> Posture {
        let n = log.joints;
        let positions = log.q_l.as_ref().or(log.q_m.as_ref()).map_or(&[][..], |q| &q[k * n..(k + 1) * n]);
        Posture {
            mass: self.layer.mass(positions),
            motor_inertia: values.of(Parameter::MotorInertia),
            stiffness: values.of(Parameter::Stiffness),
            link_damping: values.of(Parameter::LinkDamping),
            motor_damping: values.of(Parameter::MotorDamping),
        }
    }

    /// The weighing at the noise of `levels`: what innovations at `values` are, is their weight.
    fn weighed(&self, values: &Values, levels: &[i32]) -> Weighing {
        let weighing = self.weighing(values, levels);
        let innovations = self.total(values, &weighing, false);
        Weighing { weights: self.weights(&innovations), ..weighing }
    }

    /// The first round, from `values`: numbers, levels and weighing.
    ///
    /// Where links are seen it is done with the most and the least noise, and what is likelier counts. Corrections that are large
    /// lead through the valleys of guesses; but they answer to what the law made of the errors of the encoders, and lead away from the
    /// good start that the regression mostly is. Where links are not seen the noise is the least: with numbers that are guesses,
    /// predictions that are corrected much by the motors alone are wild.
    fn first(
        &self,
        values: &Values,
        told: &dyn Fn(usize) -> Result<(), Problems>,
    ) -> Result<(Values, Vec<i32>, Weighing), Problems> {
        let n = values.joints.len();
        let [of_both, of_motors] = LEVELS;
        let tried =
            if self.of_links() { vec![*of_both.start(), *of_both.end()] } else { vec![*of_motors.end()] };
        let mut best = (values.clone(), vec![tried[0]; n], f64::INFINITY);
        let rounds = tried.len();
        for (k, level) in tried.into_iter().enumerate() {
            let told = |step| told((k * STEPS + step) / rounds);
            let levels = vec![level; n];
            // The first gain is that of the numbers it starts from; it is put right before others are tried.
            let mut weighing = self.weighed(values, &levels);
            let (there, _) = self.climb(values.clone(), &mut weighing, ROUGH, &told)?;
            let cost = self.cost(&self.total(&there, &weighing, false), &there);
            if cost < best.2 {
                best = (there, levels, cost);
            }
        }
        let (values, levels, _) = best;
        let weighing = self.weighed(&values, &levels);
        Ok((values, levels, weighing))
    }

    /// Per joint the level of torque noise whose gain makes the innovations likeliest. Where links are not seen all joints have
    /// the same: a gain that one joint's noise makes may not suit the other's.
    fn levels(&self, values: &Values, from: &[i32]) -> Vec<i32> {
        let n = from.len();
        let [of_both, of_motors] = LEVELS;
        let tried = if self.of_links() { of_both } else { of_motors };
        let surprises: Vec<(i32, Vec<f64>)> = tried
            .map(|level| {
                let innovations = self.total(values, &self.weighing(values, &vec![level; n]), false);
                (level, (0..n).map(|i| determinant(self.covariance(&innovations, i)).ln()).collect())
            })
            .collect();
        let best = |of: &dyn Fn(&[f64]) -> f64, otherwise: i32| {
            let finite = surprises.iter().map(|(level, all)| (of(all), *level)).filter(|x| x.0.is_finite());
            finite.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(otherwise, |(_, level)| level)
        };
        if self.of_links() {
            (0..n).map(|i| best(&|all| all[i], from[i])).collect()
        } else {
            vec![best(&|all| all.iter().sum(), from[0]); n]
        }
    }

    /// Gauss–Newton with the damping of Marquardt under the gains of `weighing`, whose weights follow the innovations; whether it
    /// came to an end.
    fn climb(
        &self,
        mut values: Values,
        weighing: &mut Weighing,
        enough: f64,
        told: &dyn Fn(usize) -> Result<(), Problems>,
    ) -> Result<(Values, bool), Problems> {
        let mut innovations = self.total(&values, weighing, false);
        let mut damping = 1e-4;
        for step in 0..STEPS {
            told(step)?;
            weighing.weights = self.weights(&innovations);
            let cost = self.cost(&innovations, &values);
            let (information, score) = self.with_prior(&self.total(&values, weighing, true), &values);
            // What a step promises that is held back by nothing but its bounds.
            let mut promised = None;
            let mut moved = None;
            while damping < 1e6 {
                let Some((step, gain)) =
                    damped(&information, &score, damping, &bounds(&values, self.periods()))
                else {
                    damping *= 10.0;
                    continue;
                };
                let promised = *promised.get_or_insert(gain);
                if promised < enough {
                    return Ok((values, true));
                }
                let there = values.moved(&step);
                let total = self.total(&there, weighing, false);
                if self.cost(&total, &there) < cost {
                    moved = Some(self.longer(&step, &values, weighing, (there, total)));
                    damping = (0.1 * damping).max(1e-9);
                    break;
                }
                if gain < ENOUGH || promised < ROUGH {
                    let each = if self.of_links() { ROUGH_EACH } else { 0.0 };
                    let is_end = promised < ROUGH.max(each * values.unknowns() as f64);
                    return Ok((values, is_end));
                }
                damping *= 10.0;
            }
            let Some((there, total)) = moved else { return Ok((values, false)) };
            (values, innovations) = (there, total);
        }
        weighing.weights = self.weights(&innovations);
        Ok((values, false))
    }

    /// Twice as far along `step` as long as that is better: past the instants at which friction turns, the likelihood is flatter
    /// than its curvature at one place says.
    fn longer(
        &self,
        step: &[f64],
        values: &Values,
        weighing: &Weighing,
        first: (Values, Total),
    ) -> (Values, Total) {
        let bounds = bounds(values, self.periods());
        let (mut best, mut times) = (first, 2.0);
        loop {
            let longer: Vec<_> =
                step.iter().zip(&bounds).map(|(x, [low, high])| (times * x).clamp(*low, *high)).collect();
            let there = values.moved(&longer);
            let total = self.total(&there, weighing, false);
            if times > 100.0 || self.cost(&total, &there) >= self.cost(&best.1, &best.0) {
                return best;
            }
            best = (there, total);
            times *= 2.0;
        }
    }

    /// Covariance of a joint's innovations, with that of the least that encoders could have: a log without noise would else be believed to the
    /// rounding of its simulation, where the likelihood is rough and has no end.
    fn covariance(&self, total: &Total, joint: usize) -> [f64; 3] {
        let [l, both, m] = total.covariance(joint);
        let [of_link, of_motor] = self.position_noise[joint].map(|noise| {
            let least = LEAST * noise;
            if least.is_finite() { least * least } else { 0.0 }
        });
        [if l > 0.0 { l + of_link } else { l }, both, m + of_motor]
    }

    /// Inverse covariances of the innovations, joint by joint.
    fn weights(&self, total: &Total) -> Vec<[f64; 3]> {
        (0..total.squares.len())
            .map(|i| {
                let [l, both, m] = self.covariance(total, i);
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

    /// Minus the logarithm of the likelihood, each joint's innovations normal with the covariance that they have.
    fn cost(&self, total: &Total, values: &Values) -> f64 {
        let surprise = |i: usize| 0.5 * total.samples as f64 * determinant(self.covariance(total, i)).ln();
        let cost = (0..values.joints.len()).map(surprise).sum::<f64>()
            + self.prior.distance(values).iter().map(|x| 0.5 * x * x).sum::<f64>();
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

/// For each joint the step, as of [`Values::moved`], along which its compliance falls to nothing and the others make the best of it.
fn valleys(information: &Symmetric<f64>, joints: usize) -> Vec<Vec<f64>> {
    let size = information.size();
    let scale: Vec<f64> = (0..size).map(|i| information.at(i, i).sqrt().recip()).collect();
    let scaled = Symmetric::from_fn(size, |i, j| information.at(i, j) * scale[i] * scale[j]);
    let alone = |at: usize| (0..size).map(|i| f64::from(u8::from(i == at))).collect::<Vec<_>>();
    let lower = cholesky(&scaled);
    (0..joints)
        .map(|joint| {
            let at = unknown(joint, Parameter::Stiffness);
            let Some(lower) = &lower else { return alone(at) };
            let column = solved(lower, &alone(at));
            (0..size).map(|i| column[i] * scale[i] / (column[at] * scale[at])).collect()
        })
        .collect()
}

/// Determinant of a covariance of link and motor; of the one that is measured if the other is not.
fn determinant([l, both, m]: [f64; 3]) -> f64 {
    if l > 0.0 { l * m - both * both } else { m }
}
