//! Gains from a specification.

use std::ops::ControlFlow;
use std::sync::Mutex;

use flexure::Scenario;
use flexure::design::{Design, SpecFile, Specified, design};
use flexure::files::{Problem, Reading};
use flexure::imperfections::Imperfection;
use flexure::progress::unwatched;
use flexure::prove::question::{Question, prove};
use flexure::prove::sampled_data::sampled_tube;
use flexure::scenario::scenario_from_text;

/// The pendulum for half a second, with `spec`.
fn pendulum(spec: &str) -> (Specified, SpecFile) {
    let file = SpecFile::from_text("spec.toml", spec).unwrap_or_else(|problems| panic!("{problems}"));
    let mut specified = Specified::load("pendulum-tanh", Reading::default(), &file)
        .unwrap_or_else(|problems| panic!("{problems}"));
    for scenario in &mut specified.scenarios {
        scenario.duration = 0.5;
    }
    (specified, file)
}

fn tuned(spec: &str, budget: usize) -> (Specified, Design) {
    let (specified, file) = pendulum(spec);
    let found =
        design(&specified, &file, budget, 0, &unwatched).unwrap_or_else(|problems| panic!("{problems}"));
    (specified, found)
}

/// A rate that is asked for is proved of the gains that were found, by the prover on its own.
#[test]
fn the_rate_that_is_asked_is_proved() {
    for rate in [0.5, 4.0, 11.9, 18.3] {
        let (specified, found) = tuned(&format!("rate = {rate}"), 6);
        // By gains that are raised to it: nobody has to look for the largest rate.
        assert!(found.feasible && found.runs <= 6, "{rate}: {:?}", found.constraints);
        let scenario = specified.scenarios[0].under(&found.controller);
        let proof = prove(&scenario, &Question::default()).expect("a proof");
        let proved = proof.verdict.proved().expect("proved").contraction_rate.as_ref().unwrap().approximate();
        assert!(proved >= rate, "{proved} < {rate}");
    }
}

/// A rate of the sampled loop that is asked for is that of a tube, found by the prover on its own; where small errors shrink more slowly, or no tube is
/// found, that is said, and where tubes do not speak of a loop, before anything is run.
#[test]
fn the_rate_of_the_sampled_loop_that_is_asked_is_proved() {
    let (specified, found) = tuned("sampled_rate = 8.0", 8);
    assert!(found.feasible, "{:?}", found.constraints);
    let tube = found.evidence.tube.expect("a tube");
    let scenario = specified.scenarios[0].under(&found.controller);
    let again = sampled_tube(&scenario, &[tube.width], &unwatched).unwrap().unwrap().expect("the same");
    assert_eq!(again.rate.to_bits(), tube.rate.to_bits());
    assert!(tube.rate >= 8.0);
    assert!(found.comment().contains("near its run (certify --sampled-tube"), "{}", found.comment());
    let asked = "sampled_rate = 5000.0";
    let (specified, found) = tuned(asked, 6);
    assert!(!found.feasible && found.evidence.tube.is_none());
    let problem = objection(&specified, asked, &found);
    assert!(problem.to_string().contains("rate that a tube of the sampled loop may have"), "{problem}");
    assert!(problem.hint().contains("a lower sampled_rate"), "{}", problem.hint());
    let file = SpecFile::from_text("spec.toml", "sampled_rate = 5.0").unwrap();
    for (name, why) in
        [("two-link-everything", "has an estimator"), ("task-soft", "certificates are for 'vcbc'")]
    {
        let Ok(mut specified) = Specified::load(name, Reading::default(), &file) else { panic!("{name}") };
        if name == "task-soft" {
            specified.scenarios[0].controller =
                flexure::laws::Controller::default_for("cascade", &specified.scenarios[0].robot).unwrap();
        }
        let problems = design(&specified, &file, 4, 0, &unwatched).unwrap_err();
        assert!(problems.to_string().contains(why), "{problems}");
    }
}

