//! How the robot moved at a sample of a log: cubics through the samples around it.

use std::f64::consts::TAU;

use flexure_core::linalg::{Matrix, Vector};

use crate::files::Problems;
use crate::logs::Log;
use crate::robot::{Arm, overview};
use crate::scenario::Scenario;

/// Half of the samples that a cubic goes through, in radians of the joint's own swing: within it a cubic is the swing to 1 %.
const REACH: f64 = 0.6;

/// Fewest and most samples to either side.
const SIDES: (f64, f64) = (3.0, 20.0);

/// Where a log's windows start from.
pub(super) struct Starts<'a> {
    log: &'a Log,
    arm: Box<dyn Arm>,
    stiffness: &'a [f64],
    /// Samples to either side, per joint.
    sides: Vec<usize>,
}

impl<'a> Starts<'a> {
    /// Of `log`, a log of the robot of `scenario`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    pub fn new(scenario: &'a Scenario, log: &'a Log) -> Result<Self, Problems> {
        let robot = &scenario.robot;
        let side = |resonance: f64| (REACH / (TAU * resonance * log.period)).clamp(SIDES.0, SIDES.1) as usize;
        let sides = overview(robot)?.iter().map(|joint| side(joint.resonance)).collect();
        Ok(Self { log, arm: robot.arm()?, stiffness: &robot.stiffness, sides })
    }

    /// The motion (q_l, q_m, q̇_l, q̇_m) at the sample `k`. A side that is not measured stands where its spring carries the weight of
    /// the links, and moves with the other.
    pub fn at(&self, k: usize) -> Vec<f64> {
        let (links, motors) = (self.side(self.log.q_l.as_deref(), k), self.side(self.log.q_m.as_deref(), k));
        let known = links.as_ref().or(motors.as_ref()).map_or(&[][..], |(q, _)| q);
        let wound = self.wound(known);
        let beside = |(q, v): &(Vec<f64>, Vec<f64>), sign: f64| {
            (q.iter().zip(&wound).map(|(q, wound)| q + sign * wound).collect(), v.clone())
        };
        let (q_m, v_m) = motors.clone().or_else(|| Some(beside(links.as_ref()?, 1.0))).unwrap_or_default();
        let (q_l, v_l) = links.or_else(|| Some(beside(motors.as_ref()?, -1.0))).unwrap_or_default();
        [q_l, q_m, v_l, v_m].concat()
    }

    /// Deflections in rad that carry the links where they stand at `q` in rad.
    fn wound(&self, q: &[f64]) -> Vec<f64> {
        let still = vec![0.0; q.len()];
        let mut weight = still.clone();
        self.arm.inverse_dynamics(q, &still, &still, &mut weight).expect("as many joints");
        weight.iter().zip(self.stiffness).map(|(weight, stiffness)| weight / stiffness).collect()
    }

    /// Positions and velocities of a side at the sample `k`, if it is measured.
    fn side(&self, positions: Option<&[f64]>, k: usize) -> Option<(Vec<f64>, Vec<f64>)> {
        let positions = positions?;
        let joint = |i: usize| {
            let value = |k: usize| positions[k * self.log.joints + i];
            cubic(value, self.log.samples(), k, self.sides[i], self.log.period)
        };
        Some((0..self.log.joints).map(joint).unzip())
    }
}

/// Value and slope at the sample `k` of the cubic of least squares through `value` at the samples around it, `sides` on either
/// side, of which there are `samples`, `period` apart.
fn cubic(value: impl Fn(usize) -> f64, samples: usize, k: usize, sides: usize, period: f64) -> (f64, f64) {
    let width = (2 * sides + 1).min(samples);
    let first = k.saturating_sub(sides).min(samples - width);
    // From the value there: encoders count from anywhere.
    let origin = value(k);
    let mut products = Matrix::<f64, 4, 4>::ZERO;
    let mut moments = Vector::<f64, 4>::ZERO;
    for sample in first..first + width {
        let s = (sample as f64 - k as f64) / sides as f64;
        let powers = [1.0, s, s * s, s * s * s];
        for (i, left) in powers.iter().enumerate() {
            moments[i] += left * (value(sample) - origin);
            for (j, right) in powers.iter().enumerate() {
                products[(i, j)] += left * right;
            }
        }
    }
    let solution = products.ldl().solve(&moments);
    (origin + solution[0], solution[1] / (sides as f64 * period))
}

#[cfg(test)]
mod tests {
    use super::cubic;

    /// A cubic is found exactly, inside and at the ends.
    #[test]
    fn cubics_are_exact() {
        let at = |t: f64| 0.3 - 2.0 * t + 5.0 * t * t - 7.0 * t * t * t;
        let slope = |t: f64| -2.0 + 10.0 * t - 21.0 * t * t;
        for k in [0, 1, 50, 99] {
            let t = |k: usize| 0.01 * k as f64;
            let (q, v) = cubic(|k| at(t(k)), 100, k, 4, 0.01);
            assert!((q - at(t(k))).abs() < 1e-12 && (v - slope(t(k))).abs() < 1e-9, "{k}: {q}, {v}");
        }
    }
}
