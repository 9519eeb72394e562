//! How far a step of collocation can be trusted.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::Sides;
use crate::simulate::collocation::{Task, Torques};
use crate::simulate::newton::{StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};

/// Speed [rad/s] below which errors count as absolute.
const SLOW: f64 = 1e-3;

/// What the error of a step is estimated from.
pub(super) struct Values<'a, const S: usize, const N: usize> {
    pub start: &'a Sides<N>,
    pub solution: &'a StepSolution<S, N>,
    pub torques: &'a Torques<S, N>,
    /// What stage values are multiplied by to have the value at the start of the polynomial whose error is asked for, and of that
    /// of half as many stages.
    pub at_start: [Stages<S>; 2],
}

/// The estimated error of a step of `C` stages, relative to the speeds of the joints. The defect of its polynomials at the start, where
/// their slope is known, and of the torque at the end is of lower order than the error. What it becomes grows with the rates at
/// which the robot moves by itself, and with that at which it is seen to be moved: defects of more stages are smaller by the powers of
/// that rate. So a torque that jumps, whose defects are alike, counts in full. A defect of a motor is also damped away.
pub(super) fn estimate<const C: usize, const S: usize, L: Links<f64, N>, const N: usize>(
    task: &Task<'_, L, N>,
    solver: &StageSolver<S, N>,
    values: &Values<'_, S, N>,
    of_damped: impl Fn(usize) -> f64,
) -> f64 {
    let Task { plant, x, h, .. } = *task;
    let Values { start, solution, torques: Torques { stages, end }, at_start: [own, half] } = values;
    let speeds = speeds(x, h, solver, start);
    let known = (0..C).fold(1.0, |power, _| power * solver.fastest);
    let mut worst = 0.0_f64;
    for k in 0..plant.robot.links.joints() {
        let mut effect = |known_value: f64, unit: f64, damped: f64, value: &dyn Fn(usize) -> f64| {
            let (mut a, mut b) = (known_value, known_value);
            for i in 0..S {
                a -= own[i] * value(i);
                b -= half[i] * value(i);
            }
            if a != 0.0 {
                let seen = Scheme::<C>::DEFECT_OF_HALF * a / b;
                let growth = (Scheme::<C>::ERROR_OF_DEFECT * known.max(seen * seen)).min(1.0);
                worst = worst.max(a.abs() * unit * (growth + damped));
            }
        };
        effect(start[0][k], h / speeds[0][k], 0.0, &|i| solution.link[i][k]);
        effect(start[1][k], h / speeds[1][k], of_damped(k), &|i| solution.motor[i][k]);
        // The points lie alike from both ends.
        let of_torque = h / plant.robot.motor_inertia[k] / speeds[1][k];
        effect(end[k], of_torque, 0.0, &|i| stages[S - 1 - i][k]);
    }
    worst
}

/// What errors of links and motors count by [rad/s].
pub(super) fn speeds<const S: usize, const N: usize>(
    x: &Motion<f64, N>,
    h: f64,
    solver: &StageSolver<S, N>,
    start: &Sides<N>,
) -> Sides<N> {
    let link = Vector::from_fn(|k| x.v_l[k].abs().max(h * start[0][k].abs()) + SLOW);
    let gained = |k: usize| h * solver.damped[k].end.drift * start[1][k].abs();
    [link, Vector::from_fn(|k| x.v_m[k].abs().max(gained(k)) + SLOW)]
}
