//! References that are joined from elsewhere.

use flexure_core::linalg::Vector;
use flexure_core::reference::{PointToPoint, Reference, SmoothStart, Smoothstep, Stop};
use flexure_core::scalar::Jet;

use super::{FROM, SINE, SMOOTH_START, assert_close, instants};

#[test]
fn smooth_start_leaves_from_rest() {
    for t in [-1e3, -0.1, 0.0] {
        // Exact: the step is τ⁵ times a polynomial.
        assert_eq!(SMOOTH_START.at::<5>(t), FROM.lift(), "at {t} s");
    }
}

#[test]
fn smooth_start_arrives_at_the_reference() {
    for t in [2.0, 2.0f64.next_up(), 3.7, 100.0] {
        // Exact: what is left to go is (1 − τ)⁵ times a polynomial, and 0 after the end.
        assert_eq!(SMOOTH_START.at::<5>(t), SINE.at(t), "at {t} s");
    }
    assert_eq!(SMOOTH_START.at::<9>(2.5), SINE.at(2.5));
}

#[test]
fn smooth_start_jumps_in_the_fifth_derivative_as_documented() {
    for t in [0.0, 2.0] {
        let (inside, outside) = (SMOOTH_START.at::<6>(t), SINE.at::<6>(t));
        for i in 0..2 {
            let outside = if t > 0.0 { outside[i].derivative(5) } else { 0.0 };
            let jump = 15120.0 * (SINE.on(t)[i] - FROM[i]) / 2.0f64.powi(5);
            // 50 operations on numbers below 1e3.
            assert_close(inside[i].derivative(5) - outside, jump, 1e-11, &format!("at {t} s, joint {i}"));
        }
    }
}

#[test]
fn smooth_start_obeys_leibniz() {
    for t in instants().filter(|t| (0.0..2.0).contains(t)) {
        let s = Smoothstep::Nonic.eval(Jet::<f64, 5>::variable(t).scaled_time(2.0));
        let (q_d, r) = (SMOOTH_START.at::<5>(t), SINE.at::<5>(t));
        for i in 0..2 {
            let expected = Jet::value(FROM[i]) + s * (r[i] - Jet::value(FROM[i]));
            for k in 0..5 {
                let tolerance = 100.0 * f64::EPSILON * expected.derivative(k).abs().max(100.0);
                let what = format!("at {t} s, joint {i}, derivative {k}");
                // Counting from the far end rounds otherwise than the formula, by ε of summands below 1e2.
                assert_close(q_d[i].derivative(k), expected.derivative(k), tolerance, &what);
            }
        }
    }
}

/// t ↦ t / duration on a jet.
trait ScaledTime {
    fn scaled_time(self, duration: f64) -> Self;
}

impl<const K: usize> ScaledTime for Jet<f64, K> {
    fn scaled_time(self, duration: f64) -> Self {
        self / Jet::value(duration)
    }
}

#[test]
fn smooth_start_to_a_set_point_is_the_nonic_motion() {
    let (from, to) = (Vector([0.3, -0.8]), Vector([-1.1, 0.7]));
    let start = SmoothStart::from_rest(from, 1.7, to);
    let motion = PointToPoint { from, to, start: 0.0, duration: 1.7, step: Smoothstep::Nonic };
    for t in instants() {
        assert_eq!(start.at::<6>(t), motion.at(t), "at {t} s");
    }
}

/// Accelerations and jerks of a link that swings carry a reference no farther than is said; what is small stays as it is.
#[test]
fn a_swinging_link_throws_no_reference() {
    let swinging = Stop {
        from: Vector([Jet::new([0.3, 0.1, 4e3, -7e5]), Jet::new([-0.6, -0.2, 0.5, -0.3])]),
        start: 1.0,
        duration: 0.25,
    };
    let calm = swinging.within(0.05);
    assert_eq!(calm.from[1], swinging.from[1], "small");
    assert_eq!([0, 1].map(|k| calm.from[0].coefficient(k)), [0.3, 0.1], "where it is and how fast");
    let (mut thrown, mut farthest) = (0.0_f64, 0.0_f64);
    for k in 0..=100 {
        let t = 1.0 + 0.0025 * f64::from(k);
        thrown = thrown.max((swinging.on(t)[0] - 0.3).abs());
        farthest = farthest.max((calm.on(t)[0] - 0.3).abs());
    }
    // T q̇ / 2 by the velocity, 0.05 rad each by acceleration and jerk.
    assert!(farthest <= 0.0125 + 0.1 && thrown > 10.0, "{farthest} and {thrown} rad");
}
