//! The time stepping by itself: its order, its stability, its books.

use flexure::plant::{Friction, Hysteresis, Plant};
use flexure::simulate::{Integrator, Ledger, Stepping};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion, RotorCoupling};
use flexure_core::robots::{Body, JointKind, Tree};

use super::{Ride, STEP, at_rest, joint, two_link};
use crate::common::distance;

/// Four joints about axes at right angles under gravity, hardening springs, coupled rotors.
fn chain() -> Plant<Tree<f64, 4>, 4> {
    let bodies = std::array::from_fn(|i: usize| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8]][i % 2],
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0, 0.0, if i == 0 { 0.0 } else { 0.3 }],
        mass: [4.0, 3.0, 2.0, 1.0][i],
        com: [0.02, 0.01, 0.1],
        inertia: [[0.08, 0.0, 0.0], [0.0, 0.09, 0.0], [0.0, 0.0, 0.07]],
    });
    let motor_inertia = Vector([0.3, 0.2, 0.5, 0.05]);
    Plant {
        spring_hardening: Vector([1e4, 2e4, 5e3, 5e3]),
        rotor_coupling: Some(RotorCoupling::new(&motor_inertia, &Vector([5.0, 2.5, -4.0, 1.0]))),
        external: Vector([0.3, -2.0, 1.0, 0.5]),
        ..Plant::from(Fjr {
            links: Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("a chain"),
            motor_inertia,
            stiffness: Vector([300.0, 300.0, 100.0, 60.0]),
            link_damping: Vector([0.1, 0.2, 0.1, 0.1]),
            motor_damping: Vector([1.0, 2.0, 1.0, 0.5]),
        })
    }
}

/// Errors against the integrator of order 8 after half a second in steps of 0.5, 0.25 and 0.125 ms.
fn orders<L: Links<f64, N>, const N: usize>(plant: &Plant<L, N>, x: Motion<f64, N>) {
    let torque = |t: f64, _: &Motion<f64, N>| Vector::from_fn(|i| 2.0 * (7.0 * t + i as f64).cos());
    let reference =
        Integrator::new(1e-12).advance(plant, x, 0.0, 0.5, &torque, &mut Ledger::default()).expect("smooth");
    let errors = [0.5e-3, 0.25e-3, 0.125e-3].map(|step| {
        let end = Stepping::new(step).advance(plant, x, 0.0, 0.5, &torque, &mut Ledger::default());
        distance(&end.expect("smooth"), &reference)
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.9..2.1).contains(&order), "order {order}, errors {errors:?}");
    }
    assert!(errors[1] < 1e-4 * (1.0 + distance(&reference, &at_rest())), "{errors:?}");
}

#[test]
fn it_is_of_order_two_on_the_arm() {
    let plant = Plant { spring_hardening: Vector([90.0, 40.0]), external: Vector([0.5, -0.2]), ..two_link() };
    let start =
        Motion { v_l: Vector([1.0, -2.0]), v_m: Vector([1.0, 0.3]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    orders(&plant, start);
}

#[test]
fn it_is_of_order_two_on_a_chain_with_rotors() {
    let q_l = Vector([0.1, 0.8, -0.2, 0.9]);
    orders(&chain(), Motion { q_m: q_l + Vector([0.1, -0.1, 0.1, -0.1]), ..Motion::at_rest(q_l) });
}

/// 9000 1/s and 500 Hz in steps of 1 ms: neither blows up.
#[test]
fn stiff_dampers_and_springs_are_harmless() {
    let plant = two_link();
    let mut ride = Ride::new(&plant, at_rest(), 1e-3);
    ride.stepper = flexure::simulate::Stepper::Rough(Stepping::new(1e-3));
    ride.on(2.0, [0.0, 90.0]);
    assert!((ride.x.v_m[1] - 1.0).abs() < 0.2, "90 N m against 90 N m s/rad: {} rad/s", ride.x.v_m[1]);

    let plant = Plant { motor_friction: Friction::coulomb(Vector([1e-12])), ..joint(1e-3, 1e-3, 5000.0) };
    let mut ride = Ride::new(&plant, Motion { q_m: Vector([0.01]), ..at_rest() }, 1e-3);
    ride.on(2.0, [0.0]);
    // Two thousand steps, exact but for rounding: 1e-9 of the energy goes into friction.
    assert!(ride.residual().abs() < 1e-12 * ride.start, "{} of {} J", ride.residual(), ride.start);
    assert!(ride.ledger.dissipated < 1e-6 * ride.start, "{:?}", ride.ledger);
}

/// Every imperfection on, moved about for two seconds.
#[test]
fn the_books_close_with_the_step() {
    let plant = Plant {
        spring_hardening: Vector([90.0, 40.0]),
        spring_gap: Vector([0.01, 0.02]),
        hysteresis: Hysteresis { stiffness: Vector([20.0, 10.0]), yield_torque: Vector([0.2, 0.1]) },
        link_friction: Friction {
            coulomb: Vector([0.05, 0.02]),
            stiction: Vector([0.08, 0.03]),
            stribeck_velocity: Vector([0.1, 0.1]),
        },
        motor_friction: Friction {
            coulomb: Vector([0.2, 0.5]),
            stiction: Vector([0.3, 0.8]),
            stribeck_velocity: Vector([0.05, 0.05]),
        },
        external: Vector([0.1, -0.1]),
        ..two_link()
    };
    let residual = |step: f64| {
        let mut ride = Ride::new(&plant, at_rest(), step);
        for k in 0..400 {
            let t = 5e-3 * f64::from(k);
            ride.on(5e-3, [3.0 * (9.0 * t).sin(), 60.0 * (5.0 * t).cos()]);
        }
        ride.residual().abs() / ride.ledger.throughput
    };
    let residuals = [STEP, STEP / 8.0].map(residual);
    assert!(residuals[0] < 1e-5, "{residuals:?}");
    assert!(residuals[1] < residuals[0] / 8.0, "{residuals:?}");
}

/// Angular momentum grows by what is pushed, and the books of the integrator of order 8 know it.
#[test]
fn a_push_is_booked() {
    let push = 0.7;
    let plant = Plant { external: Vector([push]), ..joint(0.1, 0.03, 50.0) };
    let mut ride = Ride::new(&plant, at_rest(), STEP);
    for _ in 0..1000 {
        ride.on(1e-3, [0.2]);
    }
    let momentum = 0.1 * ride.x.v_l[0] + 0.03 * ride.x.v_m[0];
    assert!((momentum - 0.9).abs() < 1e-12, "{momentum} kg m²/s");
    assert!(
        ride.residual().abs() < 1e-13 * ride.ledger.throughput,
        "{} of {:?}",
        ride.residual(),
        ride.ledger
    );
    let moved = push * ride.x.q_l[0] + 0.2 * ride.x.q_m[0];
    assert!((ride.ledger.supplied - moved).abs() < 1e-12 * moved, "{} of {moved} J", ride.ledger.supplied);
}

#[test]
fn nothing_happens_in_no_time() {
    let smooth = joint(0.1, 0.03, 50.0);
    let rough = Plant { motor_friction: Friction::coulomb(Vector([0.1])), ..smooth };
    let x = Motion { v_l: Vector([1.0]), ..at_rest() };
    for plant in [smooth, rough] {
        let mut ride = Ride::new(&plant, x, STEP);
        assert_eq!(ride.on(0.0, [5.0]).x, x);
        assert_eq!((ride.ledger, ride.stepper.steps()), (Ledger::default(), 0));
    }
}
