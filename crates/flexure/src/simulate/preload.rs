//! Do the springs carry gravity when a run begins?

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};

use crate::files::{Problem, Problems};
use crate::robot::{RobotVisitor, with_robot};
use crate::scenario::Scenario;
use crate::simulate::assembly::{initial, plant};

/// A warning if the robot starts at rest with springs that do not carry it: the law answers with torques that are
/// large, because what it wants of a spring passes through the motor's inertia within milliseconds.
///
/// # Errors
/// If the robot has more joints than this program was built for.
pub fn preload(scenario: &Scenario) -> Result<Option<Problem>, Problems> {
    with_robot(&scenario.robot, Preload { scenario })
}

struct Preload<'a> {
    scenario: &'a Scenario,
}

impl RobotVisitor for Preload<'_> {
    type Output = Option<Problem>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Option<Problem> {
        let x = initial::<N>(self.scenario);
        let at_rest = x.v_l.iter().chain(x.v_m.iter()).all(|v| v == 0.0);
        let gravity = robot.links.gravity_torque(&x.q_l);
        let plant = plant(self.scenario, robot);
        let missing = gravity - plant.spring_torque(&x);
        let largest = |v: &Vector<f64, N>| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if !at_rest || largest(&missing) <= NEGLIGIBLE * largest(&gravity).max(1.0) {
            return None;
        }
        let holding = x.q_l + plant.deflection_under(&gravity);
        let message = format!(
            "at rest, the springs miss what gravity asks of them by up to {:.3} N m (N for a prismatic joint): the first \
             torques will be large",
            largest(&missing)
        );
        let help = format!("initial.q_m = {:.6?} rad holds the arm where q_l puts it", holding.0);
        Some(self.scenario.places.problem("initial", "preload", message, help).warning())
    }
}

/// Part of the gravity torque that springs may miss without a word.
const NEGLIGIBLE: f64 = 0.01;
