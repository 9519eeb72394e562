//! The Fisher information that a log holds about a joint.
//!
//! Steady oscillation, torque logged exactly or with white noise, positions with the white noise of rounding, s²/12 for a count
//! of s. A line at ω with torque U moves the positions by G(iω) U, and a parameter θ shows in them as ∂G/∂θ U; friction as
//! −G S, S the line of the sign of the motor's speed. Torque noise of variance σ_u² a sample adds G G* σ_u² to the noise, so that
//! a log with much of it tells no more from better encoders.

use flexure_core::linalg::{Matrix, Vector};
use serde::Serialize;

use crate::excite::joint::{Joint, LINEAR};
use crate::linalg::Complex;

/// Parameters with the friction.
const ALL: usize = LINEAR + 1;

/// What is measured, and how well.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// One over the variance of the positions of links and motors [1/rad²]; 0 where there are no encoders.
    pub precision: [f64; 2],
    /// Variance of the torque [N² m²].
    pub torque: f64,
    /// Samples of the log.
    pub samples: f64,
}

/// What the Cramér–Rao bound leaves, three standard deviations each: no unbiased estimate from such a log has smaller ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorBars {
    /// Of the stiffness, over the stiffness.
    pub stiffness: f64,
    /// Of the motor inertia, over the inertia.
    pub motor_inertia: f64,
    /// Of the link damping [N m s/rad].
    pub link_damping: f64,
    /// Of the motor damping [N m s/rad].
    pub motor_damping: f64,
    /// Of the motor's Coulomb friction [N m].
    pub coulomb: f64,
}

/// What shows in the positions of link and motor for a unit of each parameter.
type Shows<const P: usize> = [[Complex; 2]; P];

/// Information about P parameters in one line.
fn information<const P: usize>(shows: &Shows<P>, gains: &[Complex; 2], noise: &Noise) -> Matrix<f64, P, P> {
    // x* D y
    let inner = |x: &[Complex; 2], y: &[Complex; 2]| {
        (0..2).fold(Complex::ZERO, |sum, side| {
            sum + (x[side].conjugate() * y[side]).scaled(noise.precision[side])
        })
    };
    // (D⁻¹ + σ² g g*)⁻¹ = D − D g g* D σ² / (1 + σ² g* D g), by Sherman and Morrison.
    let drowned = noise.torque / (1.0 + noise.torque * inner(gains, gains).re);
    Matrix::from_fn(|a, b| {
        let through = inner(&shows[a], gains) * inner(gains, &shows[b]);
        0.5 * noise.samples * (inner(&shows[a], &shows[b]) - through.scaled(drowned)).re
    })
}

/// The torque phasor of a line with a link amplitude of 1 rad.
fn torque(joint: &Joint, omega: f64) -> Complex {
    Complex::real(1.0) / joint.gains(omega)[0]
}

/// How stiffness, inertia and dampings of `joint` show in a line with motor torque `torque`.
fn linear(joint: &Joint, omega: f64, torque: Complex) -> Shows<LINEAR> {
    let response = joint.response(omega);
    std::array::from_fn(|parameter| {
        response.map(|[re, im]| Complex { re: re.gradient[parameter], im: im.gradient[parameter] } * torque)
    })
}

/// Information about the linear parameters of a joint that is `real`, in a line for which the reference of a joint that was `assumed`
/// has a link amplitude of 1 rad.
pub(super) fn of_line(
    real: &Joint,
    assumed: &Joint,
    omega: f64,
    noise: &Noise,
) -> Matrix<f64, LINEAR, LINEAR> {
    information(&linear(real, omega, torque(assumed, omega)), &real.gains(omega), noise)
}

/// A line as it is logged.
pub(super) struct Logged {
    /// [rad/s].
    pub omega: f64,
    /// Of the link, with its phase \[rad\].
    pub amplitude: Complex,
    /// Of the sign of the motor's speed.
    pub sign: Complex,
}

/// Information about all parameters in a log of these lines.
fn total(joint: &Joint, lines: &[Logged], noise: &Noise) -> Matrix<f64, ALL, ALL> {
    lines.iter().fold(Matrix::ZERO, |sum, Logged { omega, amplitude, sign }| {
        let gains = joint.gains(*omega);
        let linear = linear(joint, *omega, torque(joint, *omega) * *amplitude);
        let shows: Shows<ALL> =
            std::array::from_fn(|p| if p < LINEAR { linear[p] } else { gains.map(|gain| -(gain * *sign)) });
        sum + information(&shows, &gains, noise)
    })
}

/// Standard deviations in an error bar, as in those of identified numbers.
const SIGMAS: f64 = 3.0;