/// What cannot be had is said: the constraint that is in the way, and a smaller rate that can be had.
#[test]
fn a_rate_beyond_the_control_period_is_infeasible() {
    let (specified, found) = tuned("rate = 5000.0", 6);
    assert!(!found.feasible);
    let feasible = found.instead.as_ref().and_then(|instead| instead.rate);
    assert!(feasible.is_some_and(|rate| rate > 0.0 && rate < 5000.0), "{:?}", found.instead);
    let problem = objection(&specified, "rate = 5000.0", &found);
    assert!(problem.hint().contains("is feasible"), "{}", problem.hint());
    // A loop without a delay cannot have less of it.
    assert!(!problem.hint().contains("delay"), "{}", problem.hint());
    let said = problem.hint().split_once(" is feasible").and_then(|(said, _)| said.strip_prefix("rate = "));
    let rate: f64 = said.and_then(|rate| rate.parse().ok()).expect("a rate");
    assert!(rate <= feasible.unwrap_or_default(), "{rate}: {feasible:?}");
    let (_, found) = tuned(&format!("rate = {rate}"), 6);
    assert!(found.feasible && found.evidence.rate_certified.is_some_and(|proved| proved >= rate), "{rate}");
}

/// What a rate is said to be feasible for is borne as well, not only as a sampled loop.
#[test]
fn a_rate_that_is_lost_with_what_shall_be_borne_is_not_called_feasible() {
    let spec = |rate: f64| {
        format!("rate = {rate}\n[uncertainty]\nmass = 0.6\nstiffness = 0.6\n[accept]\nerror = 2e-4")
    };
    let (specified, found) = tuned(&spec(12.0), 6);
    let problem = objection(&specified, &spec(12.0), &found);
    assert!(!problem.hint().contains("is feasible"), "{}", problem.hint());
}

/// Loops that are late by more than is looked at, and do not follow: a no that says so, and nothing of a spectral radius of 0.
#[test]
fn loops_that_are_far_too_late_are_a_no() {
    let spec = "delay = 0.15";
    let file = SpecFile::from_text("spec.toml", spec).unwrap();
    let specified = Specified::load("two-link-tanh-smooth", Reading::default(), &file).unwrap();
    let found = design(&specified, &file, 4, 0, &unwatched).unwrap_or_else(|problems| panic!("{problems}"));
    let problem = objection(&specified, spec, &found);
    assert!(problem.hint().contains("less delay (delay of the SPEC"), "{}", problem.hint());
    let mut whats = found.constraints.iter().map(|constraint| constraint.what.as_str());
    assert!(!whats.any(|what| what.contains("small errors shrink")), "{:?}", found.constraints);
}

fn objection(specified: &Specified, spec: &str, found: &Design) -> Problem {
    let file = SpecFile::from_text("spec.toml", spec).expect("a spec");
    assert!(!found.feasible, "{:?}", found.constraints);
    let problem = found.objection(&specified.scenarios[0], &file).expect("a no");
    assert_eq!(problem.code_word(), "infeasible");
    problem
}

/// The same gains, bit for bit, on one thread and on several.
#[test]
fn threads_do_not_matter() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| tuned("", 12).1)
    };
    let (one, three) = (on(1), on(3));
    let bits = |found: &Design| -> Vec<u64> {
        found.controller.gains().iter().flat_map(|(_, values)| values.iter().map(|x| x.to_bits())).collect()
    };
    assert_eq!(bits(&one), bits(&three));
    assert_eq!(one.constraints, three.constraints);
}

/// The scenario that is written holds the loop that was tuned: its run gives the figures of the evidence.
#[test]
fn the_file_is_the_loop_that_was_tuned() {
    let (specified, found) = tuned("", 6);
    let text = specified.with(&found.controller, &found.comment());
    for (first, next) in [
        ("\n\n[controller]\n", "\n\n[controller.link]\n"),
        ("\n\n[controller.link]", "\n\n[controller.motor]"),
    ] {
        assert!(text.find(first).is_some_and(|at| text.find(next).is_some_and(|then| at < then)), "{text}");
    }
    let mut read: Scenario = scenario_from_text("tuned.toml", &text, ".".as_ref())
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    assert_eq!(read.controller, found.controller);
    read.duration = 0.5;
    let summary = read.simulate().expect("a run").summary;
    let evidence = &found.evidence.runs[0];
    // The evidence is of loops side by side: sines and tanh in lanes have other last digits.
    let same = |alone: f64, together: f64| (alone - together).abs() <= 1e-9 * together;
    assert!(same(summary.rms_e_l, evidence.rms_e_l), "{} {}", summary.rms_e_l, evidence.rms_e_l);
    assert!(same(summary.max_abs_u_m, evidence.max_abs_u_m));
}

