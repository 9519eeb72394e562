//! Torques that no model knows.

use flexure_core::control::{
    Applied, ControlLaw, DisturbanceRejecting, DynamicLaw, ImmersionInvariance, Running,
};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::scalar::Jet;

use crate::all::immersion;
use crate::common::Numbers;
use crate::common::plant::{Arm, Push, advance, plausible_arm};

/// A constant torque on the links, which no motor reaches at once, and one on the motors leave no error at rest; without the residuals they do.
#[test]
fn leave_no_error() {
    let robot: Arm = plausible_arm();
    let push = Push { link: Vector([0.5, -0.2]), motor: Vector([0.3, 0.1]) };
    let (goal, period) = (Vector([0.5, -0.4]), 1e-3);
    let q_ld = goal.map(Jet::value);
    let inner: ImmersionInvariance<f64, 2> = immersion(&mut Numbers(3));
    let off = |x: &Motion<f64, 2>| (x.q_l - goal).iter().fold(0.0_f64, |m, e| m.max(e.abs()));

    let law = DisturbanceRejecting { law: inner, bandwidth: Vector([20.0; 2]) };
    let mut x = Motion::at_rest(Vector::ZERO);
    let mut running = Running::start(&law, &robot, &x, &q_ld);
    let mut applied = Applied::NOTHING;
    for k in 0..8000 {
        if k > 0 {
            running.advance(&law, &robot, &x, &q_ld, &applied, period);
        }
        applied = Applied::fully(law.torque(&robot, &x, &q_ld, &running.memory));
        x = advance(&robot, &x, &applied.given, &push, period, 10);
    }
    assert!(off(&x) < 1e-6, "{}", off(&x));

    let mut x = Motion::at_rest(Vector::ZERO);
    for _ in 0..8000 {
        x = advance(&robot, &x, &inner.torque(&robot, &x, &q_ld), &push, period, 10);
    }
    assert!(off(&x) > 1e-3, "{}", off(&x));
}
