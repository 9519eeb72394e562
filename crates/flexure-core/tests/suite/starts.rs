//! References that begin where the robot is, and clocks: what they promise at their ends.

use flexure_core::control::Input;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::{Clock, Reference, Retimed, Sine, SmoothStart, Smoothstep, Stop};
use flexure_core::scalar::{Jet, Scalar};

use crate::common::{Numbers, branched, flexible, gains, planar, tanh};

const START: f64 = 0.75;

fn sine<const N: usize>() -> Sine<f64, N> {
    Sine {
        offset: Vector::from_fn(|i| 0.2 * i as f64),
        amplitude: Vector::from_fn(|i| 0.5 - 0.1 * i as f64),
        frequency: Vector::from_fn(|i| 2.0 + i as f64),
        phase: Vector::from_fn(|i| 0.7 * i as f64),
    }
}

/// From the state of a robot in motion.
fn start<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
) -> SmoothStart<f64, Sine<f64, N>, N> {
    let from = robot.link_motion(&robot.links.factor(&x.q_l), x);
    SmoothStart { from: Stop { from, start: START, duration: 0.25 }, duration: 1.5, then: sine() }
}

/// Derivatives are those of the state at the start and those of the reference at the end; and a law has no error.
fn joins<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let x = r.motion(1.0);
    let q_d = start(robot, &x);
    let (state, first) = (robot.link_motion(&robot.links.factor(&x.q_l), &x), q_d.at::<5>(START));
    let (then, last) = (q_d.then.at::<5>(START + 1.5), q_d.at::<5>(START + 1.5));
    for i in 0..N {
        for k in 0..4 {
            let (got, expected) = (first[i].derivative(k), state[i].derivative(k));
            assert!((got - expected).abs() <= 1e-9 * expected.abs(), "derivative {k}: {got}, {expected}");
        }
        for k in 0..5 {
            let (got, expected) = (last[i].derivative(k), then[i].derivative(k));
            assert!((got - expected).abs() <= 1e-9 * expected.abs(), "derivative {k}: {got}, {expected}");
        }
    }
    let answer = gains(tanh, false, r).command(robot, &x, &first, &Input::ZERO);
    let far = |v: &Vector<f64, N>| v.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
    // Positions of motors are q + K⁻¹ of link torques of up to 1e3 N m, velocities of their rates of up to 1e5 N m/s.
    assert!(far(&answer.e_l) == 0.0 && far(&answer.s_l) < 1e-12, "{answer:?}");
    assert!(far(&answer.e_m) < 1e-11 && far(&answer.s_m) < 1e-9, "{answer:?}");
}

#[test]
fn a_robot_in_motion_starts_on_its_reference() {
    let r = &mut Numbers(11);
    for _ in 0..20 {
        joins(&flexible(planar(), r), r);
        joins(&flexible(branched::<4>(5), r), r);
    }
}

#[test]
fn a_stop_comes_to_rest_as_far_away_as_documented() {
    let (v, a, jerk, duration) = (1.5, -4.0, 30.0, 0.5_f64);
    let reached =
        0.2 + duration * v / 2.0 + 3.0 * duration.powi(2) * a / 28.0 + duration.powi(3) * jerk / 84.0;
    let from = Vector([Jet::from_derivatives([0.2, v, a, jerk])]);
    let stop = Stop { from, start: START, duration };
    let [first] = stop.at::<5>(START).0;
    for (k, expected) in [0.2, v, a, jerk, 0.0].into_iter().enumerate() {
        assert!(
            (first.derivative(k) - expected).abs() <= 1e-13 * expected.abs(),
            "derivative {k}: {first:?}"
        );
    }
    for t in [START + duration, START + 0.6, 100.0] {
        let [end] = stop.at::<5>(t).0;
        assert!((end.derivative(0) - reached).abs() < 1e-15, "{end:?}, expected {reached}");
        assert!((1..5).all(|k| end.derivative(k) == 0.0), "at rest to the bit: {end:?}");
    }
    for t in [-1.0, 0.0, START.next_down()] {
        assert_eq!(stop.at::<5>(t), Vector([Jet::value(0.2)]), "before, it stands where it starts");
    }
    // Both forms of the polynomial meet in the middle, with all their derivatives.
    let middle = START + 0.5 * duration;
    let ([left], [right]) = (stop.at::<9>(middle.next_down()).0, stop.at::<9>(middle.next_up()).0);
    for k in 0..9 {
        // Coefficients of up to 1e3 in time over the duration, and one step of time.
        let scale = 1e3 * duration.powf(-(k as f64));
        assert!((left.coefficient(k) - right.coefficient(k)).abs() < 1e-13 * scale, "coefficient {k}");
    }
}

