//! A start where only the motors are seen: below the frequencies at which springs swing, links move almost as their motors do.
//!
//! u = M_m q̈_m + (D_l + D_m) q̇_m + (F_l + F_m) sign q̇_m + τ, with the links' inverse dynamics τ at q_m − τ/K, K as the robot file
//! says. That is linear in the motor inertia and in the sums of both sides, of which each side gets half.

use super::{Smooth, Started, delayed, least_squares, likeliest, residual, rows, sampled, torques_of};
use crate::logs::Log;
use crate::logs::smooth::{rms, smoothed, window};
use crate::robot::Arm;

/// Reach of the window \[s\]: above some 10 Hz springs swing, and links do not follow their motors.
const REACH: f64 = 0.1;

/// Starts from `log`, which has the positions `q_m` of the motors, with springs of `stiffness` [N m/rad].
pub(crate) fn start(arm: &dyn Arm, log: &Log, q_m: &[f64], stiffness: &[f64]) -> Started {
    let n = log.joints;
    let window = window(REACH, log.period);
    let motors = Smooth::all(q_m, log, &window);
    let links = behind(arm, log, &motors, stiffness, &window);
    let at = rows(log, 2 * window.len());
    let torques = torques_of(arm, &links, &at);
    let columns: Vec<_> = motors
        .iter()
        .map(|motor| [&motor.a, &motor.v, &motor.sign(&window)].map(|signal| sampled(signal, &at)))
        .collect();
    let inputs: Vec<_> = (0..n).map(|i| smoothed(&log.u_m, n, i, &window)).collect();
    let scales: Vec<_> = (0..n).map(|i| rms(&log.u_m, n, i).max(f64::MIN_POSITIVE)).collect();
    let explained = |i: usize, halves: i32| {
        let left = at.iter().zip(&torques[i]).map(|(&k, torque)| delayed(&inputs[i], k, halves) - torque);
        let left: Vec<f64> = left.collect();
        let columns = columns[i].each_ref().map(|column| Some(&**column));
        let x = least_squares(&[(&columns, &left, 1.0)], columns.len());
        let unexplained = residual(&columns, &left, &x) / scales[i];
        (x, unexplained)
    };
    let halves = likeliest(|halves| (0..n).map(|i| explained(i, halves).1.powi(2)).sum());
    let of_joint = |i: usize| {
        let (x, unexplained) = explained(i, halves);
        let (damping, friction) = (0.5 * x[1], 0.5 * x[2]);
        ([stiffness[i], x[0], damping, damping, friction, friction], [0.0, unexplained])
    };
    let (joints, unexplained) = (0..n).map(of_joint).unzip();
    Started { joints, offset: f64::from(halves) * 0.5 * log.period, unexplained }
}

/// The motion of the links behind `motors`, which lag by the bending of their springs.
fn behind(arm: &dyn Arm, log: &Log, motors: &[Smooth], stiffness: &[f64], window: &[f64]) -> Vec<Smooth> {
    let every: Vec<usize> = (0..log.samples()).collect();
    let torques = torques_of(arm, motors, &every);
    let of = |((motor, torque), K): ((&Smooth, &Vec<f64>), &f64)| {
        let bent = smoothed(torque, 1, 0, window);
        Smooth::new(motor.q.iter().zip(bent).map(|(q, torque)| q - torque / K).collect(), log.period)
    };
    motors.iter().zip(&torques).zip(stiffness).map(of).collect()
}
