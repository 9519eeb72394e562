//! Do the springs carry gravity when a run begins?

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};

use crate::files::{Problem, Problems};
use crate::robot::sized::{pair, sized};
use crate::scenario::Scenario;
use crate::simulate::assembly::{initial, plant};

/// A warning if the robot starts at rest with springs that do not carry it: the law answers with torques that are
/// large, because what it wants of a spring passes through the motor's inertia within milliseconds.
///
/// # Errors
/// If the robot has more joints than this program was built for.
pub fn preload(scenario: &Scenario) -> Result<Option<Problem>, Problems> {
    let robot = &scenario.robot;
    let [gravity, missing, deflection] =
        sized!(robot, L, N => springs(scenario, &pair::<L<f64>, N>(robot, robot)?[0]));
    let initial = &scenario.initial;
    let at_rest = initial.dq_l.iter().chain(&initial.dq_m).all(|&v| v == 0.0);
    let largest = |v: &[f64]| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !at_rest || largest(&missing) <= NEGLIGIBLE * largest(&gravity).max(1.0) {
        return Ok(None);
    }
    let holding: Vec<f64> = initial.q_l.iter().zip(&deflection).map(|(q, bent)| q + bent).collect();
    let message = format!(
        "at rest, the springs miss what gravity asks of them by up to {:.3} N m (N for a prismatic joint): the first \
         torques will be large",
        largest(&missing)
    );
    let help = format!("initial.q_m = {holding:.6?} rad holds the arm where q_l puts it");
    Ok(Some(scenario.places.problem("initial", "preload", message, help).warning()))
}

/// Gravity torque at the start, what the springs miss of it [N m], and the deflections that would give it, in rad.
fn springs<L, const N: usize>(scenario: &Scenario, robot: &Fjr<f64, L, N>) -> [Vec<f64>; 3]
where
    L: Links<f64, N> + Clone,
{
    let x = initial::<N>(scenario);
    let gravity = robot.links.gravity_torque(&x.q_l);
    let plant = plant(scenario, robot.clone());
    let of_joints = |v: Vector<f64, N>| v.iter().take(robot.links.joints()).collect();
    [gravity, gravity - plant.spring_torque(&x), plant.deflection_under(&gravity)].map(of_joints)
}

/// Part of the gravity torque that springs may miss without a word.
const NEGLIGIBLE: f64 = 0.01;
