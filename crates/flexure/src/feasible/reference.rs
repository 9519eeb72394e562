//! The reference of a scenario as it is followed: at the speed that was found for it, from the motion that the robot has.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Interval, Jet, Over};

use crate::feasible::speed;
use crate::files::Problems;
use crate::references::{AnyReference, Plan, Speed};
use crate::robot::{RobotVisitor, vector, with_enclosed_robot, with_robot};
use crate::scenario::{Initial, Scenario};

/// The reference of a scenario, at the speed of its time scaling, with its smooth start from the robot's initial motion.
///
/// # Errors
/// If there is no spline through the samples, the robot has too many joints, or no speed keeps it inside its limits.
pub fn reference<const N: usize>(scenario: &Scenario) -> Result<AnyReference<f64, N>, Problems> {
    at_speed(scenario, speed(scenario)?)
}

/// The reference of a scenario at the speed of its time scaling, if it has one, replaced by `speed`.
pub(crate) fn at_speed<const N: usize>(
    scenario: &Scenario,
    speed: f64,
) -> Result<AnyReference<f64, N>, Problems> {
    AnyReference::at_speed(&plan(scenario), speed, &|x| x, || initial_motion(scenario))
}

/// The reference of a scenario with its decimals enclosed, smooth start and initial motion too. A speed that was searched for
/// is the float that was found.
///
/// # Errors
/// As for [`reference()`].
pub fn enclosed_reference<const N: usize>(
    scenario: &Scenario,
) -> Result<AnyReference<Interval, N>, Problems> {
    let speed = match scenario.time_scaling.map(|scaling| scaling.speed) {
        Some(Speed::Given(speed)) => scenario.bounds(speed),
        Some(Speed::Within(_)) | None => Interval::point(speed(scenario)?),
    };
    let motion = || enclosed_initial_motion(scenario);
    AnyReference::at_speed(&plan(scenario), speed, &|x| scenario.bounds(x), motion)
}

fn plan(scenario: &Scenario) -> Plan<'_> {
    let Scenario { reference, time_scaling, smooth_start, places, .. } = scenario;
    Plan { reference, time_scaling: *time_scaling, smooth_start: *smooth_start, places }
}

/// The links' motion when a scenario begins, to the jerk: what the state says, by the model that the law has.
fn initial_motion(scenario: &Scenario) -> Result<Vec<Jet<f64, 4>>, Problems> {
    with_robot(&scenario.robot, Start { initial: &scenario.initial, number: &|x| x })
}

/// The same enclosed.
fn enclosed_initial_motion(scenario: &Scenario) -> Result<Vec<Jet<Interval, 4>>, Problems> {
    let start = Start { initial: &scenario.initial, number: &|x| scenario.bounds(x) };
    with_enclosed_robot(&scenario.robot, start)
}

/// The conversion stands behind a reference: one type a number, or every joint count would compile this for every robot.
struct Start<'a, C> {
    initial: &'a Initial,
    number: &'a dyn Fn(f64) -> C,
}

impl<C: Over<C>> RobotVisitor<C> for Start<'_, C> {
    type Output = Vec<Jet<C, 4>>;

    fn visit<L: Links<C, N> + Sync, const N: usize>(self, robot: Fjr<C, L, N>) -> Vec<Jet<C, 4>> {
        let numbers = |values: &[f64]| -> Vector<C, N> { vector(values).map(self.number) };
        let Initial { q_l, q_m, dq_l, dq_m } = self.initial;
        let x = Motion { q_l: numbers(q_l), q_m: numbers(q_m), v_l: numbers(dq_l), v_m: numbers(dq_m) };
        robot.link_motion(&robot.links.factor(&x.q_l), &x).0.to_vec()
    }
}
