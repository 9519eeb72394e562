//! How far a step of collocation can be trusted.

use flexure_core::linalg::Vector;
use flexure_core::model::Links;
use flexure_core::scalar::{Over, Piecewise};

use crate::plant::Sides;
use crate::simulate::newton::StepSolution;
use crate::simulate::scheme::{Scheme, Stages};
use crate::simulate::span::{EachAtStages, Span};

/// Motor torques at the stages and at the end of a step [N m].
#[derive(Clone, Copy)]
pub(crate) struct Torques<const S: usize, const N: usize, T = f64> {
    pub(super) stages: EachAtStages<S, N, T>,
    pub(super) end: Vector<T, N>,
}

/// What the error of a step is estimated from.
pub(super) struct Values<'a, const S: usize, const N: usize, T = f64> {
    pub start: &'a Sides<N, T>,
    pub solution: &'a StepSolution<S, N, T>,
    /// None where the torque is constant.
    pub torques: Option<&'a Torques<S, N, T>>,
    /// What stage values are multiplied by to have the value at the start of the polynomial whose error is asked for, and of that
    /// of half as many stages.
    pub at_start: [Stages<S>; 2],
}

/// The estimated error of a step of `C` stages, relative to the speeds of the joints. The defect of its polynomials at the start, where
/// their slope is known, and of the torque at the end is of lower order than the error. What it becomes grows with the rates at
/// which the robot moves by itself, and with that at which it is seen to be moved: defects of more stages are smaller by the powers of
/// that rate. So a torque that jumps, whose defects are alike, counts in full. A defect of a motor is also damped away.
pub(super) fn estimate<const C: usize, L, const S: usize, const N: usize, T>(
    span: &Span<'_, L, S, N, T>,
    speeds: &Sides<N, T>,
    values: &Values<'_, S, N, T>,
    of_damped: impl Fn(usize) -> T,
) -> T
where
    T: Piecewise + Over<T> + Over<f64>,
    L: Links<T, N>,
{
    let Span { plant, h, solver, .. } = *span;
    let Values { start, solution, torques, at_start: [own, half] } = values;
    let known = (0..C).fold(T::ONE, |power, _| power * solver.fastest);
    let mut worst = T::ZERO;
    for k in 0..plant.robot.links.joints() {
        let mut effect = |known_value: T, unit: T, damped: T, value: &dyn Fn(usize) -> T| {
            let (mut a, mut b) = (known_value, known_value);
            for i in 0..S {
                a -= value(i).scale(own[i]);
                b -= value(i).scale(half[i]);
            }
            let seen = a.scale(Scheme::<C>::DEFECT_OF_HALF) / b;
            let growth = known.max(seen * seen).scale(Scheme::<C>::ERROR_OF_DEFECT).min(T::ONE);
            // Where there is no defect, nothing of the kind is seen.
            let error = a.abs();
            worst = worst.max((-error).select(T::ZERO, error * unit * (growth + damped)));
        };
        let h = T::from_f64(h);
        effect(start[0][k], h / speeds[0][k], T::ZERO, &|i| solution.link[k][i]);
        effect(start[1][k], h / speeds[1][k], of_damped(k), &|i| solution.motor[k][i]);
        if let Some(Torques { stages, end }) = torques {
            // The points lie alike from both ends.
            let of_torque = h / plant.robot.motor_inertia[k] / speeds[1][k];
            effect(end[k], of_torque, T::ZERO, &|i| stages[k][S - 1 - i]);
        }
    }
    worst
}
