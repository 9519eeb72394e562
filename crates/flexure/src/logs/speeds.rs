//! Are logged velocities those of the logged positions? Other units, signs and gears show here, whatever the robot is.

use crate::files::Problem;
use crate::files::number::significant;
use crate::logs::channel::Channel;
use crate::logs::log::Log;
use crate::logs::plausible::{STILL, problem};
use crate::robot::Robot;

/// Velocities go with positions where they explain this part of their squares: filters delay velocities, encoders round positions.
const TOGETHER: f64 = 0.9;

/// Velocities that belong to their positions are the rates of these times a factor between the reciprocal of this and this.
const FACTOR: f64 = 2.0;

/// What to say where a velocity of joint `i` goes with its position, but is not its rate.
pub(super) fn foreign(log: &Log, robot: &Robot, i: usize) -> Option<Problem> {
    let sides = [
        (Channel::LinkPosition, &log.q_l, Channel::LinkVelocity, &log.dq_l),
        (Channel::MotorPosition, &log.q_m, Channel::MotorVelocity, &log.dq_m),
    ];
    sides.into_iter().find_map(|(position, q, velocity, dq)| {
        let of = |values: &Vec<f64>| values.iter().skip(i).step_by(log.joints).copied().collect::<Vec<_>>();
        let factor = factor(&of(q.as_ref()?), &of(dq.as_ref()?), log.period)?;
        if (FACTOR.recip()..=FACTOR).contains(&factor) {
            return None;
        }
        let what = format!(
            "joint {}: {} is {} times the rate of {}",
            robot.joints[i].name,
            velocity.key(),
            significant(factor, 3),
            position.key()
        );
        let help = "is one of them in degrees, in turns, before the gear, or does it count the other way? --columns with unit, \
                    motor_side or sign = -1";
        Some(problem(log, "scale", what, help))
    })
}

/// The factor between `dq` and the rate of `q`; none where they do not go together. Integrals are compared, which noise hardly
/// shows in, without their lines in time, so that a constant error of the velocity does not count.
fn factor(q: &[f64], dq: &[f64], period: f64) -> Option<f64> {
    let (low, high) =
        q.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    if high - low < STILL {
        return None;
    }
    let mut sum = 0.0;
    let steps = dq.windows(2).map(|pair| {
        sum += 0.5 * period * (pair[0] + pair[1]);
        sum
    });
    let travelled = without_line(std::iter::once(0.0).chain(steps).collect());
    let q = without_line(q.to_vec());
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (common, own, other) = (dot(&q, &travelled), dot(&q, &q), dot(&travelled, &travelled));
    (common * common > TOGETHER * own * other).then(|| other / common)
}

/// `values`, evenly spaced, less their line of least squares.
fn without_line(mut values: Vec<f64>) -> Vec<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let from_middle = |k: usize| k as f64 - 0.5 * (count - 1.0);
    let moment: f64 = values.iter().enumerate().map(|(k, x)| from_middle(k) * x).sum();
    let spread: f64 = (0..values.len()).map(|k| from_middle(k).powi(2)).sum();
    for (k, x) in values.iter_mut().enumerate() {
        *x -= mean + from_middle(k) * moment / spread;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::factor;

    /// The factor between velocity and rate, whatever the offset of the velocity; none of what does not go together or hardly moves.
    #[test]
    fn factors_are_found() {
        let samples = |f: fn(f64) -> f64| (0..2000).map(|k| f(0.001 * f64::from(k))).collect::<Vec<_>>();
        let q = samples(|t| 0.3 + 0.1 * (5.0 * t).sin());
        let is = |dq: fn(f64) -> f64, expected: Option<f64>| match (factor(&q, &samples(dq), 0.001), expected)
        {
            (Some(found), Some(expected)) => assert!((found / expected - 1.0).abs() < 1e-4, "{found}"),
            (found, expected) => assert_eq!(found, expected),
        };
        is(|t| 0.5 * (5.0 * t).cos(), Some(1.0));
        is(|t| 0.7 - 0.5 * (5.0 * t).cos(), Some(-1.0));
        is(|t| 28.647_889_756_541_16 * (5.0 * t).cos(), Some(57.295_779_513_082_32));
        is(|t| 0.5 * (23.0 * t).cos(), None);
        is(|_| 0.0, None);
        assert_eq!(factor(&[0.0; 100], &[1.0; 100], 0.001), None);
    }
}
