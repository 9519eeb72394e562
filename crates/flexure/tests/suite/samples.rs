//! The septic spline: interpolation, smoothness, rest at the ends, uniqueness, order of convergence, bad input.
#![expect(clippy::float_cmp, reason = "exactness where it is promised")]

use flexure::core::linalg::Vector;
use flexure::core::reference::{PointToPoint, Reference, Sine, SmoothStart, Smoothstep};
use flexure::core::scalar::{Dual, Jet};
use flexure::references::{Samples, SamplesError};

/// Unevenly spaced instants [s]; neighbouring intervals differ by up to a factor of 8.
const TIMES: [f64; 9] = [-0.5, 0.0, 0.1, 0.9, 1.3, 1.5, 2.3, 2.5, 3.0];

/// Rough on purpose: no smooth function behind it.
fn rough() -> Vec<(f64, Vector<f64, 2>)> {
    let q = [
        [0.3, 5.0],
        [0.9, 4.0],
        [-0.2, 4.1],
        [0.4, 6.0],
        [1.5, 6.2],
        [1.1, 5.5],
        [0.2, 5.0],
        [0.0, 5.3],
        [0.7, 5.1],
    ];
    TIMES.into_iter().zip(q.map(Vector)).collect()
}

fn spline<const N: usize>(samples: &[(f64, Vector<f64, N>)]) -> Samples<f64, N> {
    Samples::new(samples).expect("good samples")
}

fn sampled<const N: usize>(
    q_d: &impl Reference<f64, N>,
    times: impl IntoIterator<Item = f64>,
) -> Samples<f64, N> {
    spline(&times.into_iter().map(|t| (t, q_d.on(t))).collect::<Vec<_>>())
}

fn assert_close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a:e} and {b:e} differ by {:e}", (a - b).abs());
}

#[test]
fn passes_through_every_sample() {
    let samples = rough();
    let q_d = spline(&samples);
    for (t, q) in samples {
        for i in 0..2 {
            // The constant of the segment that starts there; at the end a sum of terms below 1e2.
            assert_close(q_d.on(t)[i], q[i], 2e-14, &format!("at {t} s"));
        }
    }
    assert_eq!((q_d.start(), q_d.end()), (-0.5, 3.0));
}

#[test]
fn six_derivatives_are_continuous_at_inner_samples() {
    let q_d = spline(&rough());
    for t in &TIMES[1..8] {
        // Two ulps at 2.5 s: the changes over it are below rounding.
        let step = 2.0f64.powi(-50);
        let (left, right) = (q_d.at::<8>(t - step), q_d.at::<8>(t + step));
        for i in 0..2 {
            for k in 0..7 {
                let (a, b) = (left[i].derivative(k), right[i].derivative(k));
                // Derivative k of a polynomial of size 10 on an interval of 0.1 s is known to some 1e-13 k! (10 / 0.1)ᵏ
                // at the worst; that of this spline is k! 10ᵏ⁺¹ or so.
                let scale: f64 = (1..=k).map(|j| 10.0 * j as f64).product();
                assert_close(a, b, 1e-11 * scale, &format!("derivative {k} at {t} s"));
            }
            let jump = left[i].derivative(7) - right[i].derivative(7);
            assert!(jump.abs() > 1e3, "derivative 7 jumps by {jump:e} at {t} s: not a spline");
        }
    }
}

#[test]
fn rests_at_both_ends_and_beyond() {
    let samples = rough();
    let q_d = spline(&samples);
    for (t, q, sign) in [(-0.5, samples[0].1, -1.0), (3.0, samples[8].1, 1.0)] {
        let (end, held) = (q_d.at::<6>(t), q_d.at::<6>(t + sign * 0.7));
        for i in 0..2 {
            for k in 1..4 {
                // Sums of terms below k! 1e3, on intervals of 0.5 s.
                assert_close(end[i].derivative(k), 0.0, 1e-10, &format!("derivative {k} at {t} s"));
            }
            assert!(end[i].derivative(4).abs() > 1.0, "at rest to order 4 by accident");
            assert_close(held[i].derivative(0), q[i], 2e-14, "held position");
            assert_eq!(held[i], Jet::value(held[i].coefficient(0)), "moves beyond its end");
        }
    }
}

#[test]
fn two_samples_are_the_septic_motion() {
    let motion = PointToPoint {
        from: Vector([0.3, -0.8]),
        to: Vector([-1.1, 0.7]),
        start: 0.5,
        duration: 2.0,
        step: Smoothstep::Septic,
    };
    let q_d = spline(&[(0.5, motion.from), (2.5, motion.to)]);
    reproduces(&q_d, &motion, 1e-12);
}

/// A septic polynomial at rest at both ends is its own spline, on any knots.
#[test]
fn reproduces_septic_motions_on_uneven_samples() {
    let motion = PointToPoint {
        from: Vector([0.3, -0.8]),
        to: Vector([-1.1, 0.7]),
        start: -0.5,
        duration: 3.5,
        step: Smoothstep::Septic,
    };
    // Rounding of samples of size 1, 0.1 s apart, in derivative 4: 840 ε / 1e-4 = 2e-9, spread by the system.
    reproduces(&sampled(&motion, TIMES), &motion, 2e-8);
}