/// What a log of these lines leaves unknown of `joint`; infinite where it tells nothing.
pub(super) fn error_bars(joint: &Joint, lines: &[Logged], noise: &Noise) -> ErrorBars {
    let factor = total(joint, lines, noise).ldl();
    let known = factor.pivots().iter().all(|pivot| pivot > 0.0);
    let [stiffness, motor_inertia, link_damping, motor_damping, coulomb] = std::array::from_fn(|p| {
        let unit = Vector::<f64, ALL>::from_fn(|i| f64::from(u8::from(i == p)));
        if known { SIGMAS * factor.solve(&unit)[p].sqrt() } else { f64::INFINITY }
    });
    ErrorBars { stiffness, motor_inertia, link_damping, motor_damping, coulomb }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{ALL, Logged, Noise, torque, total};
    use crate::excite::joint::Joint;
    use crate::linalg::Complex;

    const JOINT: Joint = Joint {
        link_inertia: 0.9,
        motor_inertia: 0.6,
        stiffness: 2000.0,
        link_damping: 0.5,
        motor_damping: 1.0,
    };

    fn lines(period: f64) -> Vec<Logged> {
        let phasor = |size: f64, angle: f64| Complex { re: size * angle.cos(), im: size * angle.sin() };
        let line = |k: usize| Logged {
            omega: TAU * k as f64 / period,
            amplitude: phasor(0.1 / k as f64, k as f64),
            sign: phasor(0.5, 2.0 * k as f64),
        };
        [1, 3, 8, 13].map(line).into()
    }

    /// The information of a log sampled over a period is the sum over the samples of products of slopes, over the variance.
    #[test]
    fn lines_have_the_information_of_their_samples() {
        const SAMPLES: usize = 500;
        const STEP: f64 = 1e-5;
        let (period, precision) = (1.0, [4e8, 9e8]);
        let noise = Noise { precision, torque: 0.0, samples: SAMPLES as f64 };
        let lines = lines(period);
        let position = |joint: &Joint, friction: f64, side: usize, sample: usize| {
            lines.iter().fold(0.0, |sum, line| {
                let drive = torque(&JOINT, line.omega) * line.amplitude - line.sign.scaled(friction);
                let angle = line.omega * period * sample as f64 / SAMPLES as f64;
                sum + (joint.gains(line.omega)[side] * drive * Complex { re: angle.cos(), im: angle.sin() })
                    .im
            })
        };
        let slope = |parameter: usize, side: usize, sample: usize| {
            let at = |step: f64| {
                position(&JOINT.moved(parameter, step), if parameter == 4 { step } else { 0.0 }, side, sample)
            };
            (at(STEP) - at(-STEP)) / (2.0 * STEP)
        };
        let slopes: Vec<[[f64; 2]; ALL]> = (0..SAMPLES)
            .map(|sample| std::array::from_fn(|p| std::array::from_fn(|side| slope(p, side, sample))))
            .collect();
        let found = total(&JOINT, &lines, &noise);
        for a in 0..ALL {
            for b in 0..ALL {
                let products = slopes
                    .iter()
                    .map(|slope| (0..2).map(|s| precision[s] * slope[a][s] * slope[b][s]).sum::<f64>());
                let (sum, size) = (products.sum::<f64>(), (found[(a, a)] * found[(b, b)]).sqrt());
                assert!((found[(a, b)] - sum).abs() < 1e-6 * size, "{a} {b}: {} and {sum}", found[(a, b)]);
            }
        }
    }

    /// Where the torque is noisy and only motors are measured, perfect encoders tell no more than ½ N |∂ ln G|² |U|² / σ².
    #[test]
    fn noise_of_the_torque_bounds_what_encoders_tell() {
        let with = |precision: f64| Noise { precision: [0.0, precision], torque: 1e-2, samples: 1000.0 };
        let lines = lines(1.0);
        let bound = lines.iter().fold(0.0, |sum, line| {
            let [re, im] = JOINT.response(line.omega)[1].map(|part| (part.value, part.gradient[0]));
            let slope = Complex { re: re.1, im: im.1 } / Complex { re: re.0, im: im.0 };
            let drive = torque(&JOINT, line.omega) * line.amplitude;
            sum + 0.5 * 1000.0 * (slope.abs() * drive.abs()).powi(2) / 1e-2
        });
        let perfect = total(&JOINT, &lines, &with(1e16))[(0, 0)];
        assert!((perfect / bound - 1.0).abs() < 1e-3, "{perfect} and {bound}");
        assert!(total(&JOINT, &lines, &with(1e8))[(0, 0)] < perfect);
    }
}
