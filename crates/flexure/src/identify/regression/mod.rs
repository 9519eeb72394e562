//! A start without local minima: smoothed by the same window, the equations of motion are linear in the unknowns.

pub(crate) mod both_sides;
pub(crate) mod motors;
pub(crate) mod work;

use super::parameters::Parameter;
use crate::linalg::{Symmetric, cholesky, solved};
use crate::logs::Log;
use crate::logs::smooth::{rates, rms, smoothed};
use crate::robot::Arm;

/// What a regression found of a log.
pub(crate) struct Started {
    /// Per joint in the order of [`Parameter::ALL`], whatever sign noise gave them.
    pub joints: Vec<[f64; Parameter::COUNT]>,
    /// \[s\].
    pub offset: f64,
    /// Per joint the rms that the link's equation leaves over the larger rms of link torque and motor torque, and the rms that the
    /// motor's equation leaves over that of the motor torque; 0 for an equation that is not seen.
    pub unexplained: Vec<[f64; 2]>,
}

/// Rows of the regression are this far apart \[s\].
const APART: f64 = 0.004;

/// Offsets that are tried, in sampling periods: half ones between these.
const OFFSETS: std::ops::RangeInclusive<i32> = -4..=40;

/// The motion of a joint's side, smoothed.
struct Smooth {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Smooth {
    fn new(q: Vec<f64>, period: f64) -> Self {
        let [v, a] = rates(&q, period);
        Self { q, v, a }
    }

    /// Of all joints of `log`, whose positions on this side are `q`.
    fn all(q: &[f64], log: &Log, window: &[f64]) -> Vec<Self> {
        (0..log.joints).map(|i| Self::new(smoothed(q, log.joints, i, window), log.period)).collect()
    }

    /// The sign of the velocity, smoothed.
    fn sign(&self, window: &[f64]) -> Vec<f64> {
        let signs: Vec<f64> = self.v.iter().map(|v| if *v == 0.0 { 0.0 } else { v.signum() }).collect();
        smoothed(&signs, 1, 0, window)
    }
}

/// The likeliest offset in half periods, by the rms that it leaves of each of `joints` joints: a joint that moves by itself, with noise of
/// a size that is not known, tells more than one that friction holds, however much that one's torque leaves.
fn likeliest(joints: usize, left: impl Fn(usize, i32) -> f64) -> i32 {
    let surprise = |halves| (0..joints).map(|joint| left(joint, halves).max(f64::MIN_POSITIVE).ln()).sum();
    let tried = 2 * OFFSETS.start()..=2 * OFFSETS.end();
    tried
        .map(|halves| -> (i32, f64) { (halves, surprise(halves)) })
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(halves, _)| halves)
}

/// The signal at the samples `at`.
fn sampled(signal: &[f64], at: &[usize]) -> Vec<f64> {
    at.iter().map(|&k| signal[k]).collect()
}

/// The samples that make rows.
fn rows(log: &Log, margin: usize) -> Vec<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
    let apart = (APART / log.period).round().max(1.0) as usize;
    (margin..log.samples().saturating_sub(margin)).step_by(apart).collect()
}

/// The links' inverse dynamics at the samples `at`, joint by joint [N m].
fn torques_of(arm: &dyn Arm, links: &[Smooth], at: &[usize]) -> Vec<Vec<f64>> {
    let n = links.len();
    let mut torques = vec![Vec::with_capacity(at.len()); n];
    let mut torque = vec![0.0; n];
    for &k in at {
        let of = |part: fn(&Smooth) -> &Vec<f64>| links.iter().map(|link| part(link)[k]).collect::<Vec<_>>();
        let (q, v, a) = (of(|link| &link.q), of(|link| &link.v), of(|link| &link.a));
        arm.inverse_dynamics(&q, &v, &a, &mut torque).expect("a number per joint");
        for (all, torque) in torques.iter_mut().zip(&torque) {
            all.push(*torque);
        }
    }
    torques
}

/// A torque that is held from sample to sample and acts `halves` half periods later, at the sample `k`.
fn delayed(input: &[f64], k: usize, halves: i32) -> f64 {
    // What is held from one sample to the next is felt half a period later, on average.
    let back = i64::from(halves) + 1;
    let at = |back: i64| {
        #[expect(clippy::cast_possible_wrap, reason = "samples in memory")]
        let k = (k as i64 - back).clamp(0, input.len() as i64 - 1);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        input[k as usize]
    };
    let whole = back.div_euclid(2);
    if back.rem_euclid(2) == 0 { at(whole) } else { 0.5 * (at(whole) + at(whole + 1)) }
}

/// Columns that an equation has, its right-hand side and its weight.
type Equation<'a> = (&'a [Option<&'a [f64]>], &'a [f64], f64);

/// Weighed least squares of all `equations` in `unknowns` unknowns, columns scaled to one; zero where nothing moves.
fn least_squares(equations: &[Equation<'_>], unknowns: usize) -> Vec<f64> {
    let mut normal = vec![0.0; unknowns * unknowns];
    let mut b = vec![0.0; unknowns];
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    for (columns, right, weight) in equations {
        for (i, x) in columns.iter().enumerate() {
            let Some(x) = x else { continue };
            b[i] += weight * dot(x, right);
            for (j, y) in columns.iter().enumerate().take(i + 1) {
                if let Some(y) = y {
                    normal[i * unknowns + j] += weight * dot(x, y);
                }
            }
        }
    }
    let scale: Vec<f64> = (0..unknowns)
        .map(|i| normal[i * unknowns + i].sqrt())
        .map(|x| if x > 0.0 { x.recip() } else { 0.0 })
        .collect();
    // What nothing tells apart is shared by the least solution.
    let scaled = Symmetric::from_fn(unknowns, |i, j| {
        normal[i * unknowns + j] * scale[i] * scale[j] + if i == j { 1e-12 } else { 0.0 }
    });
    let right: Vec<f64> = b.iter().zip(&scale).map(|(b, s)| b * s).collect();
    let Some(lower) = cholesky(&scaled) else { return vec![0.0; unknowns] };
    solved(&lower, &right).iter().zip(&scale).map(|(x, s)| x * s).collect()
}

fn residual(columns: &[Option<&[f64]>], right: &[f64], x: &[f64]) -> f64 {
    let left: Vec<f64> = (0..right.len())
        .map(|k| {
            let known = columns.iter().zip(x).filter_map(|(column, x)| Some((*column)?[k] * x));
            right[k] - known.sum::<f64>()
        })
        .collect();
    rms(&left, 1, 0)
}

#[cfg(test)]
mod tests {
    use super::likeliest;

    /// Of a cart that friction holds most of the time a tenth of the torque is left, and a little less of it at 10 half periods, because
    /// feedback repeats itself; a pole that swings freely knows better, though its torque is a hundredth of that.
    #[test]
    fn a_joint_that_friction_holds_does_not_outvote_one_that_moves() {
        let cart = |halves: f64| 13.3 + 0.0005 * (halves - 10.0).powi(2);
        let pole = |halves: f64| 0.01 * (1.0 + (halves / 5.0).powi(2)).sqrt();
        let left = |joint: usize, halves: i32| {
            if joint == 0 { cart(f64::from(halves)) } else { pole(f64::from(halves)) }
        };
        assert_eq!(likeliest(1, left), 10);
        assert_eq!(likeliest(2, left), 0);
    }
}
