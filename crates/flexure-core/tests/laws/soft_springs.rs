//! A law for stiff springs is one.

use flexure_core::control::{CompositePh, ControlLaw};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::reference::{Reference, Sine};

use crate::common::plant::{Arm, Push, advance, paper_arm, plausible_arm};

/// The law with the gains of the golden file on `robot`.
fn law(robot: &Arm) -> CompositePh<f64, 2> {
    CompositePh {
        shaping: Vector([4.0; 2]),
        metric: Vector([6.0, 3.0]),
        damping: Vector([2.0, 1.0]),
        fast_stiffness: robot.stiffness.scaled(0.5),
        fast_damping: Vector::from_fn(|i| (robot.stiffness[i] * robot.motor_inertia[i]).sqrt()),
    }
}

/// The largest error of the links in the last tenth of `duration` in s.
fn error(robot: &Arm, duration: u32) -> f64 {
    let reference = Sine { amplitude: Vector([1.0; 2]), frequency: Vector([0.6; 2]), ..Sine::ZERO };
    let (law, period) = (law(robot), 1e-4);
    let mut x = Motion::at_rest(Vector::ZERO);
    let steps = duration * 10_000;
    let mut worst = 0.0_f64;
    for k in 0..steps {
        let q_ld = reference.at(f64::from(k) * period);
        if 10 * k > 9 * steps {
            let apart = x.q_l - q_ld.map(|q| q.coefficient(0));
            worst = apart.iter().fold(worst, |m, e| m.max(e.abs()));
        }
        x = advance(robot, &x, &law.torque(robot, &x, &q_ld), &Push::NONE, period, 2);
        if x.q_l.iter().any(|q| q.is_nan() || q.abs() > 1e3) {
            return f64::INFINITY;
        }
    }
    worst
}

#[test]
fn the_error_of_the_composite_law_falls_as_the_compliance() {
    let robot = plausible_arm();
    let errors = [1.0, 10.0, 100.0]
        .map(|factor| error(&Arm { stiffness: robot.stiffness.scaled(factor), ..robot }, 20));
    for pair in errors.windows(2) {
        // The transient still has a share at the stiffest.
        assert!((4.0..15.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    // The theorem's limit: on the paper's arm, with soft springs and a hard damper, the loop is unstable.
    assert!(error(&paper_arm(), 10) > 1.0);
}
