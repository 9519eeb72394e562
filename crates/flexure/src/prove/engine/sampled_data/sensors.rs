//! What a law sees of a motion at control instants.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::spread::Spread;

/// From motions to what the law is given: readings of positions that are off by something, and velocities.
#[derive(Clone, Debug, Default)]
pub struct Sensors {
    /// How far readings of link, then of motor positions are off at most, in rad; empty where they are exact.
    pub off: Vec<f64>,
    /// What makes velocities of readings; none for true velocities.
    pub filter: Option<Filter>,
}

/// v_k = a₁ v_{k−1} + a₂ v_{k−2} + b₀ (q_k − q_{k−1}) + b₁ (q_{k−1} − q_{k−2}), which remembers two numbers of each position q:
///
/// w₁ = −b₀ q + b₁ (q − q⁻) + a₁ v + a₂ v⁻ and w₂ = −b₁ q + a₂ v, so that v⁺ = b₀ q⁺ + w₁, w₁⁺ = (b₁ − b₀) q⁺ + a₁ v⁺ + w₂, w₂⁺ = −b₁ q⁺ + a₂ v⁺.
#[derive(Clone, Copy, Debug)]
pub struct Filter {
    /// a₁, a₂.
    pub feedback: [Interval; 2],
    /// b₀, b₁ [1/s].
    pub forward: [Interval; 2],
}

impl Sensors {
    /// Numbers that are remembered from one instant to the next, of `n` joints.
    pub fn remembered(&self, n: usize) -> usize {
        if self.filter.is_some() { 4 * n } else { 0 }
    }

    /// What is remembered when a loop begins at the motion (q_l, q_m, q̇_l, q̇_m), as after a long time at its velocity [rad/s] where it is, control periods
    /// of `period` in s.
    pub fn start(&self, motion: &[Interval], period: Interval) -> Vec<Interval> {
        let Some(Filter { feedback: [a_1, a_2], forward: [b_0, b_1] }) = self.filter else {
            return Vec::new();
        };
        let (positions, velocities) = motion.split_at(motion.len() / 2);
        let both = || positions.iter().zip(velocities);
        let first = both().map(|(&q, &v)| (a_1 + a_2 + b_1 * period) * v - b_0 * q);
        first.chain(both().map(|(&q, &v)| a_2 * v - b_1 * q)).collect()
    }

    /// What the law is given at an instant, and what is remembered after it. `state` has motions, what is remembered, then anything; the reading of position i
    /// is off by column `from` + i.
    pub fn seen(&self, state: &Spread, n: usize, from: usize) -> [Spread; 2] {
        let half = 2 * n;
        let readings = Spread {
            center: state.center[..half].to_vec(),
            deviations: Dense::from_fn(half, state.deviations.columns(), |i, j| {
                let off = j == from + i && !self.off.is_empty();
                if off { Interval::ONE } else { state.deviations[(i, j)] }
            }),
        };
        let part = |first: usize| state.part(first, half);
        let Some(Filter { feedback: [a_1, a_2], forward: [b_0, b_1] }) = self.filter else {
            return [readings.followed_by(&part(half)), state.part(0, 0)];
        };
        let (one, zero) = (Interval::ONE, Interval::ZERO);
        let [w_1, w_2] = [part(2 * half), part(3 * half)];
        let velocities = Spread::sum(&[(b_0, &readings), (one, &w_1)]);
        let first = Spread::sum(&[(b_1 - b_0, &readings), (a_1, &velocities), (one, &w_2)]);
        let second = Spread::sum(&[(zero - b_1, &readings), (a_2, &velocities)]);
        [readings.followed_by(&velocities), first.followed_by(&second)]
    }
}

#[cfg(test)]
mod tests {
    use flexure_core::estimate::{Estimator, FilteredDifference, LowPass};
    use flexure_core::linalg::Vector;
    use flexure_core::model::{Fjr, Motion};
    use flexure_core::robots::Pendulum;
    use flexure_core::scalar::Interval;

    use super::{Filter, Sensors};
    use crate::linalg::Dense;
    use crate::prove::engine::sampled_data::spread::Spread;

    /// The loop's own filter, through readings that jump: the same velocities to rounding.
    #[test]
    fn velocities_are_those_of_the_estimator() {
        let period = 0.002;
        for filter in [LowPass::second_order(40.0, 0.9, period), LowPass::first_order(16.0, period)] {
            let filter = filter.unwrap();
            let mut theirs = FilteredDifference::<f64, 1>::new(filter);
            let [feedback, forward] = filter.coefficients().map(|both| both.map(Interval::point));
            let sensors = Sensors { off: vec![0.0; 2], filter: Some(Filter { feedback, forward }) };
            let at = |q_l: f64, q_m: f64| [q_l, q_m, 0.7, -0.4];
            let begin = at(0.3, 0.1);
            theirs.start(&Motion {
                q_l: Vector([0.3]),
                q_m: Vector([0.1]),
                v_l: Vector([0.7]),
                v_m: Vector([-0.4]),
            });
            let mut remembered = sensors.start(&begin.map(Interval::point), Interval::point(period));
            // It knows nothing of the robot.
            let one = Vector([1.0]);
            let robot = Fjr {
                links: Pendulum { inertia: 1.0, weight_moment: 0.0 },
                motor_inertia: one,
                stiffness: one,
                link_damping: one,
                motor_damping: one,
            };
            for k in 0..40 {
                let (q_l, q_m) = ((0.1 * f64::from(k)).sin(), (0.3 * f64::from(k)).cos());
                let center = [at(q_l, q_m).map(Interval::point).to_vec(), remembered.clone()].concat();
                let deviations = Dense::from_fn(center.len(), 2, |_, _| Interval::point(0.0));
                let [seen, after] = sensors.seen(&Spread { center, deviations }, 1, 0);
                let expected = theirs.update(&robot, &Vector([q_l]), &Vector([q_m]), &Vector([0.0]));
                for (found, expected) in seen.center[2..].iter().zip([expected.v_l[0], expected.v_m[0]]) {
                    // b₀ is 1,000 1/s at most, rounded 40 times.
                    assert!((found.midpoint() - expected).abs() < 1e-9, "{k}: {found:?} {expected}");
                }
                remembered = after.center;
            }
        }
    }
}
