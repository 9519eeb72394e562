//! On the reference every law asks for the torque that keeps the links there, and for nothing else.

use flexure_core::control::{ControlLaw, FeedforwardPd, Pd, TorqueFeedback};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::common::laws::{self, nominal, resting};
use crate::common::{Numbers, branched, close, flexible, gains, linear, planar, serial};

/// What cancels on the way are terms of a hundred times the torque, after solving with masses of condition 1e3.
const ROUNDING: f64 = 1e-10;

fn holds<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &impl ControlLaw<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) {
    let (x, u_m) = nominal(robot, q_ld);
    close(&law.torque(robot, &x, q_ld), &u_m, ROUNDING);
}

fn every_law_holds<L: Links<f64, N>, const N: usize>(links: fn() -> L, seed: u64) {
    let r = &mut Numbers(seed);
    for _ in 0..5 {
        let mut robot = flexible(links(), r);
        let moving = r.series(1.0);
        holds(&robot, &gains(linear, false, r), &moving);
        holds(&robot, &laws::feedback_linearization(r), &moving);
        holds(&robot, &laws::feedforward_pd(r), &moving);
        holds(&robot, &laws::integral_manifold(r), &moving);
        holds(&robot, &laws::passivity(r), &moving);
        holds(&robot, &laws::esp(r), &moving);
        holds(&robot, &laws::backstepping(r), &moving);
        holds(&robot, &laws::cascade(r), &moving);
        // Regulators, at rest. Springs stiff enough for the fixed point of the resting links.
        robot.stiffness = robot.stiffness.scaled(20.0);
        let resting = resting(&r.vector(1.0));
        holds(&robot, &laws::pd(r), &resting);
        holds(&robot, &laws::pd_online_gravity(r), &resting);
        holds(&robot, &laws::torque_feedback(r), &resting);
        holds(&robot, &laws::gravity_cancellation(r), &resting);
        holds(&robot, &laws::singular_perturbation(r), &resting);
    }
}

#[test]
fn planar_arm() {
    every_law_holds(planar, 1);
}

#[test]
fn branched_tree_under_gravity() {
    every_law_holds(|| branched::<5>(2), 2);
}

#[test]
fn serial_arm_under_gravity() {
    every_law_holds(serial::<4>, 3);
}

/// Laws for rigid robots are wrong on a flexible one in proportion to the compliance.
fn misses_by_the_compliance<const N: usize>(law: &impl ControlLaw<f64, N>, r: &mut Numbers) {
    let (mut robot, q_ld) = (flexible(branched::<N>(2), r), r.series(1.0));
    let mut miss = |stiffness: f64| {
        robot.stiffness = Vector([stiffness; N]);
        let (x, u_m) = nominal(&robot, &q_ld);
        let miss = law.torque(&robot, &x, &q_ld) - u_m;
        miss.dot(&miss).sqrt()
    };
    let misses = [1e4, 1e5, 1e6].map(&mut miss);
    assert!(misses[0] > 1e-3, "{misses:?}");
    for pair in misses.windows(2) {
        // Second order in the compliance is a hundredth of the first at these stiffnesses.
        assert!((pair[0] / pair[1] - 10.0).abs() < 1.0, "{misses:?}");
    }
}

#[test]
fn rigid_laws_miss_by_the_compliance() {
    let r = &mut Numbers(4);
    misses_by_the_compliance(&laws::rigid::<5>(r), r);
    misses_by_the_compliance(&laws::singular_perturbation::<5>(r), r);
}

/// Where the reference rests, the nominal torque is gravity: the law is Tomei's, off the reference too.
#[test]
fn feed_forward_of_rest_is_gravity() {
    let r = &mut Numbers(6);
    for _ in 0..10 {
        let (robot, motor) = (flexible(branched::<5>(2), r), laws::motor(r));
        let (x, q_ld) = (r.motion(1.0), resting(&r.vector(1.0)));
        let pd = Pd { motor }.torque(&robot, &x, &q_ld);
        close(&FeedforwardPd { motor }.torque(&robot, &x, &q_ld), &pd, ROUNDING);
    }
}

/// On moving references the feedback of a regulator is about motors that move with the goal: there gains do not matter.
#[test]
fn regulators_move_with_the_goal() {
    let r = &mut Numbers(5);
    for _ in 0..10 {
        let robot = flexible(branched::<5>(2), r);
        let q_ld = r.series::<5, 5>(1.0);
        let q = q_ld.map(|q| q.truncate::<2>());
        let motors = q + robot.stiffness.map(f64::recip).diag_mul(&robot.links.gravity_torque(&q));
        let ([q_l, v_l], [q_m, v_m]) = (q.derivatives(), motors.derivatives());
        let x = Motion { q_l, q_m, v_l, v_m };
        let mut twice = |law: &mut dyn FnMut(&mut Numbers) -> Vector<f64, 5>| {
            let (a, b) = (law(r), law(r));
            close(&a, &b, ROUNDING);
        };
        twice(&mut |r| laws::pd(r).torque(&robot, &x, &q_ld));
        twice(&mut |r| laws::pd_online_gravity(r).torque(&robot, &x, &q_ld));
        twice(&mut |r| laws::gravity_cancellation(r).torque(&robot, &x, &q_ld));
        twice(&mut |r| {
            let inertia = Vector([0.05; 5]);
            TorqueFeedback { inertia, ..laws::torque_feedback(r) }.torque(&robot, &x, &q_ld)
        });
    }
}
