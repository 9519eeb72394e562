//! What encoders add to positions, and what they hide.

use crate::logs::Log;
use crate::logs::smooth::{REACH, rates, rms, smoothed, whiteness, window};

use super::parameters::Parameter;

/// Per joint the white noise of the encoders of link and motor, infinite where there is none \[rad\].
pub(crate) fn position_noise(logs: &[Log], n: usize) -> Vec<[f64; 2]> {
    let of = |signal: Option<&Vec<f64>>, i: usize| {
        signal.map_or(f64::INFINITY, |signal| whiteness(signal, n, i).max(1e-9))
    };
    (0..n).map(|i| [of(logs[0].q_l.as_ref(), i), of(logs[0].q_m.as_ref(), i)]).collect()
}

/// Part of what a regression on rounded deflections would be off by that a stiffness may be off by: those of simulated springs that bend
/// by 0.2 to 0.6 counts were up to an eighth of it off.
const HIDDEN: f64 = 1.0 / 6.0;

/// Part of what the encoders' noise would make of the spring's torque that may be taken for damping or friction of either side: those of
/// simulated arms were up to a twenty-fifth of it off.
const HIDDEN_TORQUE: f64 = 1.0 / 20.0;

/// What encoders of both sides may hide of a joint.
///
/// Where a spring bends by less than a few counts, what is rounded goes with how it bends and is no white noise. A regression on such
/// deflections is off by the mean square of the noise over that of the deflections without it (Sheppard, *Proc. London Math. Soc.* 29, 1897);
/// predictions, which know what the torques do, by [less](HIDDEN). What is rounded where joints turn back is no white noise either, and
/// the dampings and frictions of both sides, whose sums are known well, are told apart by a [small torque](HIDDEN_TORQUE) of the spring.
pub(crate) struct Hidden {
    /// Noise of the deflection of the spring \[rad\].
    noise: f64,
    /// Deflection, root mean square \[rad\].
    bent: f64,
    /// Root mean square of the link's velocity [rad/s].
    speed: f64,
}

impl Hidden {
    /// Joint by joint, of encoders with `noise` \[rad\]; none where links are not seen.
    pub fn all(logs: &[Log], noise: &[[f64; 2]]) -> Option<Vec<Self>> {
        let sides: Vec<_> = logs
            .iter()
            .map(|log| Some((log, log.q_l.as_ref()?, log.q_m.as_ref()?)))
            .collect::<Option<_>>()?;
        let samples = logs.iter().map(Log::samples).sum::<usize>() as f64;
        let joint = |(i, [link, motor]): (usize, &[f64; 2])| {
            let (mut bent, mut speed) = (0.0, 0.0);
            for &(log, q_l, q_m) in &sides {
                let deflection: Vec<f64> = q_m.iter().zip(q_l).map(|(q_m, q_l)| q_m - q_l).collect();
                let [v, _] = rates(&smoothed(q_l, log.joints, i, &window(REACH, log.period)), log.period);
                bent += rms(&deflection, log.joints, i).powi(2) * log.samples() as f64;
                speed += rms(&v, 1, 0).powi(2) * log.samples() as f64;
            }
            Self { noise: link.hypot(*motor), bent: (bent / samples).sqrt(), speed: (speed / samples).sqrt() }
        };
        Some(noise.iter().enumerate().map(joint).collect())
    }

    /// Of the stiffness, as a part of it.
    pub fn stiffness(&self) -> f64 {
        // Of what is measured the noise is part.
        let seen = self.bent.powi(2) - self.noise.powi(2);
        HIDDEN * self.noise.powi(2) / seen.max(f64::MIN_POSITIVE)
    }

    /// Of the dampings and frictions of a joint whose numbers are given, as parts of them.
    pub fn sides(&self, joint: &[f64; Parameter::COUNT]) -> [(Parameter, f64); 4] {
        use Parameter::{LinkDamping, LinkFriction, MotorDamping, MotorFriction, Stiffness};
        let torque = HIDDEN_TORQUE * joint[Stiffness.place()] * self.noise;
        [(LinkDamping, self.speed), (MotorDamping, self.speed), (LinkFriction, 1.0), (MotorFriction, 1.0)]
            .map(|(parameter, speed)| {
                (parameter, torque / (joint[parameter.place()] * speed).max(f64::MIN_POSITIVE))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::{HIDDEN, HIDDEN_TORQUE, Hidden, Log, position_noise};

    /// Positions that are rounded to counts, behind a spring that bends by a sine of `counts`: their noise is that of rounding,
    /// 1/12 of a squared count, and hides stiffness as the mean squares say.
    #[test]
    fn springs_that_hardly_bend_are_hidden() {
        let count = 5e-5;
        let log = |counts: f64| {
            let rounded = |x: f64| count * (x / count).round();
            let link = |t: f64| 0.05 * (1.7 * t).sin() + 0.02 * (5.3 * t).cos();
            let times = || (0..20_000).map(|k| 1e-3 * f64::from(k));
            let q_l = times().map(|t| rounded(link(t))).collect();
            let q_m = times().map(|t| rounded(link(t) + counts * count * (11.0 * t).sin())).collect();
            let name = "rounded".to_owned();
            Log {
                name,
                period: 1e-3,
                joints: 1,
                q_l: Some(q_l),
                q_m: Some(q_m),
                dq_l: None,
                dq_m: None,
                u_m: vec![0.0; 20_000],
            }
        };
        for counts in [3.0, 30.0] {
            let logs = [log(counts)];
            let noise = position_noise(&logs, 1);
            for side in noise[0] {
                assert!((side / count * 12.0_f64.sqrt() - 1.0).abs() < 0.1, "{side}");
            }
            // The mean square of what bends: half the amplitude's.
            let bent = 0.5 * counts * counts;
            let hidden = &Hidden::all(&logs, &noise).unwrap()[0];
            let part = hidden.stiffness();
            assert!((part / (HIDDEN / 6.0 / bent) - 1.0).abs() < 0.2, "{counts}: {part}");
            // Sides are off by one torque, as parts the less the larger they are.
            let speed = (0.5 * ((0.05_f64 * 1.7).powi(2) + (0.02_f64 * 5.3).powi(2))).sqrt();
            let torque = HIDDEN_TORQUE * 1000.0 * count / 6.0_f64.sqrt();
            let sides = hidden.sides(&[1000.0, 0.1, 0.4, 0.8, 1.0, 2.0]);
            for ((_, part), expected) in sides.iter().zip([0.4 * speed, 0.8 * speed, 1.0, 2.0]) {
                assert!((part * expected / torque - 1.0).abs() < 0.1, "{counts}: {sides:?}");
            }
        }
        let motors = [Log { q_l: None, ..log(0.1) }];
        assert!(Hidden::all(&motors, &position_noise(&motors, 1)).is_none());
    }
}