/// Parts of the SPEC stand in the place of those of the scenario; what it does not name stays.
#[test]
fn a_spec_replaces_parts_of_the_scenario() {
    let spec = "control_period = 5e-4\ndelay = [0.0, 1e-3]\n[[reference]]\nkind = \"sine\"\namplitude = 0.2\nfrequency = 1.0\n\
                [[reference]]\nkind = \"sine\"\namplitude = 0.1\nfrequency = 2.0\n[[imperfection]]\nkind = \"torque-gain\"\nfactor = 0.9";
    let (specified, _) = pendulum(spec);
    assert_eq!(specified.scenarios.len(), 2);
    let scenario = &specified.scenarios[0];
    assert!((scenario.control_period - 5e-4).abs() < 1e-15);
    let kinds: Vec<_> = scenario.imperfections.iter().map(Imperfection::kind).collect();
    assert_eq!(kinds, ["torque-gain", "delay"]);
    let own = Scenario::load("pendulum-tanh").expect("built in");
    assert_eq!(scenario.initial, own.initial);
    // What is written is in order: tables stand with what is in them, where those stood that they replace.
    let spec = "[[reference]]\nkind = \"sine\"\namplitude = 0.2\nfrequency = 1.0\n[reference.smooth_start]\nduration = 0.5";
    let (specified, _) = pendulum(spec);
    let text = specified.with(&own.controller, "tuned");
    let at = |header: &str| text.find(header).unwrap_or_else(|| panic!("{header}: {text}"));
    let headers = [
        "[initial]",
        "[reference]",
        "[reference.smooth_start]",
        "[controller]",
        "[controller.link]",
        "[sources]",
    ];
    assert!(headers.map(at).is_sorted(), "{text}");
}

#[test]
fn specs_that_cannot_be_meant_are_refused() {
    for (spec, code) in [
        ("rate = -1.0", "range"),
        ("rate = \"fast\"", "unknown-name"),
        ("rate = nan", "missing-number"),
        ("delay = [0.002, 0.001]", "range"),
        ("delay = [0.001]", "length"),
        ("speed = 3", "unknown-key"),
        ("[uncertainty]\nmass = 1.5", "range"),
        ("[uncertainty]\nlength = 0.1", "unknown-key"),
        ("[margins]\ngain = [1.1, 1.2]", "range"),
        ("robot = \"panda\"", "wrong-kind"),
        ("rate = ", "syntax"),
    ] {
        let problems = SpecFile::from_text("spec.toml", spec).expect_err(spec);
        let codes: Vec<_> = problems.iter().map(Problem::code_word).collect();
        assert!(codes.contains(&code), "{spec}: {codes:?}");
    }
}

