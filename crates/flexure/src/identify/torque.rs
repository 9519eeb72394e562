//! The torque of a log as the motors feel it: held from sample to sample, and later by an offset.

/// The torques of a control period that begins at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    /// Mean over the period [N m].
    pub mean: f64,
    /// Its derivative by the offset [N m/s].
    pub mean_slope: f64,
    /// What the motor position gets at the end beyond what the mean gives it, times the inertia [kg m² rad].
    pub moment: f64,
    /// Its derivative by the offset [kg m² rad/s].
    pub moment_slope: f64,
}

/// The torque of joint `joint` of `joints` over the period after sample `k`, where `torques` (samples × joints) act `offset` s
/// later than they are logged. Before the first and after the last sample the torque is that sample's.
pub(crate) fn held(torques: &[f64], joints: usize, joint: usize, k: usize, offset: f64, period: f64) -> Held {
    let periods = (offset / period).floor();
    let share = offset / period - periods;
    let last = (torques.len() / joints) as f64 - 1.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the samples")]
    let at = |back: f64| torques[(k as f64 - back).clamp(0.0, last) as usize * joints + joint];
    let (before, after) = (at(periods + 1.0), at(periods));
    let jump = before - after;
    Held {
        mean: after + share * jump,
        mean_slope: jump / period,
        moment: 0.5 * jump * share * (1.0 - share) * period * period,
        moment_slope: 0.5 * jump * (1.0 - 2.0 * share) * period,
    }
}

#[cfg(test)]
mod tests {
    use super::held;

    /// A double integrator under two pieces of torque, in closed form.
    #[test]
    fn pieces_are_exact_in_speed_and_position() {
        let (torques, h) = ([1.0, -2.0, 5.0, 0.5], 1e-3);
        for offset in [0.0, 0.3e-3, 1e-3, 1.7e-3, -0.4e-3] {
            let held = held(&torques, 1, 0, 2, offset, h);
            let (mut v, mut q) = (0.0, 0.0);
            for i in 0..100_000 {
                let (t, dt) = (2.0 * h + (f64::from(i) + 0.5) * h / 1e5 - offset, h / 1e5);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 3")]
                let u = torques[(t / h).floor().clamp(0.0, 3.0) as usize];
                q += v * dt + 0.5 * u * dt * dt;
                v += u * dt;
            }
            assert!((held.mean * h - v).abs() < 1e-7, "{offset}: {} for {v}", held.mean * h);
            let position = 0.5 * held.mean * h * h + held.moment;
            assert!((position - q).abs() < 1e-10, "{offset}: {position} for {q}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        let (torques, h, by) = ([1.0, -2.0, 5.0, 0.5], 1e-3, 1e-9);
        let at = |offset| held(&torques, 1, 0, 2, offset, h);
        let (low, high) = (at(0.6e-3 - by), at(0.6e-3 + by));
        assert!(((high.mean - low.mean) / (2.0 * by) - at(0.6e-3).mean_slope).abs() < 1e-2);
        assert!(((high.moment - low.moment) / (2.0 * by) - at(0.6e-3).moment_slope).abs() < 1e-8);
    }
}
