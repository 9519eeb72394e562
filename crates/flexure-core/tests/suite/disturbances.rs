//! Momentum residuals: first order to constant torques, nothing for what the model knows, nothing for limits that are hit.

use flexure_core::estimate::{Disturbance, DisturbanceObserver};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};

use crate::common::plant::{PERIOD, Push, advance, paper_arm, plausible_arm, stirring};
use crate::common::{Numbers, branched, close, flexible};

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
}

/// The largest distance of the residuals to `expected(t)` [N m] over `periods`, on the true motion under `push(t)`.
fn worst<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    bandwidth: f64,
    periods: u32,
    push: impl Fn(f64) -> Push<N>,
    expected: impl Fn(f64) -> Push<N>,
) -> f64 {
    let mut observer = DisturbanceObserver::new(&Vector([bandwidth; N]), PERIOD).expect("positive");
    let mut x = Motion { v_l: Vector([0.5; N]), ..Motion::at_rest(Vector([0.2; N])) };
    assert_eq!(observer.update(robot, &x, &Vector::ZERO), Disturbance::ZERO);
    (0..periods).fold(0.0, |worst, k| {
        let t = f64::from(k) * PERIOD;
        let u = stirring(1.0, t);
        x = advance(robot, &x, &u, &push(t), PERIOD, 20);
        let (found, wanted) = (observer.update(robot, &x, &u), expected(t + PERIOD));
        worst.max(largest(&(found.link - wanted.link))).max(largest(&(found.motor - wanted.motor)))
    })
}

/// To a constant torque d the residual goes like d (1 − e^{−ωt}) from the first period on, on either side.
#[test]
fn constant_torques_are_found_at_the_bandwidth() {
    let (link, motor) = (Vector([0.7, -0.3]), Vector([-0.4, 0.2]));
    for (arm, bandwidth) in [(plausible_arm(), 30.0), (plausible_arm(), 200.0), (paper_arm(), 30.0)] {
        let scaled = |s: f64| Push { link: link.scaled(s), motor: motor.scaled(s) };
        let error = worst(&arm, bandwidth, 1000, |_| scaled(1.0), |t| scaled(1.0 - (-bandwidth * t).exp()));
        // Springs and Coriolis torques by the trapezoidal rule: T²/12 of their second derivatives, here 1e3 N m/s² at the start.
        println!("{bandwidth} rad/s: {error:.1e} N m");
        assert!(error < 2e-4, "{error}");
    }
}

/// A slow sine comes out through the same first order: 1 / √(1 + (ν/ω)²), late by atan(ν/ω).
#[test]
fn slow_torques_are_followed() {
    let (w, nu, link) = (30.0_f64, 3.0_f64, Vector([0.7, -0.3]));
    let lag = nu / w;
    let sine = |s: f64| Push { link: link.scaled(s), motor: Vector::ZERO };
    // The response to sin νt from 0 on: amplitude, lag, and a transient that dies at ω.
    let expected =
        |t: f64| ((nu * t).sin() - lag * (nu * t).cos() + lag * (-w * t).exp()) / (1.0 + lag * lag);
    // Held over the period, the sine is half a period late: ν T/2 of it.
    let error = worst(&plausible_arm(), w, 2000, |t| sine((nu * t).sin()), |t| sine(expected(t)));
    println!("{error:.1e} N m");
    assert!(error < 0.7 * nu * PERIOD, "{error}");
}

/// An undisturbed robot leaves no residual: gravity, Coriolis and centrifugal torques of a branched tree with prismatic joints
/// are all known.
#[test]
fn nothing_is_found_where_nothing_is() {
    let mut r = Numbers(7);
    for seed in 0..3 {
        let robot = flexible(branched::<5>(seed), &mut r);
        let error = worst(&robot, 50.0, 500, |_| Push::NONE, |_| Push::NONE);
        println!("{error:.1e} N m");
        // Of torques of tens of N m that oscillate at tens of rad/s: (νT)²/12 of them.
        assert!(error < 1e-3, "{error}");
    }
}

/// A command of 4 N m at a limit of 1 N m: fed the torque that was applied there is no residual; fed the command, the residual is what the
/// limit cut off.
#[test]
fn a_limit_is_no_disturbance() {
    let arm = plausible_arm();
    let asked: Vector<f64, 2> = Vector([4.0, -4.0]);
    let applied = asked.map(|u| u.clamp(-1.0, 1.0));
    let [mut told, mut misled] =
        [(); 2].map(|()| DisturbanceObserver::new(&Vector([50.0; 2]), PERIOD).expect("positive"));
    let mut x = Motion::at_rest(Vector([0.3, -0.5]));
    told.update(&arm, &x, &asked);
    misled.update(&arm, &x, &asked);
    for _ in 0..500 {
        x = advance(&arm, &x, &applied, &Push::NONE, PERIOD, 20);
        let good = told.update(&arm, &x, &applied);
        misled.update(&arm, &x, &asked);
        // See above: the springs are by the trapezoidal rule.
        assert!(largest(&good.motor) < 1e-3 && largest(&good.link) < 1e-3, "{good:?}");
    }
    let bad = misled.update(&arm, &advance(&arm, &x, &applied, &Push::NONE, PERIOD, 20), &asked);
    close(&bad.motor, &(applied - asked), 1e-2);
}

/// A motion that is not finite starts it over.
#[test]
fn a_bad_motion_is_forgotten() {
    let arm = plausible_arm();
    let rest = Motion::at_rest(Vector([0.3, -0.5]));
    let mut observer = DisturbanceObserver::new(&Vector([50.0; 2]), PERIOD).expect("positive");
    observer.update(&arm, &rest, &Vector::ZERO);
    assert!(largest(&observer.update(&arm, &rest, &Vector([1.0, 1.0])).motor) > 0.01);
    for garbage in [f64::NAN, f64::INFINITY, 1e308] {
        let bad = Motion { v_l: Vector([garbage, 0.0]), ..rest };
        let found = observer.update(&arm, &bad, &Vector::ZERO);
        assert!(garbage.is_finite() || found == Disturbance::ZERO);
        observer.restart();
        assert_eq!(observer.update(&arm, &rest, &Vector::ZERO), Disturbance::ZERO);
        assert_eq!(observer.update(&arm, &rest, &Vector::ZERO), Disturbance::ZERO);
    }
    assert!(DisturbanceObserver::new(&Vector([0.0]), PERIOD).is_none());
}
