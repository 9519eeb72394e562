//! A robot that is driven by the torque of its inverse dynamics, and by nothing else, follows the trajectory.

use flexure::plant::Plant;
use flexure::simulate::{Integrator, Ledger};
use flexure_core::linalg::Vector;
use flexure_core::model::{FeedForward, Fjr, Links, Motion};
use flexure_core::reference::{Reference, Sine};
use flexure_core::robots::{Body, JointKind, PlanarTwoLink, Tree};

/// Open loop for a second from the right initial state: largest deviation of a position or a velocity, and largest
/// deflection of a spring.
fn deviation<L: Links<f64, N> + Copy, const N: usize>(
    robot: &Fjr<f64, L, N>,
    reference: &Sine<f64, N>,
) -> (f64, f64) {
    let plan = |t: f64| -> (Motion<f64, N>, Vector<f64, N>) {
        let q_l = reference.at::<5>(t);
        let FeedForward { q_m, u_m, .. }: FeedForward<f64, N, 1, 3> = robot.inverse_dynamics(&q_l);
        let ([q_l, v_l, ..], [q_m, v_m, _], [u_m]) =
            (q_l.derivatives(), q_m.derivatives(), u_m.derivatives());
        (Motion { q_l, q_m, v_l, v_m }, u_m)
    };
    let plant = Plant::from(*robot);
    let (mut integrator, mut ledger) = (Integrator::new(1e-11), Ledger::default());
    let (mut x, _) = plan(0.0);
    let (mut worst, mut bent) = (0.0_f64, 0.0_f64);
    for k in 0..100 {
        let t = f64::from(k) * 0.01;
        x = integrator.advance(&plant, x, t, 0.01, &|t, _: &_| plan(t).1, &mut ledger).expect("smooth");
        let (planned, _) = plan(t + 0.01);
        let parts = [x.q_l - planned.q_l, x.q_m - planned.q_m, x.v_l - planned.v_l, x.v_m - planned.v_m];
        worst = parts.iter().flat_map(Vector::iter).fold(worst, |m, e| m.max(e.abs()));
        bent = x.deflection().iter().fold(bent, |m, e| m.max(e.abs()));
    }
    (worst, bent)
}

#[track_caller]
fn follows<L: Links<f64, N> + Copy, const N: usize>(robot: &Fjr<f64, L, N>, reference: &Sine<f64, N>) {
    let (worst, bent) = deviation(robot, reference);
    // Some thousand steps with local errors of 1e-11 of speeds of 10 rad/s.
    assert!(worst < 1e-8, "{worst} from the trajectory");
    assert!(bent > 0.01, "the springs bend: {bent}");
}

fn sine<const N: usize>() -> Sine<f64, N> {
    Sine {
        offset: Vector::from_fn(|i| 0.2 * i as f64),
        amplitude: Vector::from_fn(|i| 0.5 - 0.1 * i as f64),
        frequency: Vector::from_fn(|i| 4.0 + i as f64),
        phase: Vector::from_fn(|i| 0.7 * i as f64),
    }
}

#[test]
fn the_paper_s_arm() {
    let robot = Fjr {
        links: PlanarTwoLink::new([1.510, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.23, 0.01]),
        stiffness: Vector([9.0, 4.0]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([0.2, 90.0]),
    };
    follows(&robot, &sine());
}

/// Two branches, one of them with a prismatic joint, under gravity.
#[test]
fn a_branched_tree_under_gravity() {
    let body = |parent, kind, axis| Body {
        parent,
        kind,
        axis,
        rotation: [[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]],
        translation: [0.1, 0.05, 0.2],
        mass: 1.2,
        com: [0.03, -0.02, -0.1],
        inertia: [[0.02, 0.001, 0.002], [0.001, 0.03, 0.003], [0.002, 0.003, 0.01]],
    };
    let bodies = [
        body(None, JointKind::Revolute, [0.0, 0.0, 1.0]),
        body(Some(0), JointKind::Revolute, [0.0, 1.0, 0.0]),
        body(Some(0), JointKind::Prismatic, [0.6, 0.0, 0.8]),
        body(Some(1), JointKind::Revolute, [1.0, 0.0, 0.0]),
    ];
    let robot = Fjr {
        links: Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("parents come first"),
        motor_inertia: Vector([0.2, 0.1, 0.3, 0.05]),
        stiffness: Vector([100.0, 80.0, 500.0, 60.0]),
        link_damping: Vector([0.2; 4]),
        motor_damping: Vector([0.5; 4]),
    };
    follows(&robot, &sine());
}
