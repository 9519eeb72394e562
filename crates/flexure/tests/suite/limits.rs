//! Limits of the robot that a run exceeds.

use flexure::scenario::load_scenario;
use flexure::simulate::exceeded;
use flexure::simulate::run;

/// A pendulum that follows 0.5 sin 3t exceeds exactly the limits that this motion does.
#[test]
fn a_run_says_which_limits_it_exceeds_and_when() {
    let mut scenario = load_scenario("pendulum-tanh").unwrap();
    let found = run(&scenario, &flexure::progress::unwatched).unwrap();
    assert!(exceeded(&scenario.robot, &found.trace).is_empty(), "no limits, nothing exceeded");

    let largest = |name: &str| found.trace.column(name).unwrap().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let highest = found.trace.column("q_l1").unwrap().iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let limits = &mut scenario.robot.limits;
    (limits.velocity[0], limits.upper[0]) = (0.999 * largest("dq_l1"), highest + 1e-9);
    let warnings = exceeded(&scenario.robot, &found.trace);
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert!(warning.is_warning() && warning.to_string().contains("link velocity exceeds velocity_limit"));
    scenario.robot.limits.upper[0] = highest - 1e-9;
    scenario.robot.limits.lower[0] = -1e3;
    scenario.robot.limits.deflection[0] = 1e-9;
    let warnings = exceeded(&scenario.robot, &found.trace);
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert!(warnings[0].to_string().contains(&format!("{highest:.4} rad at worst")), "{}", warnings[0]);
}
