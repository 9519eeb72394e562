//! Dry friction against closed forms, on links and on motors.

use flexure::plant::{Friction, Plant};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::robots::Pendulum;

use super::{Ride, STEP, at_rest, joint};

/// The two sides of a joint whose spring is loose: two blocks.
#[derive(Clone, Copy, Debug)]
enum Side {
    Link,
    Motor,
}

impl Side {
    const BOTH: [Self; 2] = [Self::Link, Self::Motor];

    /// A block of `inertia` kg m² with `friction`; the other side moves on its own.
    fn block(self, inertia: f64, friction: Friction<1>) -> Plant<Pendulum<f64>, 1> {
        let loose = Plant { spring_gap: Vector([1e3]), ..joint(inertia, inertia, 1.0) };
        match self {
            Self::Link => Plant { link_friction: friction, ..loose },
            Self::Motor => Plant { motor_friction: friction, ..loose },
        }
    }

    /// Pushed with `torque` [N m].
    fn pushed(self, plant: Plant<Pendulum<f64>, 1>, torque: f64) -> (Plant<Pendulum<f64>, 1>, [f64; 1]) {
        match self {
            Self::Link => (Plant { external: Vector([torque]), ..plant }, [0.0]),
            Self::Motor => (plant, [torque]),
        }
    }

    fn moving(self, speed: f64) -> Motion<f64, 1> {
        match self {
            Self::Link => Motion { v_l: Vector([speed]), ..at_rest() },
            Self::Motor => Motion { v_m: Vector([speed]), ..at_rest() },
        }
    }

    fn position_and_speed(self, x: &Motion<f64, 1>) -> (f64, f64) {
        match self {
            Self::Link => (x.q_l[0], x.v_l[0]),
            Self::Motor => (x.q_m[0], x.v_m[0]),
        }
    }
}

/// v falls linearly, F/M = 5 rad/s², and is zero from v0 M/F on.
#[test]
fn a_block_slows_down_evenly_and_stops() {
    let (inertia, torque) = (0.1, 0.5);
    for side in Side::BOTH {
        for v0 in [2.0003, -2.0003_f64] {
            let plant = side.block(inertia, Friction::coulomb(Vector([torque])));
            let stop = v0.abs() * inertia / torque;
            let mut ride = Ride::new(&plant, side.moving(v0), STEP);
            let (_, v) = side.position_and_speed(&ride.on(0.25, [0.0]).x);
            let expected = v0 - v0.signum() * 0.25 * torque / inertia;
            // A thousand roundings.
            assert!((v - expected).abs() < 1e-12, "{side:?}: {v} against {expected} rad/s");
            let (_, v) = side.position_and_speed(&ride.on(stop - STEP - 0.25, [0.0]).x);
            assert!(v != 0.0, "{side:?}: stopped too early");
            let (q, v) = side.position_and_speed(&ride.on(2.0 * STEP, [0.0]).x);
            assert!(v == 0.0, "{side:?}: still moving");
            // The last step is done at its mean speed, whenever in it the block stops.
            let far = v0 * stop / 2.0;
            assert!(
                (q - far).abs() < torque / inertia * STEP * STEP / 8.0 + 1e-12,
                "{side:?}: {q}, {far} rad"
            );
            let (later, v) = side.position_and_speed(&ride.on(10.0, [0.0]).x);
            assert_eq!((later, v), (q, 0.0), "{side:?}: creeps");
            assert!(ride.residual().abs() < 1e-13, "{side:?}: {} J", ride.residual());
        }
    }
}

/// What friction can stop within a step is at rest at its end, not nearly so.
#[test]
fn rest_is_exact() {
    for side in Side::BOTH {
        let plant = side.block(0.1, Friction::coulomb(Vector([0.5])));
        for k in 1..100 {
            let x = side.moving(1.1e-5 * f64::from(k));
            // v + h (−v/h) would not be zero for a quarter of these.
            let (_, v) = side.position_and_speed(&Ride::new(&plant, x, 7e-4).on(7e-4, [0.0]).x);
            assert!(v == 0.0, "{side:?}: {v} rad/s");
        }
    }
}

#[test]
fn friction_holds_below_stiction_and_less_once_it_slides() {
    let (inertia, friction) = (
        0.1,
        Friction { coulomb: Vector([0.3]), stiction: Vector([0.5]), stribeck_velocity: Vector([0.05]) },
    );
    for side in Side::BOTH {
        for sign in [1.0, -1.0] {
            let held = |torque: f64| {
                let (plant, u) = side.pushed(side.block(inertia, friction), sign * torque);
                side.position_and_speed(&Ride::new(&plant, at_rest(), STEP).on(1.0, u).x)
            };
            assert_eq!(held(0.4999), (0.0, 0.0), "{side:?}: 0.4999 N m move it");
            // 0.01 N m more than what holds: 0.1 rad/s² or more.
            let (q, v) = held(0.51);
            assert!(sign * q > 0.05 && sign * v > 0.1, "{side:?}: 0.51 N m leave it at {q} rad, {v} rad/s");
            // Below stiction and above Coulomb: what slides goes on, in the end as (0.4 − 0.3)/0.1 rad/s².
            let (plant, u) = side.pushed(side.block(inertia, friction), sign * 0.4);
            let mut ride = Ride::new(&plant, side.moving(sign * 0.2), STEP);
            let (_, before) = side.position_and_speed(&ride.on(1.0, u).x);
            let (_, after) = side.position_and_speed(&ride.on(1.0, u).x);
            assert!((sign * (after - before) - 1.0).abs() < 1e-12, "{side:?}: {before} to {after} rad/s");
        }
    }
}

