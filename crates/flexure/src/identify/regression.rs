//! A start without local minima: what both encoders say is linear in the unknowns.
//!
//! Smoothed by the same window, K ζ = τ + D_l q̇_l + F_l sign q̇_l with the links' inverse dynamics τ, which are known, and
//! M_m q̈_m + D_m q̇_m + F_m sign q̇_m + K ζ = u. Least squares, joint by joint; the offset of the torque by trying.

use super::parameters::Parameter;
use crate::linalg::{Symmetric, cholesky, solved};
use crate::logs::Log;
use crate::logs::smooth::{rates, rms, smoothed, window};
use crate::robot::Arm;

/// What a regression found of a log.
pub(crate) struct Started {
    /// Per joint in the order of [`Parameter::ALL`], whatever sign noise gave them.
    pub joints: Vec<[f64; Parameter::COUNT]>,
    /// \[s\].
    pub offset: f64,
    /// Per joint what is not explained of the torques of links and of motors, as a part of the larger, and of that of motors (rms over
    /// rms).
    pub unexplained: Vec<[f64; 2]>,
}

/// Rows of the regression are this far apart \[s\].
const APART: f64 = 0.004;

/// Offsets that are tried, in sampling periods: half ones between these.
const OFFSETS: std::ops::RangeInclusive<i32> = -4..=40;

/// Smoothed signals of a joint, at the rows.
struct Rows {
    /// ζ, q̇_l, sign q̇_l, τ.
    link: [Vec<f64>; 4],
    /// q̈_m, q̇_m, sign q̇_m.
    motor: [Vec<f64>; 3],
}

/// Starts from `log`, which has positions of both sides.
pub(crate) fn start(arm: &dyn Arm, log: &Log, q_l: &[f64], q_m: &[f64]) -> Started {
    let n = log.joints;
    let window = window(log.period);
    let motion = |q: &[f64]| -> Vec<[Vec<f64>; 3]> {
        (0..n)
            .map(|i| {
                let q = smoothed(q, n, i, &window);
                let [v, a] = rates(&q, log.period);
                [q, v, a]
            })
            .collect()
    };
    let (links, motors) = (motion(q_l), motion(q_m));
    let at = rows(log, window.len());
    let torques = weights(arm, &links, &at);
    let sign = |v: &[f64]| smoothed(&v.iter().map(|v| sign(*v)).collect::<Vec<_>>(), 1, 0, &window);
    let of = |signal: &[f64]| at.iter().map(|&k| signal[k]).collect::<Vec<_>>();
    let joints: Vec<Rows> = (0..n)
        .map(|i| {
            let ([q_l, v_l, _], [q_m, v_m, a_m]) = (&links[i], &motors[i]);
            let deflection: Vec<_> = q_m.iter().zip(q_l).map(|(m, l)| m - l).collect();
            Rows {
                link: [of(&deflection), of(v_l), of(&sign(v_l)), torques[i].clone()],
                motor: [of(a_m), of(v_m), of(&sign(v_m))],
            }
        })
        .collect();
    let inputs: Vec<_> = (0..n).map(|i| smoothed(&log.u_m, n, i, &window)).collect();
    let input =
        |i: usize, halves: i32| -> Vec<f64> { at.iter().map(|&k| delayed(&inputs[i], k, halves)).collect() };
    let scales: Vec<_> = (0..n).map(|i| rms(&log.u_m, n, i).max(f64::MIN_POSITIVE)).collect();
    let misfit = |halves: i32| -> f64 {
        (0..n).map(|i| (motor_alone(&joints[i], &input(i, halves)).1 / scales[i]).powi(2)).sum()
    };
    let tried = 2 * OFFSETS.start()..=2 * OFFSETS.end();
    let best = tried.map(|halves| (halves, misfit(halves))).min_by(|a, b| a.1.total_cmp(&b.1));
    let halves = best.map_or(0, |(halves, _)| halves);
    let mut started =
        Started { joints: Vec::new(), offset: f64::from(halves) * 0.5 * log.period, unexplained: Vec::new() };
    for (rows, (i, scale)) in joints.iter().zip(scales.iter().enumerate()) {
        let (found, [link, motor]) = together(rows, &input(i, halves));
        started.joints.push(found);
        // A light link takes less torque than its motor needs for itself, and encoders leave as much of it unexplained.
        let torque = rms(&rows.link[3], 1, 0).max(*scale);
        started.unexplained.push([link / torque, motor / scale]);
    }
    started
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}

/// The samples that make rows.
fn rows(log: &Log, margin: usize) -> Vec<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
    let apart = (APART / log.period).round().max(1.0) as usize;
    (margin..log.samples().saturating_sub(margin)).step_by(apart).collect()
}

/// The links' inverse dynamics at the samples `at`, joint by joint [N m].
fn weights(arm: &dyn Arm, links: &[[Vec<f64>; 3]], at: &[usize]) -> Vec<Vec<f64>> {
    let n = links.len();
    let mut torques = vec![Vec::with_capacity(at.len()); n];
    let mut torque = vec![0.0; n];
    for &k in at {
        let [q, v, a] = [0, 1, 2].map(|part| links.iter().map(|link| link[part][k]).collect::<Vec<_>>());
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

/// The motor's equation by itself, with its own spring constant: coefficients and rms of what is left [N m].
fn motor_alone(rows: &Rows, input: &[f64]) -> (Vec<f64>, f64) {
    let [a, v, s] = &rows.motor;
    let columns = [a, v, s, &rows.link[0]];
    let x = least_squares(&[(&columns.map(|c| Some(&**c)), input, 1.0)], 4);
    let left = residual(&columns.map(|c| Some(&**c)), input, &x);
    (x, left)
}

/// Both equations of a joint with one spring constant, each weighed by what it leaves.
fn together(rows: &Rows, input: &[f64]) -> ([f64; Parameter::COUNT], [f64; 2]) {
    let [deflection, v_l, s_l, torque] = &rows.link;
    let [a_m, v_m, s_m] = &rows.motor;
    let negative = |x: &[f64]| x.iter().map(|x| -x).collect::<Vec<_>>();
    let (v_l, s_l) = (negative(v_l), negative(s_l));
    // K, M_m, D_l, D_m, F_l, F_m.
    let link = [Some(&**deflection), None, Some(&*v_l), None, Some(&*s_l), None];
    let motor = [Some(&**deflection), Some(&**a_m), None, Some(&**v_m), None, Some(&**s_m)];
    let mut left = [rms(torque, 1, 0), rms(input, 1, 0)].map(|x| x.max(1e-12));
    let mut x = vec![0.0; Parameter::COUNT];
    for _ in 0..4 {
        let weights = left.map(|left| (left * left).recip());
        x = least_squares(&[(&link, torque, weights[0]), (&motor, input, weights[1])], Parameter::COUNT);
        left = [residual(&link, torque, &x), residual(&motor, input, &x)].map(|x| x.max(1e-12));
    }
    (std::array::from_fn(|i| x[i]), left)
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
