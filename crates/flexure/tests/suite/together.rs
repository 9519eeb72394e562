//! Runs side by side in SIMD lanes: one loop alone is the oracle, and neighbours do not matter.

use std::ops::ControlFlow;

use flexure::Problems;
use flexure::files::{Change, Reading, SCENARIOS};
use flexure::laws::Controller;
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::simulate::{Batch, Criteria, Run, SIDE_BY_SIDE, measure, measure_together};

/// The built-in scenario of this name, shortened, with changes.
fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let short = ["duration = 1.2"].into_iter().chain(changes.iter().copied());
    let changes: Vec<Change> = short.map(|change| Change::parse(change).expect("a change")).collect();
    load_scenario_with(name, Reading::changed(&changes))
        .unwrap_or_else(|problems| panic!("{name}: {problems}"))
}

/// The scenario with every spring a tenth softer.
fn soft(mut scenario: Scenario) -> Scenario {
    scenario.robot.stiffness.iter_mut().for_each(|stiffness| *stiffness *= 0.9);
    scenario
}

/// The scenario with so much damping of the motors that its loop diverges.
fn wild(mut scenario: Scenario) -> Scenario {
    let gains = scenario.controller.gains().into_iter();
    let scaled = gains.map(|(name, values)| {
        let factor = if name == "motor.damping" { 3000.0 } else { 1.0 };
        values.iter().map(|value| value * factor).collect()
    });
    scenario.controller = scenario.controller.with_gains(&scaled.collect::<Vec<Vec<f64>>>());
    scenario
}

/// The runs of scenarios side by side.
fn together(scenarios: &[&Scenario]) -> Vec<Result<Run, Problems>> {
    let criteria: Vec<Criteria> = scenarios.iter().map(|one| Criteria::of(one).expect("criteria")).collect();
    let jobs: Vec<_> = scenarios.iter().copied().zip(&criteria).collect();
    measure_together(&jobs, &|_, _| ControlFlow::Continue(()))
}

/// Every figure of a run, by name.
fn figures(run: &Run) -> Vec<(&'static str, f64)> {
    let s = &run.summary;
    vec![
        ("rms_e_l", s.rms_e_l),
        ("max_abs_e_l", s.max_abs_e_l),
        ("final_abs_e_l", s.final_abs_e_l),
        ("settling_time", s.settling_time.unwrap_or(-1.0)),
        ("max_abs_u_m", s.max_abs_u_m),
        ("rms_u_m", s.rms_u_m),
        ("rms_torque_change", s.rms_torque_change),
        ("saturated_fraction", s.saturated_fraction),
        ("suspended_fraction", s.suspended_fraction),
        ("stops", f64::from(s.stops)),
        ("diverged_at", run.divergence.map_or(-1.0, |divergence| divergence.time)),
    ]
}

fn bits(run: &Run) -> Vec<u64> {
    let drift = run.summary.energy_drift;
    figures(run).into_iter().map(|(_, value)| value).chain([drift]).map(f64::to_bits).collect()
}

/// Every built-in scenario, with stiffnesses of its own beside it: the verdict of one loop alone, and its figures to 10⁻⁶ of
/// themselves or 10⁻⁸ rad or N m: the integrator keeps to 10⁻⁷ of the speeds (largest difference between the loop at that and at 10⁻¹²: 5.3e-9 rad), and
/// what sines in lanes differ by is less. Torques of the first instants, off the reference, are thousands of N m.
#[test]
fn each_run_is_that_of_its_loop_alone() {
    for (name, _) in SCENARIOS {
        let soft = soft(scenario(name, &[]));
        let own = scenario(name, &[]);
        let runs = together(&[&own, &soft, &own]);
        for (run, one) in runs.iter().zip([&own, &soft, &own]) {
            let run = run.as_ref().unwrap_or_else(|problems| panic!("{name}: {problems}"));
            let alone = measure(one).expect("it runs");
            assert_eq!(run.summary.following.follows, alone.summary.following.follows, "{name}");
            for ((what, value), (_, expected)) in figures(run).into_iter().zip(figures(&alone)) {
                let same = value.is_nan() && expected.is_nan();
                let near = (value - expected).abs() <= 1e-6 * expected.abs() + 1e-8;
                assert!(same || near, "{name}, {what}: {value} together, {expected} alone");
            }
        }
        assert_eq!(
            bits(runs[0].as_ref().expect("it ran")),
            bits(runs[2].as_ref().expect("it ran")),
            "{name}"
        );
    }
}

