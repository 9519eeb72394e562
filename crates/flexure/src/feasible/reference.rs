//! The reference of a scenario as it is followed: at the speed that was found for it, from the motion that the robot has.

use flexure_core::scalar::{Interval, Jet, Scalar};

use crate::feasible::speed;
use crate::files::Problems;
use crate::references::{AnyReference, Plan, Speed};
use crate::robot::Arm;
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
    AnyReference::at_speed(&plan(scenario), speed, &|x| x, || {
        Ok(initial_motion(&*scenario.robot.arm()?, &scenario.initial, &|x| x))
    })
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
    let motion = || {
        let arm = scenario.robot.enclosed_arm()?;
        Ok(initial_motion(&*arm, &scenario.initial, &|x| scenario.bounds(x)))
    };
    AnyReference::at_speed(&plan(scenario), speed, &|x| scenario.bounds(x), motion)
}

fn plan(scenario: &Scenario) -> Plan<'_> {
    let Scenario { reference, time_scaling, smooth_start, places, .. } = scenario;
    Plan { reference, time_scaling: *time_scaling, smooth_start: *smooth_start, places }
}

/// The links' motion when a scenario begins, to the jerk: what the state says, by the model that the law has.
fn initial_motion<C: Scalar>(
    arm: &dyn Arm<C>,
    initial: &Initial,
    number: &dyn Fn(f64) -> C,
) -> Vec<Jet<C, 4>> {
    let Initial { q_l, q_m, dq_l, dq_m } = initial;
    let motion: Vec<C> = [q_l, q_m, dq_l, dq_m].into_iter().flatten().map(|&x| number(x)).collect();
    let mut series = vec![[C::ZERO; 4]; arm.joints()];
    arm.link_motion(&motion, &mut series).expect("the reader has checked the lengths");
    series.into_iter().map(Jet::new).collect()
}
