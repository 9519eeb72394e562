//! References and the limits of robots: closed forms, and what a simulated run does.

use flexure::feasible::{exceeded, slowed, speed, usage};
use flexure::files::{Problems, SCENARIOS};
use flexure::references::{PointToPoint, Profile, Reference, Sines, SmoothStart, Speed, TimeScaling};
use flexure::robot::load_robot;
use flexure::scenario::load_scenario;
use flexure::scenario::{Hold, Scenario};
use flexure::simulate::run;

/// The pendulum, weightless, on its sine, without smooth start: a linear drive.
fn weightless() -> Scenario {
    let mut scenario = load_scenario("pendulum-tanh").expect("built in");
    scenario.robot.gravity = [0.0; 3];
    scenario.smooth_start = None;
    scenario
}

fn within(margin: f64) -> TimeScaling {
    TimeScaling { speed: Speed::Within(margin), rise: None }
}

/// Amplitudes of torque, torque rate, velocity and deflection on amplitude sin(ω t): with s = iω the link asks the spring for
/// (J s² + D_l s) q, the motor stands at q plus that over K, and takes (M s² + D_m s) times its position and the spring.
fn amplitudes(scenario: &Scenario, omega: f64) -> [f64; 4] {
    let robot = &scenario.robot;
    let inertia = 0.0044492 + 0.403 * 0.06 * 0.06;
    let spring = (-inertia * omega * omega, robot.link_damping[0] * omega);
    let motor = (-robot.motor_inertia[0] * omega * omega, robot.motor_damping[0] * omega);
    let bent = (spring.0 / robot.stiffness[0], spring.1 / robot.stiffness[0]);
    let at = (1.0 + bent.0, bent.1);
    let torque = (motor.0 * at.0 - motor.1 * at.1 + spring.0, motor.0 * at.1 + motor.1 * at.0 + spring.1);
    let Reference::Sines(Sines { terms, .. }) = &scenario.reference else { panic!("a sine") };
    let amplitude = terms[0].amplitude[0];
    let torque = torque.0.hypot(torque.1) * amplitude;
    [torque, omega * torque, omega * amplitude, bent.0.hypot(bent.1) * amplitude]
}

fn limits(scenario: &mut Scenario) -> [&mut f64; 4] {
    let limits = &mut scenario.robot.limits;
    [&mut limits.torque[0], &mut limits.torque_rate[0], &mut limits.velocity[0], &mut limits.deflection[0]]
}

#[test]
fn usage_of_a_sine_is_its_amplitude() {
    let mut scenario = weightless();
    let expected = amplitudes(&scenario, 2.0);
    limits(&mut scenario).into_iter().zip(expected).for_each(|(limit, used)| *limit = 2.0 * used);
    let found = usage(&scenario).expect("one joint");
    assert_eq!(
        found.iter().map(|usage| usage.key).collect::<Vec<_>>(),
        ["torque_limit", "torque_rate_limit", "velocity_limit", "deflection_limit"]
    );
    for (usage, expected) in found.iter().zip(expected) {
        // The top of a parabola through samples 1 ms apart: off by a microsecond, second order in that.
        assert!((usage.value.abs() - expected).abs() < 1e-9 * expected, "{usage:?}, expected {expected}");
        assert!((usage.share - 0.5).abs() < 1e-9);
    }
    assert!(exceeded(&scenario, &found).is_empty());
}

/// A limit that is used to nine tenths at 0.6 of the speed gives that speed, whichever it is.
#[test]
fn the_speed_is_that_of_the_closed_form() {
    for k in 0..4 {
        let mut scenario = weightless();
        scenario.time_scaling = Some(within(0.9));
        let at_limit = amplitudes(&scenario, 0.6 * 2.0)[k];
        *limits(&mut scenario)[k] = at_limit / 0.9;
        let found = speed(&scenario).expect("there is one");
        // 14 halvings of steps of 10 %.
        assert!(found <= 0.6 * (1.0 + 1e-9) && found > 0.6 - 1e-5, "limit {k}: {found}");
        let largest = usage(&scenario).expect("one joint")[0].share;
        assert!(largest <= 0.9 * (1.0 + 1e-9) && largest > 0.8999, "{largest}");
    }
}

#[test]
fn tighter_limits_are_slower() {
    let mut scenario = load_scenario("planar-2r-tanh").expect("built in");
    scenario.smooth_start = None;
    scenario.time_scaling = Some(within(0.9));
    let mut before = f64::INFINITY;
    for limit in [1000.0, 50.0, 46.0, 43.0, 40.0] {
        scenario.robot.limits.torque = vec![limit; 2];
        let found = speed(&scenario).expect("still, it takes 34.4 N m");
        assert!(found < before, "{found} with {limit} N m, {before} with more");
        assert!(usage(&scenario).expect("two joints").iter().all(|usage| usage.share <= 0.9 + 1e-9));
        before = found;
    }
    assert!(before < 0.8, "the limits matter: {before}");
}

/// sin t on the plausible arm, its clock from rest: the reference of a robot that stands on it.
fn plausible() -> Scenario {
    let mut scenario = load_scenario("two-link-tanh").expect("built in");
    scenario.robot = load_robot("two-link-plausible").expect("built in");
    scenario.time_scaling = Some(TimeScaling { speed: Speed::Within(0.8), rise: Some(2.0) });
    scenario.hold = Hold::Continuous;
    scenario
}