/// What is wrong with what a SPEC replaces has its place there; what is wrong with the rest, in the scenario.
#[test]
fn problems_of_a_spec_are_placed_in_the_spec() {
    let sine = "kind = \"sine\"\nfrequency = 1.0";
    for (spec, line, column) in [
        ("# one\n[[imperfection]]\nkind = \"encodre\"".to_owned(), 3, 8),
        ("rate = 3.0\ncontrol_period = -0.001".to_owned(), 2, 18),
        ("[accept]\n\nerror = -1.0".to_owned(), 3, 9),
        ("accept = { error=0.1, errror = 2 }".to_owned(), 1, 23),
        (format!("\n[reference]\n{sine}\namplitude = [0.1, 0.2]"), 5, 13),
        (format!("[[reference]]\n{sine}\namplitude = 0.1\n[[reference]]\n{sine}\namplitud = 0.1"), 8, 1),
        ("[[imperfection]]\nkind = \"delay\"\ncomputation = -1.0\nactuation = 0.0".to_owned(), 3, 15),
    ] {
        let file = SpecFile::from_text("my-spec.toml", &spec).expect("a spec");
        let problems = Specified::load("pendulum-tanh", Reading::default(), &file).expect_err(&spec);
        let places: Vec<_> = problems.iter().map(|problem| (problem.file(), problem.line_column())).collect();
        assert!(places.contains(&(Some("my-spec.toml"), Some((line, column)))), "{spec}: {places:?}");
    }
    let file = SpecFile::from_text("my-spec.toml", "control_period = 5e-4").expect("a spec");
    let specified = Specified::load("pendulum-tanh", Reading::default(), &file).expect("a scenario");
    let place = |key: &str| specified.scenarios[0].places.problem(key, "", "", "");
    let own = Scenario::load("pendulum-tanh").expect("built in").places.problem("controller", "", "", "");
    assert_eq!(
        (place("controller").file(), place("controller").line_column()),
        (own.file(), own.line_column())
    );
    assert_eq!(
        (place("control_period").file(), place("control_period").line_column()),
        (Some("my-spec.toml"), Some((1, 18)))
    );
}

/// The starting gains are run before anything is searched: what is broken off then has them.
#[test]
fn what_is_broken_off_soon_has_the_starting_gains() {
    let (specified, file) = pendulum("");
    let at_once =
        |fraction: f64| if fraction > 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let found = design(&specified, &file, 6, 0, &at_once).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(found.broken_off && found.feasible && found.runs == 0, "{found:?}");
    let start = Scenario::load("pendulum-tanh").unwrap();
    let ratio = |i: usize| found.controller.gains()[i].1[0] / start.controller.gains()[i].1[0];
    assert!((0..start.controller.gains().len()).all(|i| ratio(i).is_finite()), "{found:?}");
    // A rate of the sampled loop is not kept before it is proved.
    let (specified, file) = pendulum("sampled_rate = 8.0");
    let found = design(&specified, &file, 6, 0, &at_once).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(found.broken_off && !found.feasible && found.evidence.tube.is_none(), "{found:?}");
    let before = design(&specified, &file, 6, 0, &|_| ControlFlow::Break(()));
    assert!(before.is_err_and(|problems| problems.is_interrupted()));
}

/// The fraction that is told grows from 0 to 1 in many steps, none of them a large part of the work.
#[test]
fn the_work_is_told_as_it_goes() {
    let (specified, file) = pendulum("");
    let told = Mutex::new(Vec::new());
    let tell = |fraction: f64| {
        told.lock().unwrap().push(fraction);
        ControlFlow::Continue(())
    };
    design(&specified, &file, 24, 0, &tell).unwrap_or_else(|problems| panic!("{problems}"));
    let mut told = told.into_inner().unwrap();
    assert!(told.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
    assert!(told.last().is_some_and(|last| *last > 0.98), "{:?}", told.last());
    told.sort_by(f64::total_cmp);
    let leap = told.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(leap < 0.25, "{leap}");
}

/// An error that is as large as the motion is nothing to accept: no figure is named for it, and for a smaller one its own.
#[test]
fn what_does_not_follow_at_all_names_no_figure() {
    let (specified, mut found) = tuned("", 2);
    let size = found.evidence.runs[0].following.size.iter().copied().fold(0.0, f64::max);
    let way_out = |found: &mut Design, error: f64| {
        let measured = found.constraints.iter_mut().find(|constraint| constraint.what == "position error");
        let measured = measured.expect("an error");
        (measured.value, measured.slack) = (error, 1.0 - error / measured.limit);
        found.feasible = false;
        objection(&specified, "", found).hint().to_owned()
    };
    assert!(size > 0.01, "{size}");
    let lost = way_out(&mut found, 0.6 * size);
    assert!(lost.contains("does not follow at all") && lost.contains("control_period"), "{lost}");
    assert!(!lost.contains("would have to be accepted"), "{lost}");
    let near = way_out(&mut found, 0.25 * size);
    assert!(near.contains("would have to be accepted") && near.contains("accept.error"), "{near}");
}