/// Loops that are moved by the midpoint rule, a step a period: as alone, by figures as above, and within a microradian of what collocation makes of
/// them (largest difference: 1.5e-7 rad).
#[test]
fn steps_of_the_midpoint_rule_are_those_of_the_loop_alone() {
    for name in ["two-link-tanh-smooth", "pendulum-tanh", "panda-tanh-smooth"] {
        let exact = measure(&scenario(name, &[])).expect("it runs");
        let own = scenario(name, &["integration = 'midpoint'"]);
        let noisy = scenario(name, &["integration = 'midpoint'", "seed = 1"]);
        let alone = measure(&own).expect("it runs");
        assert!(alone.summary.following.follows, "{name}");
        assert!((alone.summary.steps as f64 - own.duration / own.control_period).abs() < 1.5, "{name}");
        for run in together(&[&noisy, &own]) {
            let run = run.unwrap_or_else(|problems| panic!("{name}: {problems}"));
            assert_eq!(run.summary.steps, alone.summary.steps, "{name}");
            for ((what, value), (_, expected)) in figures(&run).into_iter().zip(figures(&alone)) {
                let near = (value - expected).abs() <= 1e-6 * expected.abs() + 1e-8;
                assert!(near, "{name}, {what}: {value} together, {expected} alone");
            }
            let off = (run.summary.rms_e_l - exact.summary.rms_e_l).abs();
            assert!(off > 0.0 && off < 1e-6, "{name}: {off} rad");
        }
    }
}

/// A loop comes to the same bits whatever is beside it, and wherever: others of its kind, other robots and laws, loops that diverge, that
/// are shorter, nothing at all.
#[test]
fn neighbours_do_not_matter() {
    let midpoint = ["integration = 'midpoint'"];
    for (name, changes) in [
        ("task-encoder", &[][..]),
        ("two-link-everything", &[]),
        ("task-friction", &[]),
        ("task-push", &[]),
        ("panda-tanh-smooth", &[]),
        ("panda-tanh-smooth", &midpoint),
        ("two-link-hardware", &midpoint),
    ] {
        let with = |more: &[&str]| scenario(name, &[changes, more].concat());
        let own = with(&[]);
        let alone = together(&[&own]).remove(0).expect("it runs");
        let wild = wild(with(&[]));
        let short = with(&["duration = 0.4"]);
        let other = scenario("pendulum-tanh", &[]);
        let linear = with(&["controller.phi = 'linear'"]);
        let mut all = vec![&wild, &other, &linear, &short, &own];
        for _ in 0..=SIDE_BY_SIDE {
            all.rotate_left(1);
            for (run, one) in together(&all).into_iter().zip(&all) {
                if std::ptr::eq(*one, &raw const own) {
                    assert_eq!(bits(&run.expect("it runs")), bits(&alone), "{name} {changes:?}");
                }
            }
        }
    }
}