fn reproduces(q_d: &Samples<f64, 2>, motion: &PointToPoint<f64, 2>, tolerance: f64) {
    for step in -20..80 {
        let t = 0.05 * f64::from(step) + 0.01;
        let (a, b) = (q_d.at::<5>(t), motion.at::<5>(t));
        for i in 0..2 {
            for k in 0..5 {
                let what = format!("derivative {k} at {t} s");
                assert_close(a[i].derivative(k), b[i].derivative(k), tolerance, &what);
            }
        }
    }
}

/// Least ∫ |q⁗|²: with a variation that vanishes at the samples and rests at the ends, no first-order change.
#[test]
fn has_the_least_integral_of_the_fourth_derivative() {
    let q_d = spline(&rough());
    // The variation: the spline through other samples on finer knots, zero at the coarse ones.
    let mut fine: Vec<(f64, Vector<f64, 2>)> = TIMES.map(|t| (t, Vector([0.0, 0.0]))).to_vec();
    fine.insert(5, (1.42, Vector([0.01, -0.02])));
    fine.insert(3, (0.4, Vector([0.3, 0.1])));
    let variation = spline(&fine);
    let (mut product, mut size) = ([0.0; 2], [0.0; 2]);
    for pair in fine.windows(2) {
        for (node, weight) in GAUSS {
            let t = pair[0].0 + (pair[1].0 - pair[0].0) * node;
            let (a, b) = (q_d.at::<5>(t), variation.at::<5>(t));
            for i in 0..2 {
                let term = weight * (pair[1].0 - pair[0].0) * a[i].derivative(4) * b[i].derivative(4);
                product[i] += term;
                size[i] += term.abs();
            }
        }
    }
    for i in 0..2 {
        assert!(size[i] > 1e3);
        // Gauss's rule with 4 nodes is exact to degree 7, the product is of degree 6. Its factors carry 1e-11.
        assert!(product[i].abs() < 1e-9 * size[i], "{:e} of {:e}", product[i], size[i]);
    }
}

/// Gauss–Legendre nodes and weights on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Errors in position and in the fourth derivative, over the whole time, of the spline through `intervals` + 1 samples.
fn errors(q_d: &impl Reference<f64, 1>, from: f64, to: f64, intervals: i32, within: [f64; 2]) -> [f64; 2] {
    let time = |x: f64| from + (to - from) * x;
    let samples = sampled(q_d, (0..=intervals).map(|i| time(f64::from(i) / f64::from(intervals))));
    let mut worst = [0.0f64; 2];
    for i in 0..=10 * intervals {
        let t = time(f64::from(i) / f64::from(10 * intervals));
        if t < within[0] || t > within[1] {
            continue;
        }
        let (a, b) = (samples.at::<5>(t)[0], q_d.at::<5>(t)[0]);
        for (worst, k) in worst.iter_mut().zip([0, 4]) {
            *worst = worst.max((a.derivative(k) - b.derivative(k)).abs());
        }
    }
    worst
}

/// Between grids that differ by a factor of 2.
fn shows_orders(coarse: [f64; 2], fine: [f64; 2]) {
    let orders = [(coarse[0] / fine[0]).log2(), (coarse[1] / fine[1]).log2()];
    println!("errors {coarse:?}, {fine:?}: orders {orders:.2?}");
    // Asymptotic orders, seen on finite grids.
    assert!((7.5..8.6).contains(&orders[0]), "position converges with order {}", orders[0]);
    assert!((3.7..4.3).contains(&orders[1]), "the fourth derivative converges with order {}", orders[1]);
}

/// sin⁴ t = (3 − 4 cos 2t + cos 4t) / 8, at rest at every multiple of π: order 8 up to the very ends.
struct Sin4;

impl Reference<f64, 1> for Sin4 {
    fn on<T>(&self, t: T) -> Vector<T, 1>
    where
        T: flexure::core::scalar::Over<f64> + flexure::core::scalar::Piecewise,
    {
        Vector([t.sin().square().square()])
    }
}

#[test]
fn converges_with_order_eight_and_four() {
    let pi = core::f64::consts::PI;
    let errors = |n| errors(&Sin4, 0.0, pi, n, [0.0, pi]);
    shows_orders(errors(16), errors(32));
}

/// sin t starts and ends in full motion: what the forced rest spoils decays by 0.54 a sample, and more than 60 samples
/// into the interior, 1e-17, the orders show.
#[test]
fn rest_at_the_ends_is_forgotten_in_the_interior() {
    let sine = Sine { amplitude: Vector([1.0]), frequency: Vector([1.0]), ..Sine::ZERO };
    let errors = |n| errors(&sine, -40.0, 40.0, n, [-2.0, 2.0]);
    shows_orders(errors(128), errors(256));
}

