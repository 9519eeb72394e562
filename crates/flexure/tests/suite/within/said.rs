//! Rates, levels and advice for tolerances from next to none to far too wide.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Mutex;

use flexure::progress::unwatched;
use flexure::prove::question::{Proof, Question, prove, prove_watched};
use flexure::prove::within::{Open, Within};
use flexure::robot::Tolerances;
use flexure::scenario::{Scenario, load_scenario};

use super::{IDENTIFIED, displaced, proof, scenario, tolerant, within};

/// What is found of `scenario` with a fifth of the slabs that are usual: enough for what is compared here.
fn coarse(scenario: &Scenario) -> Result<Within, Open> {
    let mut exact = scenario.clone();
    exact.robot.tolerances = Tolerances::none(scenario.robot.joint_count());
    let proof = proof(&exact);
    let certificate = proof.verdict.proved().expect("proved");
    flexure::prove::within::within(scenario, certificate, proof.start, 48, &unwatched).unwrap().unwrap()
}

/// The convergence rate that is certified of the numbers of the file.
fn certified(scenario: &Scenario) -> f64 {
    proof(scenario).verdict.proved().expect("proved").convergence_rate.approximate()
}

/// Where nothing is shown of the tolerances of the file: the largest of their halves, quarters and so on of which something is, and
/// which tolerance counts most there.
#[test]
fn what_is_too_wide_to_prove_names_what_counts_most() {
    let parts = IDENTIFIED.map(|part| 16.0 * part);
    let wide = coarse(&tolerant(scenario(), parts));
    let open = wide.as_ref().unwrap_err();
    let closer = open.closer.as_ref().expect("something is shown of smaller ones");
    let at = |factor: f64| coarse(&tolerant(scenario(), parts.map(|part| factor * part)));
    let found = at(closer.factor).unwrap_or_else(|open| panic!("{closer:?}: {open:?}"));
    assert!((found.rate / closer.rate - 1.0).abs() < 1e-6, "{closer:?}: {found:?}");
    assert!(at(2.0 * closer.factor).is_err(), "{closer:?}");
    // Errors by one tolerance alone are less than those by all, and to take it away helps.
    assert!(closer.share > 0.0 && closer.share < 1.0, "{closer:?}");
    let mut without = tolerant(scenario(), parts.map(|part| closer.factor * part));
    let tolerances = &mut without.robot.tolerances;
    let values = match closer.key {
        "stiffness" => &mut tolerances.stiffness,
        "motor_inertia" => &mut tolerances.motor_inertia,
        "link_damping" => &mut tolerances.link_damping,
        _ => &mut tolerances.motor_damping,
    };
    values[closer.joint] = 0.0;
    assert!(coarse(&without).unwrap().settles < found.settles, "{closer:?}");
    let said = Proof { within: Some(wide.clone()), ..proof(&scenario()) };
    let (problem, is_wrong) = said.complaint(&tolerant(scenario(), parts)).unwrap();
    assert!(!is_wrong && problem.hint().contains("with all tolerances times"), "{}", problem.hint());
}

/// Where joints are many no tolerances are small enough for W: said at once, and nobody is sent to identify more closely. A funnel takes long
/// there, and what it lacks is named.
#[test]
fn what_cannot_be_bounded_is_said_at_once() {
    let arm = tolerant(load_scenario("panda-tanh-smooth").unwrap(), [1e-9; 4]);
    let wide = prove(&arm, &Question { slabs: Some(2), ..Question::default() }).unwrap();
    let Some(Err(open)) = &wide.within else { panic!("{:?}", wide.within) };
    assert!(open.unbounded && open.closer.is_none(), "{open:?}");
    // One level was looked at, of one size of tolerances.
    assert!(open.slabs <= 32, "{open:?}");
    let (problem, is_wrong) = wide.complaint(&arm).unwrap();
    assert!(!is_wrong && problem.to_string().contains("no tolerances are small enough"), "{problem}");
    assert!(!problem.hint().contains("identify"), "{}", problem.hint());
    assert!(problem.hint().contains("all 2 slabs of time were used up; --slabs"), "{}", problem.hint());
}

/// Without tolerances nothing is said; with next to none it is the certified rate; with more it is less.
#[test]
fn the_rate_goes_down_with_the_tolerances() {
    assert!(proof(&scenario()).within.is_none());
    let nominal = certified(&scenario());
    let [none, some, more] = [1e-9, 0.2, 0.4]
        .map(|share| coarse(&tolerant(scenario(), IDENTIFIED.map(|part| share * part))).unwrap());
    println!("{nominal}: {none:?} {some:?} {more:?}");
    assert!(none.rate <= nominal && none.rate > nominal * (1.0 - 1e-6), "{none:?}");
    assert!(some.rate < none.rate && more.rate < some.rate, "{some:?} {more:?}");
    assert!(none.settles < 1e-12 && none.settles < some.settles && some.settles < more.settles);
    for within in [&none, &some, &more] {
        assert!(within.settles <= within.level, "{within:?}");
    }
    // Some number may be 0 to the law, or the springs of another robot: then nothing is said.
    let open = coarse(&tolerant(scenario(), [0.9; 4]));
    assert!(open.is_err(), "{open:?}");
}

/// The level holds the start, wherever it is.
#[test]
fn the_start_lies_in_the_level() {
    let scenario = tolerant(displaced(), IDENTIFIED);
    let start = proof(&scenario).start.expect("a start");
    let within = within(&scenario);
    println!("{start} J at the start: {within:?}");
    assert!(start > 3.0 * within.settles && within.level >= start, "{start}: {within:?}");
}

/// What is broken off says nothing.
#[test]
fn broken_off_nothing_is_said() {
    use flexure::prove::within::within;

    let scenario = tolerant(scenario(), IDENTIFIED);
    let proof = proof(&scenario);
    let certificate = proof.verdict.proved().unwrap();
    let found = within(&scenario, certificate, proof.start, 100, &|_| ControlFlow::Break(())).unwrap();
    assert!(found.is_none(), "{found:?}");
    // A start that is not known to lie in the level set: said, not passed over.
    let found = within(&scenario, certificate, None, 100, &unwatched).unwrap();
    assert!(matches!(&found, Some(Err(open)) if open.at.contains("start")), "{found:?}");
}

/// Whoever waits while levels are tried sees that it goes on.
#[test]
fn levels_that_are_tried_are_told() {
    let told = Mutex::new(BTreeSet::new());
    let note = |fraction: f64| {
        told.lock().unwrap().insert(fraction.to_bits());
        ControlFlow::Continue(())
    };
    prove_watched(&tolerant(scenario(), IDENTIFIED), &Question::default(), &note).unwrap();
    let inside =
        told.into_inner().unwrap().into_iter().map(f64::from_bits).filter(|x| (0.06..0.24).contains(x));
    let count = inside.count();
    assert!(count > 20, "{count}");
}
