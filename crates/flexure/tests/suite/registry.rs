//! Data become the right types: closed forms against what the files say.

use flexure::core::reference::Reference as _;
use flexure::eval::evaluate_model;
use flexure::feasible;
use flexure::files::{StateFile, StateRow};
use flexure::references::{PointToPoint, Profile, Reference};
use flexure::robot::Links;
use flexure::robot::load_robot;
use flexure::robot::supported;
use flexure::scenario::load_scenario;
use flexure::simulate::preload;

#[test]
fn the_pendulum_swings_about_its_joint() {
    let robot = load_robot("pendulum-1dof").expect("built in");
    let Links::Pendulum(flexure::robot::Pendulum { mass, com, inertia }) = robot.links else {
        panic!("a pendulum")
    };
    let (q, v, a, jerk) = (0.7, 1.3, -2.1, 3.4);
    let state = StateRow {
        q_l: vec![q],
        q_m: vec![0.9],
        dq_l: vec![v],
        dq_m: vec![0.0],
        ddq_l: Some(vec![a]),
        d3q_l: Some(vec![jerk]),
        ..StateRow::default()
    };
    let states = StateFile { name: "test".to_owned(), rows: vec![state] };
    let row = &evaluate_model(&robot, &states).expect("one joint")[0];
    let about_the_joint = inertia + mass * com * com;
    assert!((row.M_l[0][0] - about_the_joint).abs() < 1e-15);
    assert!((row.bias[0] - mass * 9.81 * com * q.sin()).abs() < 1e-14);
    let weight = mass * 9.81 * com;
    let torque = about_the_joint * a + weight * q.sin();
    let rate = about_the_joint * jerk + weight * q.cos() * v;
    for (got, expected) in [(&row.tau_l, torque), (&row.dtau_l, rate)] {
        let got = got.as_ref().expect("given what it depends on")[0];
        assert!((got - expected).abs() < 1e-14, "{got}, expected {expected}");
    }
    assert_eq!(row.ddtau_l, None, "the fourth derivative is not given");
    let spring = 0.5 * robot.stiffness[0] * 0.2 * 0.2;
    let energy = 0.5 * about_the_joint * v * v + mass * 9.81 * com * (1.0 - q.cos()) + spring;
    assert!((row.H - energy).abs() < 1e-14);
}

#[test]
fn point_to_point_motions_have_the_smoothness_of_their_name() {
    for (profile, smooth) in [(Profile::Quintic, 2), (Profile::Septic, 3), (Profile::Nonic, 4)] {
        let mut scenario = load_scenario("pendulum-tanh").expect("built in");
        scenario.smooth_start = None;
        scenario.reference = Reference::PointToPoint(PointToPoint {
            profile,
            from: vec![0.1],
            to: vec![1.1],
            start: 0.5,
            duration: 2.0,
        });
        let reference = feasible::reference::<1>(&scenario).expect("a path");
        // Just inside the motion: derivatives up to the smoothness vanish, the next does not.
        let [jet] = reference.at::<7>(0.5 + 1e-9).0;
        for k in 1..=smooth {
            assert!(jet.derivative(k).abs() < 1e-6, "{profile:?}: derivative {k} is {}", jet.derivative(k));
        }
        assert!(jet.derivative(smooth + 1).abs() > 1.0, "{profile:?}: {jet:?}");
        let [end] = reference.at::<2>(3.0).0;
        assert!((end.derivative(0) - 1.1).abs() < 1e-15 && end.derivative(1) == 0.0);
    }
}

#[test]
fn a_smooth_start_leaves_from_the_robot_and_reaches_the_reference() {
    let scenario = load_scenario("two-link-tanh-smooth").expect("built in");
    let duration = scenario.smooth_start.expect("smooth").duration;
    let reference = feasible::reference::<2>(&scenario).expect("a path");
    let start = reference.at::<5>(0.0).0;
    assert!(start.iter().all(|jet| (0..5).all(|k| jet.derivative(k) == 0.0)), "{start:?}");
    let [later, _] = reference.at::<3>(duration + 1.0).0;
    assert!((later.derivative(0) - (duration + 1.0).sin()).abs() < 1e-15);
    assert!((later.derivative(1) - (duration + 1.0).cos()).abs() < 1e-15);
}

#[test]
fn springs_that_do_not_carry_the_arm_are_a_warning_that_says_what_would() {
    let mut scenario = load_scenario("panda-tanh-smooth").expect("built in");
    assert!(preload(&scenario).expect("seven joints").is_none(), "the shipped start holds the arm");
    let holding = scenario.initial.q_m.clone();
    scenario.initial.q_m.clone_from(&scenario.initial.q_l);
    let warning = preload(&scenario).expect("seven joints").expect("unloaded springs under gravity");
    assert!(warning.is_warning());
    // Written into a file it holds the arm: nothing accelerates to speak of.
    let (_, told) = warning.hint().split_once('[').expect("a list");
    let told = told.split(']').next().expect("its end");
    let told: Vec<f64> = told.split(", ").map(|x| x.parse().expect("a number")).collect();
    for (told, holding) in told.iter().zip(&holding) {
        assert!((told - holding).abs() < 1e-6, "{}", warning.hint());
    }
    scenario.initial.q_m = told;
    assert!(preload(&scenario).expect("seven joints").is_none());
}

#[test]
fn a_robot_of_too_many_joints_is_refused_before_it_runs() {
    let mut robot = load_robot("panda").expect("built in");
    assert!(supported(&robot).is_ok());
    let Links::Tree(bodies) = &mut robot.links else { panic!("a tree") };
    for more in [0..7, 0..3] {
        bodies.extend_from_within(more.clone());
        robot.joints.extend_from_within(more);
    }
    let problems = supported(&robot).expect_err("seventeen joints");
    assert!(problems.to_string().contains("17 moving joints"), "{problems}");
}