/// Ringing at the ends: halfway between samples, the error falls by the largest root below 1 of the Euler–Frobenius
/// polynomial of degree 6, 0.5353, from one interval to the next.
#[test]
fn a_hard_stop_rings_as_documented() {
    let ramp = |t: f64| (t, Vector([t]));
    let q_d = spline(&(0..=60).map(|i| ramp(f64::from(i))).collect::<Vec<_>>());
    let error = |i: i32| (q_d.on(f64::from(i) + 0.5)[0] - f64::from(i) - 0.5).abs();
    for i in 10..20 {
        // The next root, 0.1226, is forgotten by (0.1226 / 0.5353)¹⁰ = 4e-7; rounding is 1e-9 of an error of 1e-6.
        assert_close(error(i + 1) / error(i), 0.535_280, 1e-5, &format!("ratio at {i}"));
    }
}

#[test]
fn searching_finds_what_choosing_finds() {
    let q_d = spline(&rough());
    let between = (-30..70).map(|i| 0.05 * f64::from(i));
    for t in between.chain(TIMES).chain(TIMES.map(f64::next_down)).chain(TIMES.map(f64::next_up)) {
        assert_eq!(q_d.at::<6>(t), q_d.on(Jet::variable(t)), "at {t} s");
        assert_eq!(q_d.at::<1>(t).map(|jet| jet.coefficient(0)), q_d.on(t), "at {t} s");
    }
    assert!(q_d.at::<3>(f64::NAN)[0].coefficient(0).is_nan());
    assert!(q_d.on(f64::NAN)[0].is_nan());
}

#[test]
fn dual_time_differentiates_jets() {
    let q_d = spline(&rough());
    for i in -30..70 {
        let t = 0.05 * f64::from(i) + 0.01;
        let dual = q_d.on(Dual::<Jet<f64, 8>, 1>::variable(Jet::variable(t), 0));
        for joint in 0..2 {
            for k in 0..7 {
                let (a, b) = (dual[joint].gradient[0].derivative(k), dual[joint].value.derivative(k + 1));
                // Both by Horner, on summands up to 1e3 times the result.
                let scale: f64 = (1..=k + 1).map(|j| 10.0 * j as f64).product();
                assert_close(a, b, 1e-11 * scale, &format!("derivative {} at {t} s", k + 1));
            }
        }
    }
}

/// A change of the unit of time changes nothing else.
#[test]
fn does_not_depend_on_units() {
    let samples = rough();
    let q_d = spline(&samples);
    let scaled = spline(&samples.iter().map(|&(t, q)| (t / 1024.0, q)).collect::<Vec<_>>());
    for i in -30..70 {
        let t = 0.05 * f64::from(i);
        for joint in 0..2 {
            let (a, b) = (q_d.at::<8>(t)[joint], scaled.at::<8>(t / 1024.0)[joint]);
            for k in 0..8 {
                let unit = 1024.0f64.powi(i32::try_from(k).expect("small"));
                // Powers of two scale without rounding.
                assert_eq!(a.coefficient(k) * unit, b.coefficient(k), "coefficient {k} at {t} s");
            }
        }
    }
}

#[test]
fn joins_from_rest_elsewhere() {
    let q_d = SmoothStart::from_rest(Vector([0.0, 5.0]), 1.0, spline(&rough()));
    assert_eq!(q_d.at::<5>(0.0), Vector([0.0, 5.0]).lift());
    assert_eq!(q_d.at::<5>(1.7), q_d.then.at(1.7));
}

#[test]
fn bad_samples_are_refused() {
    let at = |t: f64| (t, Vector([1.0, 2.0]));
    let refuse = |samples: &[(f64, Vector<f64, 2>)]| Samples::new(samples).expect_err("bad samples");
    assert_eq!(refuse(&[]), SamplesError::TooFew { found: 0 });
    assert_eq!(refuse(&[at(0.0)]), SamplesError::TooFew { found: 1 });
    assert_eq!(
        refuse(&[at(0.0), at(1.0), at(1.0)]),
        SamplesError::NotIncreasing { sample: 2, time: 1.0, previous: 1.0 }
    );
    assert_eq!(
        refuse(&[at(0.0), at(-1.0)]),
        SamplesError::NotIncreasing { sample: 1, time: -1.0, previous: 0.0 }
    );
    assert_eq!(
        refuse(&[at(0.0), at(f64::INFINITY)]),
        SamplesError::TimeNotFinite { sample: 1, time: f64::INFINITY }
    );
    assert!(matches!(refuse(&[at(f64::NAN), at(1.0)]), SamplesError::TimeNotFinite { sample: 0, .. }));
    assert_eq!(
        refuse(&[at(0.0), (1.0, Vector([0.0, f64::NEG_INFINITY]))]),
        SamplesError::PositionNotFinite { sample: 1, joint: 1, position: f64::NEG_INFINITY }
    );
    assert_eq!(
        refuse(&[at(0.0), at(1e-60), (3e-60, Vector([1.0, 7.0])), at(1.0)]),
        SamplesError::Overflow { sample: 0, width: 1e-60 }
    );
    let message = refuse(&[at(0.0), at(1.0), at(0.5)]).to_string();
    assert_eq!(message, "time of sample 2 is 0.5 s, must be > 1 s, the time of the sample before it");
}