/// Loops with nothing but limits between law and robot stay in lanes, where their books are kept together; a push that never comes keeps them from
/// it. Every number that a loop shows is the same, to the bit, however many periods it is asked for at once, whatever diverges beside
/// it, and while torques are cut.
#[test]
fn what_stays_in_lanes_comes_to_what_each_loop_books() {
    let push = "{ kind = 'push', torque = 1.0, from = 50.0, duration = 1.0 }";
    let cut = "{ kind = 'saturation', limit = 20.0 },";
    for (name, devices, changes) in [
        ("two-link-tanh-smooth", "", &[][..]),
        ("two-link-tanh-smooth", "", &["controller.phi = 'linear'"]),
        ("two-link-tanh-smooth", "", &["reference.amplitude = [0.4, 1.0]"]),
        ("two-link-tanh-smooth", "", &["integration = 'midpoint'"]),
        ("two-link-tanh-smooth", cut, &[]),
        ("two-link-tanh-smooth", cut, &["integration = 'midpoint'"]),
        ("panda-tanh-smooth", "", &[]),
    ] {
        let with = |more: &str| {
            let real = [devices, more].concat();
            let real = (!real.is_empty()).then(|| format!("imperfection = [{real}]"));
            scenario(name, &changes.iter().copied().chain(real.as_deref()).collect::<Vec<_>>())
        };
        let (own, pushed) = (with(""), with(push));
        let (soft, wild) = (soft(own.clone()), wild(own.clone()));
        let counts: [&[usize]; 3] = [&[600], &[1, 2, 597], &[150, 150, 150, 150]];
        let ends = |loops: &[&Scenario], counts: &[usize]| {
            let mut batch = Batch::open(loops).expect("loops");
            for count in counts {
                batch.steps(*count);
            }
            let end = |place: usize| {
                let held = batch.held(place);
                let mut values = vec![0.0; held.signals().len()];
                held.read(&mut values).expect("a number for each signal");
                values.extend([held.energy_drift(), held.steps() as f64]);
                values.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
            };
            let numbers: Vec<_> = (0..loops.len()).map(end).collect();
            // A loop that diverges has a number that is none: its words are compared.
            let ended = |place| batch.divergence(place).map(|divergence| format!("{divergence:?}"));
            (numbers, (0..loops.len()).map(ended).collect::<Vec<_>>())
        };
        let broken = ends(&[&wild, &pushed], &[600]);
        let booked = ends(&[&pushed], &[600]);
        let is_cut = measure(&own).expect("it runs").summary.saturated_fraction > 0.0;
        assert_eq!(is_cut, !devices.is_empty(), "{name}");
        for counts in counts {
            assert_eq!(ends(&[&own], counts), booked, "{name}, {devices}, {changes:?}, {counts:?}");
            assert_eq!(ends(&[&wild, &own], counts), broken, "{name}, {devices}, {changes:?}, {counts:?}");
            for beside in [&soft, &pushed] {
                let (both, _) = ends(&[beside, &own], counts);
                assert_eq!(both[1], booked.0[0], "{name}, {devices}, {changes:?}, {counts:?}");
            }
        }
    }
}

/// A loop that diverges says when and how, as alone.
#[test]
fn what_diverges_does_so_as_alone() {
    let good = scenario("two-link-tanh-smooth", &[]);
    let bad = wild(scenario("two-link-tanh-smooth", &[]));
    let runs = together(&[&bad, &good]);
    let (run, alone) = (runs[0].as_ref().expect("a run"), measure(&bad).expect("a run"));
    let (divergence, expected) =
        (run.divergence.expect("it diverges"), alone.divergence.expect("it diverges"));
    assert_eq!((divergence.time, divergence.cause), (expected.time, expected.cause));
    assert!(runs[1].as_ref().expect("a run").divergence.is_none());
}

/// Broken off, a run has no figures; the others go on.
#[test]
fn what_is_broken_off_has_no_figures() {
    let one = scenario("task-encoder", &[]);
    let criteria = Criteria::of(&one).expect("criteria");
    let runs = measure_together(&[(&one, &criteria); 3], &|place, fraction| {
        if place == 1 && fraction > 0.5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(runs[1].as_ref().is_err_and(Problems::is_interrupted));
    assert!(runs[0].is_ok() && runs[2].is_ok());
}

/// Loops in continuous time go one by one, and robots that this program was not built for are refused, without the others.
#[test]
fn what_does_not_go_in_step_goes_alone() {
    let held = scenario("two-link-tanh-smooth", &[]);
    let continuous = scenario("two-link-tanh-smooth", &["hold = 'continuous'"]);
    let runs = together(&[&held, &continuous]);
    let alone = measure(&continuous).expect("a run");
    assert_eq!(bits(runs[1].as_ref().expect("a run")), bits(&alone));
    assert!(runs[0].is_ok());
}

/// Each loop asks its law with memory itself: it comes to the bits of a loop alone, whatever is beside it.
#[test]
fn laws_with_memory_are_asked_one_by_one() {
    let with = |kind: &str| {
        let mut one = scenario("task-payload", &[]);
        one.controller = Controller::default_for(kind, &one.robot).expect("registered");
        one
    };
    let all = ["pid", "position-feedback", "adaptive-vcbc", "vcbc"].map(with);
    let twice: Vec<_> = all.iter().chain(&all).collect();
    for (run, one) in together(&twice).iter().zip(&twice).filter(|(_, one)| one.controller.kind() != "vcbc") {
        let alone = together(&[one]).remove(0).expect("it runs");
        assert_eq!(bits(run.as_ref().expect("it runs")), bits(&alone), "{}", one.controller.kind());
    }
}