/// The integral is that of the step: its jet is the step's, one order on, and its ends are closed forms.
#[test]
fn integrals_of_smooth_steps() {
    for step in [Smoothstep::Quintic, Smoothstep::Septic, Smoothstep::Nonic] {
        for i in -10..30_i32 {
            let tau = f64::from(i) / 16.0;
            let (integral, s) =
                (step.integral(Jet::<f64, 6>::variable(tau)), step.eval(Jet::<f64, 5>::variable(tau)));
            for k in 0..5 {
                // Derivatives of steps reach 1e4 from summands ten times larger.
                let (got, expected) = (integral.derivative(k + 1), s.derivative(k));
                assert!(
                    (got - expected).abs() < 1e-10,
                    "{step:?} at {tau}, derivative {k}: {got}, {expected}"
                );
            }
            if i <= 0 {
                assert!(integral.derivative(0) == 0.0);
            } else if i >= 16 {
                assert_eq!(integral.derivative(0).to_bits(), (tau - 0.5).to_bits(), "{step:?} at {tau}");
            }
        }
        // ∫ of τᵐ⁺¹ … to ½, by the law s(τ) + s(1 − τ) = 1 applied to a sum of a thousand midpoints.
        let half: f64 = (0..1000).map(|i| step.eval((f64::from(i) + 0.5) / 2000.0) / 2000.0).sum();
        assert!((step.integral(0.5) - half).abs() < 1e-7, "{step:?}");
    }
}

#[test]
fn a_clock_from_rest_goes_on_at_its_speed() {
    let (speed, rise) = (0.7, 2.0);
    let clock = Clock::FromRest { speed, rise };
    for t in [2.0, 3.5, 80.0] {
        let s = clock.on(Jet::<f64, 5>::variable(t));
        assert!((s.derivative(0) - speed * (t - 1.0)).abs() < 1e-14 * t);
        assert!((s.derivative(1) - speed).abs() < 1e-15 && (2..5).all(|k| s.derivative(k) == 0.0), "{s:?}");
    }
    for t in [-3.0, 0.0] {
        assert_eq!(clock.on(Jet::<f64, 5>::variable(t)), Jet::ZERO, "at rest at {t} s");
    }
}

/// Derivative k at constant speed is ρᵏ times that of the path; along a clock, by the chain rule written out.
#[test]
fn derivatives_along_a_clock() {
    let path = sine::<2>();
    for i in 0..30 {
        let t = 0.1 * f64::from(i);
        let slow = Retimed { clock: Clock::Steady { speed: 0.3 }, path }.at::<5>(t);
        let risen = Retimed { clock: Clock::FromRest { speed: 0.3, rise: 2.0 }, path };
        let s = risen.clock.on(Jet::<f64, 5>::variable(t));
        let d = |k: usize| s.derivative(k);
        for j in 0..2 {
            let r = path.at::<5>(0.3 * t)[j];
            for k in 0..5 {
                let expected = 0.3_f64.powf(k as f64) * r.derivative(k);
                assert!((slow[j].derivative(k) - expected).abs() < 1e-13, "derivative {k} at {t} s");
            }
            let r = path.at::<5>(d(0))[j];
            let r = |k: usize| r.derivative(k);
            let expected = [
                r(0),
                r(1) * d(1),
                r(2) * d(1).powi(2) + r(1) * d(2),
                r(3) * d(1).powi(3) + 3.0 * r(2) * d(1) * d(2) + r(1) * d(3),
                r(4) * d(1).powi(4)
                    + 6.0 * r(3) * d(1).powi(2) * d(2)
                    + r(2) * (3.0 * d(2).powi(2) + 4.0 * d(1) * d(3))
                    + r(1) * d(4),
            ];
            let on = risen.on(Jet::<f64, 5>::variable(t))[j];
            for (k, expected) in expected.into_iter().enumerate() {
                for got in [risen.at::<5>(t)[j].derivative(k), on.derivative(k)] {
                    assert!((got - expected).abs() < 1e-12, "derivative {k} at {t} s: {got}, {expected}");
                }
            }
        }
    }
}

/// sin(t²) at once, and as a series of sin about t² composed with that of t².
#[test]
fn series_compose() {
    let t = Jet::<f64, 7>::variable(0.8);
    let square = t.square();
    let composed = Jet::<f64, 7>::variable(square.coefficient(0)).sin().compose(&square);
    let at_once = square.sin();
    for k in 0..7 {
        // Some fifty operations on coefficients below 10.
        assert!((composed.coefficient(k) - at_once.coefficient(k)).abs() < 1e-13, "coefficient {k}");
    }
}
