//! What dampings and frictions of a joint take, by the log and by its numbers.

use super::{Smooth, delayed, rows, smoothed, torques_of};
use crate::identify::parameters::Values;
use crate::logs::Log;
use crate::logs::smooth::{REACH, window};
use crate::robot::Arm;

/// Mean powers of a joint in W.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// What the motor gives and the link does not get: energy that comes and goes with position and speed is in neither, over a long log.
    pub measured: f64,
    /// What its numbers take.
    pub said: f64,
    /// What goes in and out, as absolute values.
    pub passed: f64,
}

/// Joint by joint.
pub(crate) fn works(arm: &dyn Arm, logs: &[Log], values: &Values) -> Vec<Work> {
    let mut works = vec![Work::default(); values.joints.len()];
    let mut samples = 0.0;
    for (log, offset) in logs.iter().zip(&values.offsets) {
        let window = window(REACH, log.period);
        let at = rows(log, window.len());
        let side = |q: Option<&Vec<f64>>| q.map(|q| Smooth::all(q, log, &window));
        let (q_l, q_m) = (side(log.q_l.as_ref()), side(log.q_m.as_ref()));
        // Where one side is not measured it moves with the other.
        let Some((links, motors)) = q_l.as_ref().or(q_m.as_ref()).zip(q_m.as_ref().or(q_l.as_ref())) else {
            continue;
        };
        samples += at.len() as f64;
        let carried = torques_of(arm, links, &at);
        #[expect(clippy::cast_possible_truncation, reason = "tens of samples")]
        let halves = (2.0 * offset / log.period).round() as i32;
        for (i, work) in works.iter_mut().enumerate() {
            let [_, _, d_l, d_m, f_l, f_m] = values.joints[i];
            let torque = smoothed(&log.u_m, log.joints, i, &window);
            let torque: Vec<f64> = at.iter().map(|&k| delayed(&torque, k, halves)).collect();
            // What is carried all the while goes up and down with the link: nobody takes it.
            for (&k, (given, carried)) in at.iter().zip(about_mean(&torque).zip(about_mean(&carried[i]))) {
                let (v_l, v_m) = (links[i].v[k], motors[i].v[k]);
                work.measured += given * v_m - carried * v_l;
                work.said += d_l * v_l * v_l + d_m * v_m * v_m + f_l * v_l.abs() + f_m * v_m.abs();
                work.passed += (given * v_m).abs() + (carried * v_l).abs();
            }
        }
    }
    for work in &mut works {
        for power in [&mut work.measured, &mut work.said, &mut work.passed] {
            *power /= f64::max(samples, 1.0);
        }
    }
    works
}

fn about_mean(torque: &[f64]) -> impl Iterator<Item = f64> {
    let mean = torque.iter().sum::<f64>() / torque.len().max(1) as f64;
    torque.iter().map(move |x| x - mean)
}