#[test]
fn a_run_on_the_reference_stays_inside_too() {
    let scenario = plausible();
    let found = speed(&scenario).expect("there is one");
    assert!((found - 0.6517).abs() < 1e-4, "{found}");
    let run = run(&scenario, &flexure::progress::unwatched).expect("two joints");
    let torques = run.trace.joints("u_m");
    for (usage, torques) in usage(&scenario).expect("two joints").iter().zip(&torques) {
        let largest = torques.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        // The loop tracks the reference to 1e-9 rad; its torque at the instants of the law is that of inverse dynamics.
        assert!((largest - usage.value.abs()).abs() < 1e-5, "{largest} in the run, {usage:?}");
        assert!(largest <= 0.8 * usage.limit + 1e-6);
    }
    // Not so without: joint 2 would need 1.64 of its limit.
    let mut fast = scenario;
    (fast.time_scaling, fast.smooth_start) = (None, Some(SmoothStart::within(2.0)));
    let problems = exceeded(&fast, &usage(&fast).expect("two joints"));
    assert_eq!(problems.len(), 1);
    assert!(problems[0].to_string().contains("joint2: motor torque of 2.7463 N m"), "{}", problems[0]);
}

/// A robot that moves, its springs loaded, is on its reference from the first instant on.
#[test]
fn a_run_from_a_robot_in_motion_starts_without_error() {
    let mut scenario = plausible();
    scenario.time_scaling = Some(TimeScaling { speed: Speed::Given(0.5), rise: None });
    scenario.smooth_start = Some(SmoothStart { duration: 2.0, settle: 0.3 });
    scenario.duration = 3.0;
    scenario.initial.q_l = vec![0.2, -0.1];
    scenario.initial.q_m = vec![0.25, -0.12];
    scenario.initial.dq_l = vec![0.5, -0.3];
    scenario.initial.dq_m = vec![0.4, 0.2];
    let summary = run(&scenario, &flexure::progress::unwatched).expect("two joints").summary;
    // What rounding in positions of 0.3 rad leaves, through motors of up to 1e4 1/s.
    assert!(summary.max_abs_e_l < 1e-10, "{summary:?}");
}

fn refused(scenario: &Scenario, message: &str, help: &str) {
    let problems: Problems = speed(scenario).expect_err("there is none");
    let problem = problems.iter().next().expect("one");
    assert!(problem.to_string().contains(message), "{problem}");
    assert!(problem.hint().contains(help), "{}", problem.hint());
}

#[test]
fn limits_that_no_speed_keeps_are_refused_with_the_number() {
    // Still, the shoulder carries both links: 4 · 9.81 (0.3 cos q_1 + 0.4 cos q_1 + 0.3 cos(q_1 + q_2)) N m.
    let mut scenario = load_scenario("planar-2r-tanh").expect("built in");
    scenario.smooth_start = None;
    scenario.time_scaling = Some(within(0.9));
    scenario.robot.limits.torque = vec![30.0, 200.0];
    let still = 4.0 * 9.81 * (0.7 * 0.5_f64.cos() + 0.3 * 0.5_f64.cos());
    assert!(still > 34.0);
    refused(&scenario, &format!("shoulder: motor torque of {:.1}", 34.4), "torque_limit = 38.");
    scenario.robot.limits.torque = vec![f64::INFINITY; 2];
    assert!((speed(&scenario).expect("no limits") - 1.0).abs() < f64::EPSILON);
    scenario.robot.limits.upper = vec![0.4, 3.0];
    refused(&scenario, "shoulder: link position of 0.5", "no speed mends that");
    let mut scenario = weightless();
    scenario.time_scaling = Some(within(0.9));
    scenario.robot.limits.torque = vec![100.0];
    scenario.reference = Reference::PointToPoint(PointToPoint {
        profile: Profile::Quintic,
        from: vec![0.0],
        to: vec![1.0],
        start: 1.0,
        duration: 3.0,
    });
    refused(&scenario, "motor torque of inf", "take nonic");
}

/// The scenarios of the paper are for a robot without limits.
#[test]
fn every_shipped_scenario_stays_inside_its_limits() {
    let mut limited = 0;
    for (name, _) in SCENARIOS {
        let scenario = load_scenario(name).expect("built in");
        let usage = usage(&scenario).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        assert!(usage.iter().all(|usage| usage.share <= 1.0), "{name}: {usage:?}");
        assert!(!(name.starts_with("two-link") && scenario.robot.name == "quanser-2dof") || usage.is_empty());
        limited += usize::from(!usage.is_empty());
    }
    assert!(limited >= 2, "panda and planar-2r have limits");
}

/// What hardly moves follows easily: it is said, with the limit that leaves so little, and nothing of a motion.
#[test]
fn a_reference_that_hardly_moves_is_said() {
    let mut scenario = load_scenario("panda-tanh-smooth").unwrap();
    for (speed, said) in [(1.0, false), (0.5, false), (0.1, true), (1e-3, true)] {
        scenario.time_scaling = Some(TimeScaling { speed: Speed::Given(speed), rise: None });
        let problem = slowed(&scenario).unwrap();
        assert_eq!(problem.is_some(), said, "{speed}");
        let words = problem.map(|problem| problem.to_string()).unwrap_or_default();
        assert!(!said || words.contains("of its own speed") && words.contains("panda_joint"), "{words}");
    }
    scenario.time_scaling = None;
    assert!(slowed(&scenario).unwrap().is_none());
}
