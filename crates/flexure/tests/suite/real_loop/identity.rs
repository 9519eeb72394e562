//! Imperfections of no strength are none, bit by bit.

use flexure::estimators::Estimator;
use flexure::imperfections::Imperfection;
use flexure::scenario::{GuardSettings, Scenario, scenario_from_text};

use super::{ideal, same_bits, simulate, with_these};

/// Every imperfection at zero strength, as a file would have it.
const NOTHING: &str = r#"
[[imperfection]]
kind = "noise"
link = 0.0
[[imperfection]]
kind = "encoder"
resolution = 0.0
[[imperfection]]
kind = "sampling"
period = 0.002
side = "both"
[[imperfection]]
kind = "dropout"
probability = 0.0
[[imperfection]]
kind = "deadline"
probability = 0.0
[[imperfection]]
kind = "torque-gain"
factor = 1.0
[[imperfection]]
kind = "current-quantisation"
step = 0.0
[[imperfection]]
kind = "saturation"
limit = 1e9
[[imperfection]]
kind = "torque-rate"
limit = 1e8
[[imperfection]]
kind = "delay"
actuation = 0.0
[[imperfection]]
kind = "friction"
side = "link"
coulomb = 0.0
[[imperfection]]
kind = "friction"
side = "motor"
coulomb = 0.0
[[imperfection]]
kind = "spring"
hardening = 0.0
dead_zone = 0.0
hysteresis_stiffness = 0.0
hysteresis_torque = 0.0
[[imperfection]]
kind = "model-error"
stiffness = 1.0
mass = 1.0
payload = { mass = 0.0, position = [0.2, 0.0, 0.0] }
[[imperfection]]
kind = "push"
torque = 0.0
from = 0.0
duration = 1.0
"#;

fn nothing() -> Vec<Imperfection> {
    let text = flexure::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-hardware").unwrap().1;
    let text = text.split("[guard]").next().unwrap();
    let scenario: Scenario = scenario_from_text("nothing", &format!("{text}{NOTHING}"), ".".as_ref())
        .unwrap_or_else(|problems| panic!("{problems}"));
    scenario.imperfections
}

#[test]
fn every_kind_is_there() {
    let kinds: Vec<_> = nothing().iter().map(Imperfection::kind).collect();
    for entry in flexure::imperfections::IMPERFECTIONS {
        // A filter has no strength to be zero.
        assert!(kinds.contains(&entry.name) || entry.name == "velocity-filter", "{}", entry.name);
    }
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

#[test]
fn a_guard_that_has_nothing_to_do_changes_nothing() {
    let guard = GuardSettings {
        torque_limit: vec![1e9; 2],
        torque_rate_limit: vec![f64::INFINITY; 2],
        max_age: 0,
        rejoin_after: 1,
        rejoin_duration: 1.0,
        stop_damping: vec![0.0; 2],
    };
    let mut scenario = ideal(1.0);
    scenario.guard = Some(guard);
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
