//! From a scenario to what is simulated: plant, controller and everything in between.

use std::borrow::Cow;

use flexure_core::estimate::DisturbanceObserver;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion, RotorCoupling};
use flexure_core::reference::Reference;

use crate::estimators::{AnyEstimator, estimator};
use crate::imperfections::{Effects, Imperfection, Saturation};
use crate::plant::{Plant, Push};
use crate::robot::{Robot, padded, vector};
use crate::scenario::{self, Scenario};
use crate::simulate::controller::{Compensation, Controller};
use crate::simulate::feedback::Feedback;
use crate::simulate::guard_settings::{guarded, watchdog};
use crate::simulate::signals::Columns;
use crate::simulate::simulation::{Hold, Timing};
use crate::simulate::stepping::Stepping;

/// Tolerated local error of the integrator of smooth plants, relative to the joint speeds, where a scenario says nothing else.
pub const TOLERANCE: f64 = scenario::TOLERANCE;

/// Longest step in s of the integrator of plants with dry friction, play or hysteresis.
pub(crate) const LONGEST_STEP: f64 = Stepping::<1>::STEP;

/// Times and tolerances of the loop.
pub(crate) fn timing(scenario: &Scenario) -> Timing {
    let hold = match scenario.hold {
        scenario::Hold::ZeroOrder => Hold::ZeroOrder,
        scenario::Hold::Continuous => Hold::Continuous,
    };
    Timing { hold, integration: scenario.integration, ..Timing::sampled(scenario.control_period) }
}

/// What can be read of the loop beside the motion; `errors` says whether its law computes those of v-CBC.
pub(crate) fn columns(scenario: &Scenario, errors: bool) -> Columns {
    let Scenario { imperfections, estimator, disturbance_observer, guard, .. } = scenario;
    Columns {
        errors,
        devices: imperfections.iter().any(Imperfection::is_of_devices)
            || estimator.is_some()
            || disturbance_observer.is_some()
            || guard.is_some()
            || scenario.drive_limits().is_some(),
        guard: guard.is_some(),
    }
}

/// The initial motion of the scenario.
pub(crate) fn initial<const N: usize>(scenario: &Scenario) -> Motion<f64, N> {
    let initial = &scenario.initial;
    Motion {
        q_l: vector(&initial.q_l),
        q_m: vector(&initial.q_m),
        v_l: vector(&initial.dq_l),
        v_m: vector(&initial.dq_m),
    }
}

/// What the imperfections of the scenario do.
fn effects(scenario: &Scenario) -> Effects<'_> {
    let Scenario { imperfections, robot, control_period, seed, .. } = scenario;
    Effects::of(imperfections, robot.joint_count(), *control_period, *seed)
}

/// The imperfections of the scenario, and drives that saturate at the robot's torque limits where it says nothing else of them.
fn acting(scenario: &Scenario) -> Cow<'_, [Imperfection]> {
    let own = &scenario.imperfections;
    match scenario.drive_limits() {
        Some(limit) if !own.iter().any(|imperfection| imperfection.of::<Saturation>().is_some()) => {
            let implied = Imperfection::Saturation(Saturation { limit });
            own.iter().cloned().chain([implied]).collect()
        }
        _ => Cow::Borrowed(own),
    }
}

/// The robot that is simulated: the scenario's, but for its model errors.
pub(crate) fn simulated(scenario: &Scenario) -> Robot {
    effects(scenario).simulated(&scenario.robot)
}

/// The simulated robot with what the law does not know of its joints.
pub(crate) fn plant<L, const N: usize>(scenario: &Scenario, robot: Fjr<f64, L, N>) -> Plant<L, N> {
    let scenario::Plant { rotor_coupling, spring_hardening, unlimited: _ } = &scenario.plant;
    let mut plant = Plant {
        spring_hardening: spring_hardening.as_deref().map_or(Vector::ZERO, vector),
        rotor_coupling: rotor_coupling
            .as_deref()
            .map(|gears| RotorCoupling::new(&robot.motor_inertia, &padded(gears, 1.0))),
        ..Plant::from(robot)
    };
    effects(scenario).depart(&mut plant);
    plant
}

/// What pushes the links.
pub(crate) fn pushes<const N: usize>(scenario: &Scenario) -> Vec<Push<N>> {
    effects(scenario).pushes()
}

/// The law with everything between it and the robot, started at `x` with the springs holding the links.
pub(crate) fn controller<L, R, F, const N: usize>(
    scenario: &Scenario,
    robot: Fjr<f64, L, N>,
    reference: R,
    law: F,
    x: &Motion<f64, N>,
) -> Controller<L, R, F, AnyEstimator<f64, N>, N>
where
    L: Links<f64, N>,
    R: Reference<f64, N>,
    F: Feedback<L, N>,
{
    let period = scenario.control_period;
    let acting = acting(scenario);
    let Effects { sensors, computer, mut actuator, velocities, .. } =
        Effects::of(&acting, scenario.robot.joint_count(), period, scenario.seed);
    // Until the first command arrives the motors are held where they are.
    let before = robot.spring_torque(&x.q_l, &x.q_m);
    let mut controller = Controller::new(robot, reference, law);
    actuator.start(&before);
    controller.sensors = sensors;
    controller.watchdog = (!computer.is_in_time()).then(|| watchdog(scenario.guard.as_ref(), period, before));
    controller.computer = computer;
    controller.actuator = actuator;
    controller.estimator = estimator(scenario.estimator.as_ref(), velocities, period);
    controller.disturbance = scenario.disturbance_observer.as_ref().map(|settings| Compensation {
        observer: DisturbanceObserver::new(&padded(&settings.bandwidth, 1.0), period)
            .expect("bandwidths are above 0"),
        compensate: settings.compensate,
    });
    controller.guard = scenario.guard.as_ref().map(|settings| guarded(settings, period, before));
    controller.start(x, before);
    controller
}

/// The torque limits that act, the guard's and the drives', infinite where there is none, per joint [N m].
pub(crate) fn acting_limits(scenario: &Scenario) -> Vec<f64> {
    let guard = scenario.guard.as_ref().map(|guard| guard.torque_limit.clone());
    let acting = [guard, scenario.drive_limits()];
    let least = |i: usize| acting.iter().flatten().fold(f64::INFINITY, |least, limit| least.min(limit[i]));
    (0..scenario.robot.joint_count()).map(least).collect()
}
