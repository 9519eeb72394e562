//! Imperfections of no strength are none, bit by bit.

use std::fmt::Write;

use flexure::estimators::Estimator;
use flexure::imperfections::{Imperfection, STRENGTHS, Strengths};
use flexure::scenario::{GuardSettings, scenario_from_text};

use super::{ideal, same_bits, simulate, with_these};

/// The entries of the given kinds and keys in a file.
fn read(entries: impl IntoIterator<Item = (&'static str, &'static str)>) -> Vec<Imperfection> {
    let text = flexure::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-hardware").unwrap().1;
    let mut text = text.split("[guard]").next().unwrap().to_owned();
    for (kind, keys) in entries {
        write!(text, "[[imperfection]]\nkind = \"{kind}\"\n{keys}\n").unwrap();
    }
    let scenario =
        scenario_from_text("entries", &text, ".".as_ref()).unwrap_or_else(|bad| panic!("{bad}\n{text}"));
    scenario.imperfections
}

/// Every imperfection at zero strength, friction on both sides.
fn nothing() -> Vec<Imperfection> {
    let registered = STRENGTHS.iter().filter_map(|&(kind, Strengths { none, .. })| Some((kind, none?)));
    read(registered.chain([("friction", "side = \"motor\"\ncoulomb = 0.0")]))
}

#[test]
fn imperfections_of_no_strength_are_none() {
    let perfect = simulate(&ideal(1.0));
    for imperfection in nothing() {
        let kind = imperfection.kind();
        let with_it = with_these(ideal(1.0), vec![imperfection]);
        assert!(same_bits(&perfect, &simulate(&with_it)) > 20, "{kind}");
    }
    let with_all = with_these(ideal(1.0), nothing());
    assert!(same_bits(&perfect, &simulate(&with_all)) > 20);
}

/// No kind is read and then forgotten: little of it moves the robot elsewhere, and much of it elsewhere again.
#[test]
fn every_registered_kind_does_something() {
    let link = |imperfections| {
        let mut scenario = with_these(ideal(1.0), imperfections);
        // Springs wound by a fifth of a radian: torques up to 14 N m, beyond the limits of any strength.
        scenario.initial.q_m = vec![0.2; 2];
        simulate(&scenario).trace.column("q_l2").unwrap().to_vec()
    };
    let perfect = link(Vec::new());
    for &(kind, Strengths { little, much, .. }) in STRENGTHS {
        let [little, much] = [little, much].map(|keys| link(read([(kind, keys)])));
        assert_ne!(little, perfect, "little {kind}");
        assert_ne!(much, perfect, "much {kind}");
        assert_ne!(little, much, "{kind}");
    }
}

#[test]
fn a_guard_that_has_nothing_to_do_changes_nothing() {
    let mut scenario = ideal(1.0);
    let unlimited = vec![1e9; 2];
    scenario.guard = Some(GuardSettings {
        torque_limit: unlimited,
        ..GuardSettings::usual(&scenario.robot.limits, scenario.control_period)
    });
    let guarded = simulate(&scenario);
    assert!(same_bits(&simulate(&ideal(1.0)), &guarded) > 20);
    assert!(guarded.trace.column("certificate").unwrap().iter().all(|&holds| holds == 1.0));
    assert_eq!(guarded.summary.suspended_fraction, 0.0);
}

/// An observer on exact encoders, started on the true motion, keeps to the loop with true velocities. Not bit by bit: it
/// predicts with a step of second order, (ωT)²/12 ≈ 3e-4 of what moves at ω = 30 1/s.
#[test]
fn an_observer_on_a_perfect_robot_changes_little() {
    let observer =
        Estimator::Observer { encoders: flexure::estimators::Encoders::Both, bandwidth: vec![200.0; 2] };
    let mut scenario = ideal(6.0);
    scenario.estimator = Some(observer);
    let observed = simulate(&scenario);
    let perfect = simulate(&ideal(6.0));
    assert!(observed.summary.rms_e_l < 1e-4, "{}", observed.summary.rms_e_l);
    assert!(perfect.summary.rms_e_l < observed.summary.rms_e_l);
}

#[test]
fn the_same_seed_makes_the_same_run_and_another_seed_another() {
    let noisy = |seed: u64| {
        let text = "[[imperfection]]\nkind = \"noise\"\nlink = 1e-4\nmotor = 1e-4\n[[imperfection]]\nkind = \"deadline\"\nprobability = 0.1\n";
        let imperfections = super::with("two-link-tanh-smooth", 1.0, text).imperfections;
        let mut scenario = with_these(ideal(1.0), imperfections);
        scenario.seed = seed;
        simulate(&scenario)
    };
    same_bits(&noisy(1), &noisy(1));
    assert_ne!(noisy(1).trace.column("q_l1"), noisy(2).trace.column("q_l1"));
}
