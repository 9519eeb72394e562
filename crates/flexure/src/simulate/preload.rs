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
    let [gravity, missing, deflection, acceleration] =
        sized!(roomy robot, L, N => springs(scenario, &pair::<L<f64>, N>(robot, robot)?[0]));
    let initial = &scenario.initial;
    let at_rest = initial.dq_l.iter().chain(&initial.dq_m).all(|&v| v == 0.0);
    let largest = |v: &[f64]| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let settle = scenario.smooth_start.map_or(0.0, |start| start.settle);
    let thrown = 3.0 / 28.0 * settle * settle * largest(&acceleration);
    let is_loaded = largest(&missing) <= NEGLIGIBLE * largest(&gravity).max(1.0);
    if !at_rest || is_loaded && thrown <= FAR {
        return Ok(None);
    }
    // To 1e-12 rad: of light links on stiff springs 1e-6 are a throw.
    let bent = initial.q_l.iter().zip(&deflection);
    let holding: Vec<f64> = bent.map(|(q, bent)| (1e12 * (q + bent)).round() / 1e12 + 0.0).collect();
    let consequence = if thrown > FAR {
        format!("links are thrown, and the smooth start follows them for up to {thrown:.2} rad")
    } else {
        "the first torques will be large".to_owned()
    };
    let message = format!(
        "at rest, the springs miss what gravity asks of them by up to {:.3} N m (N for a prismatic joint): \
         {consequence}",
        largest(&missing)
    );
    let help = format!("initial.q_m = {holding:?} rad holds the arm where q_l puts it");
    Ok(Some(scenario.places.problem("initial", "preload", message, help).warning()))
}

/// Gravity torque at the start, what the springs miss of it [N m], the deflections that would give it, in rad, and the accelerations
/// that follow [rad/s²].
fn springs<L, const N: usize>(scenario: &Scenario, robot: &Fjr<f64, L, N>) -> [Vec<f64>; 4]
where
    L: Links<f64, N> + Clone,
{
    let x = initial::<N>(scenario);
    let gravity = robot.links.gravity_torque(&x.q_l);
    let plant = plant(scenario, robot.clone());
    let of_joints = |v: Vector<f64, N>| v.iter().take(robot.links.joints()).collect();
    let motion = robot.link_motion(&robot.links.factor(&x.q_l), &x);
    let acceleration = motion.map(|jet| 2.0 * jet.coefficient(2));
    let missing = gravity - plant.spring_torque(&x);
    [gravity, missing, plant.deflection_under(&gravity), acceleration].map(of_joints)
}

/// How far a smooth start may follow links that springs throw, without a word, in rad.
const FAR: f64 = 0.05;

/// Part of the gravity torque that springs may miss without a word.
const NEGLIGIBLE: f64 = 0.01;
