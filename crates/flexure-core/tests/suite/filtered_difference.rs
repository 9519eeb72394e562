//! Filtered differences: the response in closed form, exact on constant velocities, the delay of the low pass on constant
//! accelerations.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times become counts of periods"
)]

use core::f64::consts::{PI, SQRT_2, TAU};

use flexure_core::estimate::{Estimator, FilteredDifference, LowPass};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;

use crate::common::close;
use crate::common::plant::plausible_arm;

/// What the second joint's link velocity comes out as for positions `q(t)` in rad at t = kT, k = 0, 1, …
fn velocities(filter: LowPass<f64>, period: f64, count: u32, q: impl Fn(f64) -> f64) -> Vec<f64> {
    let (arm, mut estimator) = (plausible_arm(), FilteredDifference::new(filter));
    (0..count)
        .map(|k| {
            let at = Vector([0.5, q(f64::from(k) * period)]);
            let x = estimator.update(&arm, &at, &at, &Vector::ZERO);
            assert_eq!((x.q_l, x.q_m, x.v_l), (at, at, x.v_m), "positions pass, both sides are filtered");
            x.v_l[1]
        })
        .collect()
}

/// Gain and phase at Ω/ω_c.
type Response = fn(f64) -> (f64, f64);

/// The filters under test with their low pass G(jΩ) in continuous time.
fn filters(cutoff: f64, period: f64) -> [(LowPass<f64>, Response); 2] {
    [
        (LowPass::first_order(cutoff, period).expect("a filter"), |x| {
            ((1.0 + x * x).sqrt().recip(), -x.atan())
        }),
        (LowPass::second_order(cutoff, 0.9, period).expect("a filter"), |x| {
            let (re, im) = (1.0 - x * x, 1.8 * x);
            (re.hypot(im).recip(), -im.atan2(re))
        }),
    ]
}

/// H(e^{jωT}) = j (2/T) tan(ωT/2) G(jΩ), Ω/ω_c = tan(ωT/2) / tan(ω_c T/2), at frequencies up to 0.9 of the highest.
#[test]
fn response_to_a_sine_is_the_closed_form() {
    for (cutoff, period) in [(40.0, 2e-3), (5.0, 1e-3), (200.0, 1e-3), (240.0, 2e-3)] {
        for (filter, low_pass) in filters(cutoff, period) {
            for share in [0.01, 0.1, 0.3, 0.6, 0.9] {
                let (w, half) = (share * PI / period, share * PI / 2.0);
                let (gain, phase) = low_pass(half.tan() / (PI * cutoff * period).tan());
                let gain = gain * 2.0 / period * half.tan();
                // 400 time constants leave nothing of the start; near half the sampling frequency poles are near −1.
                let settled = 400.0 / (TAU * cutoff * period) + 1000.0;
                let v = velocities(filter, period, settled as u32 + 20, |t| (w * t).sin());
                for (k, v) in v.iter().enumerate().skip(v.len() - 20) {
                    let expected = gain * (w * k as f64 * period + phase).cos();
                    assert!((v - expected).abs() < 1e-8 * gain, "{cutoff} Hz at {share}: {v} {expected}");
                }
            }
        }
    }
}

/// At the cut-off the low pass has the gain 1/√2, or 1 / (2 ζ), of the differentiation alone, which is 3e-3 of the true one for
/// the maker's filter.
#[test]
fn gain_at_the_cutoff() {
    let (cutoff, period) = (40.0, 2e-3);
    let half = PI * cutoff * period;
    let alone = 2.0 / period * half.tan();
    assert!((alone / (TAU * cutoff) - 1.0).abs() < 0.022);
    for ((filter, _), expected) in filters(cutoff, period).into_iter().zip([1.0 / SQRT_2, 1.0 / 1.8]) {
        let v = velocities(filter, period, 2000, |t| (TAU * cutoff * t).sin());
        // 40 Hz in 25 samples per two turns: the sum of squares over whole turns is exact.
        let rms = (v[1000..].iter().map(|v| v * v).sum::<f64>() / 1000.0).sqrt();
        assert!((rms * SQRT_2 / alone - expected).abs() < 1e-9, "{rms}");
    }
}

/// A constant velocity comes out as it is, from the first instant on if it was started there.
#[test]
fn constant_velocity_is_exact() {
    let period = 2e-3;
    for (filter, _) in filters(40.0, period) {
        let v = velocities(filter, period, 2000, |t| 1.0 - 3.0 * t);
        assert!((v[1999] + 3.0).abs() < 1e-10, "{}", v[1999]);
        let mut estimator = FilteredDifference::new(filter);
        let x = Motion {
            q_l: Vector([0.0, 1.0]),
            q_m: Vector([0.5, 2.0]),
            v_l: Vector([1.0, -3.0]),
            v_m: Vector([2.0, 0.1]),
        };
        estimator.start(&x);
        for k in 1..100 {
            let t = f64::from(k) * period;
            let (q_l, q_m) = (x.q_l + x.v_l.scaled(t), x.q_m + x.v_m.scaled(t));
            let estimate = estimator.update(&plausible_arm(), &q_l, &q_m, &Vector::ZERO);
            close(&estimate.v_l, &x.v_l, 1e-11);
            close(&estimate.v_m, &x.v_m, 1e-11);
        }
    }
}

/// Under a constant acceleration the velocity is late by τ = c (x / tan x) / ω_c, x = ω_c T/2, with c = 1 for the first and 2 ζ for the
/// second order: 7 ms for the maker's filter.
#[test]
fn delay_on_a_constant_acceleration() {
    let (cutoff, period) = (40.0, 2e-3);
    let x = PI * cutoff * period;
    for ((filter, _), c) in filters(cutoff, period).into_iter().zip([1.0, 1.8]) {
        let delay = c * x / x.tan() / (TAU * cutoff);
        let v = velocities(filter, period, 1000, |t| 0.5 * 7.0 * t * t);
        let t = 999.0 * period;
        assert!((v[999] - 7.0 * (t - delay)).abs() < 1e-8, "{} {}", v[999], 7.0 * (t - delay));
    }
}

#[test]
fn only_filters_that_exist() {
    let bad = [
        (0.0, 2e-3),
        (-40.0, 2e-3),
        (250.0, 2e-3),
        (1e9, 2e-3),
        (40.0, 0.0),
        (f64::NAN, 2e-3),
        (40.0, f64::INFINITY),
    ];
    for (cutoff, period) in bad {
        assert!(LowPass::first_order(cutoff, period).is_none(), "{cutoff} {period}");
        assert!(LowPass::second_order(cutoff, 0.9, period).is_none(), "{cutoff} {period}");
    }
    assert!(
        LowPass::second_order(40.0, 0.0, 2e-3).is_none()
            && LowPass::second_order(40.0, f64::NAN, 2e-3).is_none()
    );
}
