//! A start where both sides are seen.
//!
//! K ζ = τ + D_l q̇_l + F_l sign q̇_l with the links' inverse dynamics τ, which are known, and
//! M_m q̈_m + D_m q̇_m + F_m sign q̇_m + K ζ = u. Least squares, joint by joint; the offset of the torque by trying.

use super::{Smooth, Started, delayed, least_squares, likeliest, residual, rows, sampled, torques_of};
use crate::identify::parameters::Parameter;
use crate::logs::Log;
use crate::logs::smooth::{REACH, rms, smoothed, window};
use crate::robot::Arm;

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
    let window = window(REACH, log.period);
    let [links, motors] = [q_l, q_m].map(|q| Smooth::all(q, log, &window));
    let at = rows(log, window.len());
    let torques = torques_of(arm, &links, &at);
    let of = |signal: &[f64]| sampled(signal, &at);
    let joints: Vec<Rows> = links
        .iter()
        .zip(&motors)
        .zip(torques)
        .map(|((link, motor), torque)| {
            let deflection: Vec<_> = motor.q.iter().zip(&link.q).map(|(m, l)| m - l).collect();
            Rows {
                link: [of(&deflection), of(&link.v), of(&link.sign(&window)), torque],
                motor: [of(&motor.a), of(&motor.v), of(&motor.sign(&window))],
            }
        })
        .collect();
    let inputs: Vec<_> = (0..n).map(|i| smoothed(&log.u_m, n, i, &window)).collect();
    let input =
        |i: usize, halves: i32| -> Vec<f64> { at.iter().map(|&k| delayed(&inputs[i], k, halves)).collect() };
    let scales: Vec<_> = (0..n).map(|i| rms(&log.u_m, n, i).max(f64::MIN_POSITIVE)).collect();
    let halves = likeliest(n, |i, halves| motor_alone(&joints[i], &input(i, halves)).1);
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
