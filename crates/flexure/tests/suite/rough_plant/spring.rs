//! Hysteresis and play against closed forms.

use std::f64::consts::PI;

use flexure::plant::{Friction, Hysteresis, Plant};
use flexure::simulate::Stepper;
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::robots::Pendulum;

use super::{Ride, STEP, at_rest, joint};

/// A heavy motor on a spring to a link that is held: 1 Hz whatever the hysteresis does.
fn shaker() -> Plant<Pendulum<f64>, 1> {
    let stiffness = 1e7;
    Plant {
        link_friction: Friction::coulomb(Vector([1e9])),
        hysteresis: Hysteresis { stiffness: Vector([50.0]), yield_torque: Vector([0.5]) },
        ..joint(1.0, stiffness / (2.0 * PI * 2.0 * PI), stiffness)
    }
}

/// 4 τ_y (A − τ_y/k_h) a cycle, in the books and as the area of torque over deflection.
#[test]
fn a_hysteresis_loop_has_its_area() {
    let plant = shaker();
    let amplitude = 0.2;
    let mut ride = Ride::new(&plant, Motion { q_m: Vector([amplitude]), ..at_rest() }, STEP);
    // Relaxed at first: the loop is entered.
    ride.on(1.0, [0.0]);
    let before = ride.ledger.dissipated;
    let torque = |ride: &Ride<'_, _, 1>| match &ride.stepper {
        Stepper::Rough(stepping) => stepping.hysteresis_torque()[0],
        Stepper::Smooth(_) => panic!("hysteresis is not smooth"),
    };
    let mut area = 0.0;
    // One second.
    for _ in 0..10_000 {
        let (q, z) = (ride.x.q_m[0], torque(&ride));
        ride.on(STEP, [0.0]);
        area += 0.5 * (z + torque(&ride)) * (ride.x.q_m[0] - q);
        assert!(torque(&ride).abs() <= 0.5);
    }
    let expected = 4.0 * 0.5 * (amplitude - 0.5 / 50.0);
    let booked = ride.ledger.dissipated - before;
    // The shaker loses 2e-6 of its energy; turning points are met to (2π h)²/8 of the amplitude.
    assert!((booked / expected - 1.0).abs() < 1e-5, "{booked} J booked, {expected} J expected");
    // Kinks inside a step: up to k_h (v h)²/8 each.
    assert!((area / expected - 1.0).abs() < 1e-4, "{area} J enclosed, {expected} J expected");
}

#[test]
fn what_does_not_yield_loses_nothing() {
    let plant = shaker();
    // Relaxed at one end of the swing: half of 2 τ_y/k_h.
    let mut ride = Ride::new(&plant, Motion { q_m: Vector([0.0049]), ..at_rest() }, STEP);
    ride.on(3.0, [0.0]);
    assert!(ride.ledger.dissipated == 0.0, "{:?}", ride.ledger);
    // The books of linear springs are exact: rounding of 12000 steps.
    assert!(ride.residual().abs() < 1e-10 * ride.start, "{} of {} J", ride.residual(), ride.start);
}

/// At rest after yielding, the element keeps a torque: the joint is left bent by it.
#[test]
fn a_yielded_spring_is_left_bent() {
    let plant = Plant {
        hysteresis: Hysteresis { stiffness: Vector([50.0]), yield_torque: Vector([0.5]) },
        ..joint(0.1, 0.1, 20.0)
    };
    let damped = {
        let mut plant = plant;
        plant.robot.motor_damping = Vector([1.0]);
        plant.robot.link_damping = Vector([1.0]);
        plant
    };
    let mut ride = Ride::new(&damped, at_rest(), STEP);
    ride.on(20.0, [3.0]);
    ride.on(20.0, [0.0]);
    let left = ride.x.deflection()[0];
    let Stepper::Rough(stepping) = &ride.stepper else { panic!("hysteresis is not smooth") };
    let z = stepping.hysteresis_torque()[0];
    assert!((z + 20.0 * left).abs() < 1e-9, "torques balance: {z} N m at {left} rad");
    assert!(left > 1e-3, "{left} rad");
}

#[test]
fn play_gives_no_torque_and_then_a_spring() {
    let plant =
        Plant { spring_gap: Vector([0.02]), spring_hardening: Vector([1e4]), ..joint(0.1, 0.1, 50.0) };
    let torque = |zeta: f64| plant.spring_torque(&Motion { q_m: Vector([zeta]), ..at_rest() })[0];
    for zeta in [0.0, 0.004, -0.0099, 0.01, -0.01] {
        assert!(torque(zeta) == 0.0, "at {zeta} rad");
    }
    for (zeta, wound) in [(0.03, 0.02), (-0.03, -0.02), (0.015, 0.005)] {
        let expected: f64 = 50.0 * wound + 1e4 * wound * wound * wound;
        assert!((torque(zeta) - expected).abs() < 1e-14, "{} against {expected} N m", torque(zeta));
        let back = plant.deflection_under(&Vector([expected]))[0];
        assert!((back - zeta).abs() < 1e-15, "{back} against {zeta} rad");
    }
    // ½ K ε² + ¼ k ε⁴ at ε = 0.02 rad.
    let energy = plant.total_energy(&Motion { q_m: Vector([-0.03]), ..at_rest() });
    assert!((energy - (0.5 * 50.0 * 4e-4 + 0.25 * 1e4 * 1.6e-7)).abs() < 1e-16, "{energy} J");
}

/// Between two stops: a flight across the play each way, and half an oscillation in each spring.
#[test]
fn play_lengthens_the_period() {
    let (inertia, stiffness, gap, speed) = (0.1_f64, 400.0, 0.05, 3.0);
    let plant = Plant {
        spring_gap: Vector([gap]),
        link_friction: Friction::coulomb(Vector([1e9])),
        ..joint(0.1, inertia, stiffness)
    };
    let period = 2.0 * PI * (inertia / stiffness).sqrt() + 2.0 * gap / speed;
    let error = |step: f64| {
        let mut ride = Ride::new(&plant, Motion { v_m: Vector([speed]), ..at_rest() }, step);
        ride.on(0.4 * gap / speed, [0.0]);
        assert!((ride.x.v_m[0] - speed).abs() < 1e-14, "free inside the play: {} rad/s", ride.x.v_m[0]);
        ride.on(10.0 * period - 0.4 * gap / speed, [0.0]);
        (ride.x.q_m[0] / speed).abs()
    };
    let errors = [STEP, STEP / 8.0].map(error);
    // Ten periods of 0.13 s; the stop is met inside a step forty times.
    assert!(errors[0] < 2e-3 * period && errors[1] < errors[0] / 8.0, "{errors:?} s");
}