/// At 0.05 rad/s the Stribeck curve is down to F_C + (F_S − F_C)/e: the torque at which that speed is kept.
#[test]
fn the_stribeck_curve_is_where_it_should_be() {
    let friction =
        Friction { coulomb: Vector([0.3]), stiction: Vector([0.5]), stribeck_velocity: Vector([0.05]) };
    let kept = 0.3 + 0.2 / std::f64::consts::E;
    for side in Side::BOTH {
        let (plant, u) = side.pushed(side.block(10.0, friction), kept);
        let (_, v) = side.position_and_speed(&Ride::new(&plant, side.moving(0.05), STEP).on(0.1, u).x);
        assert!((v - 0.05).abs() < 1e-13, "{side:?}: {v} rad/s");
    }
}

/// On a spring to a motor that is held, the link loses 4 F/K a cycle, keeps its period, and comes to rest in a dead band
/// of ±F/K: here after seven half cycles.
#[test]
fn an_oscillation_dies_linearly() {
    let (inertia, stiffness, torque) = (0.1_f64, 40.0, 3.0);
    let held = Friction::coulomb(Vector([1e6]));
    let plant = Plant {
        link_friction: Friction::coulomb(Vector([torque])),
        motor_friction: held,
        ..joint(inertia, 0.1, stiffness)
    };
    let half_cycle = std::f64::consts::PI * (inertia / stiffness).sqrt();
    let error = |step: f64| {
        let start = Motion { q_l: Vector([1.0]), ..at_rest() };
        let mut ride = Ride::new(&plant, start, step);
        let mut worst = 0.0_f64;
        for n in 1..=12 {
            let q = ride.on(half_cycle, [0.0]).x.q_l[0];
            let half_cycles = f64::from(n.min(7));
            let expected = (1.0 - 2.0 * half_cycles * torque / stiffness) * (-1.0_f64).powf(half_cycles);
            worst = worst.max((q - expected).abs());
        }
        assert_eq!((ride.x.v_l[0], ride.x.v_m[0], ride.x.q_m[0]), (0.0, 0.0, 0.0));
        assert!(ride.residual().abs() < 1e-12 * ride.start, "{} J", ride.residual());
        worst
    };
    let errors = [STEP, STEP / 4.0];
    let errors = errors.map(error);
    // At a turning point friction acts against the speed at the end of a step: an error of 2 F/M h² a turn.
    assert!(errors[0] < 7.0 * 2.0 * torque / inertia * STEP * STEP, "{errors:?} rad");
    assert!(errors[1] < errors[0] / 8.0, "{errors:?} rad");
}

/// A push of u turns a block back that slides against it: friction slows it down by (u + F)/M until t₁ = v₀ M/(u + F), and lets go by
/// (u − F)/M from then on, wherever in a step that is.
#[test]
fn a_block_turns_back_within_a_step() {
    let (inertia, torque, push) = (0.1, 2.0, 3.0);
    for side in Side::BOTH {
        for v0 in [0.11, 0.2003, 1.0, -0.2003] {
            let u = -push * f64::signum(v0);
            let (plant, u_m) = side.pushed(side.block(inertia, Friction::coulomb(Vector([torque]))), u);
            let turn = v0.abs() * inertia / (push + torque);
            let mut ride = Ride::new(&plant, side.moving(v0), STEP);
            for k in 1..=40 {
                let t = f64::from(k) * 1e-3;
                let (_, speed) = side.position_and_speed(&ride.on(1e-3, u_m).x);
                let expected = if t < turn {
                    v0.abs() - (push + torque) / inertia * t
                } else {
                    -(push - torque) / inertia * (t - turn)
                };
                assert!(
                    (speed - v0.signum() * expected).abs() < 1e-9,
                    "{side:?}: {speed} at {t} s after {v0}"
                );
            }
        }
    }
}

/// A pendulum with less weight than friction stays where it is put; the motor behind its spring as well.
#[test]
fn a_held_link_does_not_sag() {
    let mut plant = joint(0.1, 0.1, 50.0);
    plant.robot.links.weight_moment = 0.4;
    plant.link_friction = Friction::coulomb(Vector([0.5]));
    let x = Motion::at_rest(Vector([1.2]));
    assert_eq!(Ride::new(&plant, x, STEP).on(1.0, [0.0]).x, x);
    plant.link_friction = Friction::coulomb(Vector([0.3]));
    assert!(Ride::new(&plant, x, STEP).on(1.0, [0.0]).x.q_l[0] < 1.19);
}
