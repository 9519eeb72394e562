//! What holds for every imperfection of the plant: none at zero strength, more with more, the same every time.

use flexure::plant::{Friction, Hysteresis, Plant};
use flexure::scenario::Integration;
use flexure::simulate::{Integrator, Ledger, Stepper};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::robots::PlanarTwoLink;

use super::{Ride, STEP, at_rest, two_link};

type Arm = Plant<PlanarTwoLink<f64>, 2>;

fn friction(strength: f64) -> Friction<2> {
    Friction {
        coulomb: Vector([0.2, 0.3]).scaled(strength),
        stiction: Vector([0.3, 0.4]).scaled(strength),
        stribeck_velocity: Vector([0.05, 0.05]),
    }
}

/// An imperfection of any strength.
type Imperfection = fn(f64) -> Arm;

const IMPERFECTIONS: [(&str, Imperfection); 4] = [
    ("friction of the links", |s| Plant { link_friction: friction(s), ..two_link() }),
    ("friction of the motors", |s| Plant { motor_friction: friction(s), ..two_link() }),
    ("play", |s| Plant { spring_gap: Vector([0.02, 0.02]).scaled(s), ..two_link() }),
    ("hysteresis", |s| {
        let yield_torque = Vector([0.2, 0.2]).scaled(s);
        Plant { hysteresis: Hysteresis { stiffness: Vector([40.0, 40.0]), yield_torque }, ..two_link() }
    }),
];

/// Half a second there, then at rest for long under no torque.
fn ride(plant: &Arm) -> (Motion<f64, 2>, Ledger) {
    let mut ride = Ride::new(plant, at_rest(), STEP);
    for k in 0..500 {
        ride.on(1e-3, [3.0 * (0.02 * f64::from(k)).sin(), 40.0]);
    }
    (ride.on(5.0, [0.0; 2]).x, ride.ledger)
}

#[test]
fn nothing_is_nothing_to_the_last_bit() {
    let start = Motion { v_l: Vector([1.0, -2.0]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    let torque = |t: f64, _: &Motion<f64, 2>| Vector([3.0 * t.cos(), 40.0]);
    let mut expected = Ledger::default();
    let end = Integrator::new(1e-10).advance(&two_link(), start, 0.0, 0.3, &torque, &mut expected);
    for (name, imperfection) in IMPERFECTIONS {
        let plant = imperfection(0.0);
        assert!(plant.is_smooth(), "{name}");
        assert!(!imperfection(1e-9).is_smooth(), "{name}");
        let mut ledger = Ledger::default();
        let same = Stepper::new(&plant, Integration::Collocation { tolerance: 1e-10 }, STEP).advance(
            &plant,
            start,
            0.0,
            0.3,
            &torque,
            &mut ledger,
        );
        assert_eq!((same, ledger), (end, expected), "{name}");
    }
}

#[test]
fn every_time_the_same() {
    for (name, imperfection) in IMPERFECTIONS {
        assert_eq!(ride(&imperfection(1.0)), ride(&imperfection(1.0)), "{name}");
    }
}

/// By how much the links are elsewhere than those of the perfect arm, in the worst of fifty instants.
#[test]
fn more_is_more() {
    for (name, imperfection) in IMPERFECTIONS {
        let effects = [0.25, 0.5, 1.0].map(|strength| {
            let (ideal, plant) = (two_link(), imperfection(strength));
            let (mut ideal, mut ride) =
                (Ride::new(&ideal, at_rest(), STEP), Ride::new(&plant, at_rest(), STEP));
            (0..50).fold(0.0_f64, |worst, k| {
                let u_m = [3.0 * (0.2 * f64::from(k)).sin(), 40.0];
                let apart = ride.on(1e-2, u_m).x.q_l - ideal.on(1e-2, u_m).x.q_l;
                apart.iter().fold(worst, |m, e| m.max(e.abs()))
            })
        });
        assert!(effects[0] > 1e-4 && effects.is_sorted_by(|a, b| a < b), "{name}: {effects:?} rad");
    }
}

/// Under a proportional law of 20 N m/rad a damped motor creeps to where friction at rest balances it, or stops before.
#[test]
fn friction_leaves_a_law_off_its_target() {
    let off = [0.25, 0.5, 1.0].map(|strength| {
        let plant = Plant { motor_friction: friction(strength), ..two_link() };
        let torque = |_: f64, x: &Motion<f64, 2>| Vector::from_fn(|i| 20.0 * (0.5 - x.q_m[i]));
        let mut stepper = Stepper::new(&plant, Integration::Collocation { tolerance: 1e-10 }, STEP);
        let end = stepper.advance(&plant, at_rest(), 0.0, 40.0, &torque, &mut Ledger::default());
        let end = end.expect("bounded");
        for i in 0..2 {
            // A time constant of 5 s: 0.5 e⁻⁸ rad are left to creep.
            let error = (0.5 - end.q_m[i]).abs();
            let band = plant.motor_friction.stiction[i] / 20.0;
            assert!(error < band + 5e-4, "{error} of {band} rad");
        }
        0.5 - end.q_m[1]
    });
    assert!(off.is_sorted_by(|a, b| a < b), "{off:?} rad");
}

/// Links that are pushed and left alone: in the same time, more friction takes more out of them.
#[test]
fn more_friction_takes_more() {
    let dissipated = [0.0, 0.25, 0.5, 1.0].map(|strength| {
        let plant =
            Plant { motor_friction: friction(strength), link_friction: friction(strength), ..two_link() };
        let start = Motion { v_l: Vector([1.0, -1.0]), ..at_rest() };
        Ride::new(&plant, start, STEP).on(0.2, [0.0; 2]).ledger.dissipated
    });
    assert!(dissipated.is_sorted_by(|a, b| a < b), "{dissipated:?} J");
}
