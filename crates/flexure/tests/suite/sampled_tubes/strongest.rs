//! The widest tube by trying, and runs beside the file of a tube.

use std::ops::ControlFlow;

use flexure::progress::unwatched;
use flexure::prove::question::{Climb, Question, prove};
use flexure::prove::sampled_data::beside::Beside;
use flexure::prove::sampled_data::{SampledTube, widest_tube};
use flexure::prove::standing::Step;
use flexure::scenario::Scenario;
use flexure::simulate::{Sink, Trace, run, run_into};

use crate::common::Random;
use crate::sampled_tubes::{LOOP, found, on_the_surface, scenario, with_delay};

fn widest(scenario: &Scenario, least: f64) -> SampledTube {
    let found = widest_tube(scenario, least, &unwatched).expect("suitable").expect("nobody breaks it off");
    found.unwrap_or_else(|none| panic!("{}", none.at))
}

/// No tube of the next width is there, the one that is found is what its width has, and a rate that is asked for is reached by a narrower one.
#[test]
fn the_widest_of_those_that_are_tried() {
    let scenario = scenario("two-link-tanh-smooth", &LOOP);
    let tube = widest(&scenario, 0.0);
    let width = tube.asked.extents[0];
    assert!(found(&scenario, 2.0 * width).is_err() && width >= 1e-4, "{width}");
    let named = found(&scenario, width).unwrap_or_else(|none| panic!("{}", none.at));
    assert_eq!((named.rate, &named.error), (tube.rate, &tube.error));
    // Also where wide ones end late in the run: none is passed over.
    let short = self::scenario("two-link-tanh-smooth", &["duration = 0.05"]);
    let width = widest(&short, 0.0).asked.extents[0];
    assert!(found(&short, 2.5 * width).is_err(), "{width}");
    let faster = widest(&scenario, tube.rate + 0.5);
    assert!(
        faster.rate >= tube.rate + 0.5 && faster.asked.extents[0] < tube.asked.extents[0],
        "{}",
        faster.rate
    );
    // Faster than small errors are: there is none, and it is said how far off that is.
    let none =
        widest_tube(&scenario, 40.0, &unwatched).expect("suitable").expect("not broken off").unwrap_err();
    assert!(
        none.at.contains("widths were tried") && none.at.contains("where 40 1/s are asked"),
        "{}",
        none.at
    );
    // What no width helps is said after the first.
    let none = widest_tube(&with_delay(0.0007), 0.0, &unwatched).unwrap().unwrap().unwrap_err();
    assert!(none.at.starts_with("small errors do not shrink"), "{}", none.at);
}

/// The strongest statement is of the sampled loop where there is one, and of the ideal loop where there is none, which is no failure.
#[test]
fn the_strongest_is_what_can_be_proved() {
    let strongest = Question { climb: Climb::Always, ..Question::default() };
    for (scenario, step, why) in [
        (scenario("two-link-tanh-smooth", &LOOP), Step::Sampled, None),
        (scenario("two-link-everything", &[]), Step::Ideal, Some("has an estimator")),
        (
            scenario("two-link-tanh-smooth", &["hold = \"continuous\""]),
            Step::Ideal,
            Some("acts in continuous time"),
        ),
        (scenario("two-link-hardware", &["duration = 0.1"]), Step::Sampled, None),
        // Counts that are twenty times as coarse.
        (
            scenario("two-link-hardware", &["duration = 0.1", "imperfection.encoder.resolution = 3e-2"]),
            Step::Ideal,
            Some("widths were tried"),
        ),
    ] {
        let proof = prove(&scenario, &strongest).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(Step::of(&scenario, &proof), Some(step), "{}", scenario.name);
        assert!(proof.complaint(&scenario).is_none(), "{}", scenario.name);
        let said = proof.sampled_tube.and_then(Result::err).map(|none| none.at);
        assert_eq!(said.is_some(), why.is_some(), "{said:?}");
        assert!(said.is_none_or(|said| said.contains(why.unwrap_or_default())), "{why:?}");
    }
}

/// What is refuted of the ideal loop takes nothing from what is proved of the sampled one.
#[test]
fn a_rate_that_is_refuted_leaves_the_tube() {
    let scenario = scenario("two-link-tanh-smooth", &["duration = 0.01"]);
    let question = Question { climb: Climb::Always, rate: Some(100.0), ..Question::default() };
    let proof = prove(&scenario, &question).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(proof.complaint(&scenario).is_some_and(|(_, wrong)| wrong));
    assert_eq!(Step::of(&scenario, &proof), Some(Step::Sampled));
}

/// Keeps the last two numbers of every row: whether what is proved holds, and how far out the run is.
#[derive(Default)]
struct Ends(Vec<[f64; 2]>);

impl Sink for Ends {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        self.0.push(*row.last_chunk().expect("two columns more"));
        ControlFlow::Continue(())
    }
}

fn beside(text: &str, scenario: &Scenario) -> Beside {
    Beside::new(text, scenario).expect("a law with tubes").expect("a tube")
}

/// A loop whose reference does not depend on its start, its tube and the file of that.
fn short() -> (Scenario, SampledTube, String) {
    let scenario = scenario("two-link-linear", &["duration = 0.02", "integration_tolerance = 1e-12"]);
    let tube = found(&scenario, 1e-6).unwrap_or_else(|none| panic!("{}", none.at));
    let file = tube.file(&scenario).expect("a law");
    (scenario, tube, file)
}

/// Runs from the surface of a tube are in it until the end, and nearer to its middle by its rate; what starts beyond has nothing proved of it.
#[test]
fn runs_from_the_surface_stay_inside() {
    let (scenario, tube, file) = short();
    let mut random = Random(81);
    for scale in [0.999, 1.01] {
        let from = on_the_surface(&tube.sections[0], 2, &mut random);
        let middle = &tube.sections[0].center;
        let from: Vec<f64> = from.iter().zip(middle).map(|(x, c)| c + scale * (x - c)).collect();
        let mut other = scenario.clone();
        let parts: Vec<_> = from.chunks(2).map(<[f64]>::to_vec).collect();
        [&mut other.initial.q_l, &mut other.initial.q_m, &mut other.initial.dq_l, &mut other.initial.dq_m]
            .into_iter()
            .zip(parts)
            .for_each(|(to, part)| *to = part);
        let (mut watched, mut ends) = (beside(&file, &other), Ends::default());
        run_into(&other, &mut [&mut watched.before(&mut ends)], &unwatched).expect("a run");
        let found = watched.found();
        if scale > 1.0 {
            assert_eq!(found.void.as_deref(), Some("the run does not start in the tube"));
            assert!(ends.0.iter().all(|&[holds, _]| holds == 0.0) && found.certified_fraction == 0.0);
            continue;
        }
        assert_eq!((&found.void, found.left, found.certified_fraction), (&None, None, 1.0));
        assert_eq!(ends.0.len(), 21);
        assert!((ends.0[0][1] - scale).abs() < 1e-6, "{}", ends.0[0][1]);
        // The end is nearer as the tube says; rounding of the run is a thousandth of so narrow a tube.
        let [_, last] = ends.0[20];
        assert!(last <= scale * (-tube.mean_rate * 0.02).exp() + 1e-3, "{last}");
    }
}

/// What leaves a tube has nothing proved of it from then on, also where it is back in it; nor has what goes on after its end.
#[test]
fn outside_nothing_is_certified() {
    let (scenario, tube, file) = short();
    let trace = run(&scenario, &unwatched).expect("a run").trace;
    let (mut watched, mut ends) = (beside(&file, &scenario), Ends::default());
    let rows = rows(&trace);
    for (k, mut row) in rows.clone().into_iter().enumerate() {
        // Link 1, by name.
        let at = scenario.signals().unwrap().iter().position(|signal| signal.name == "q_l1").unwrap();
        row[at] += if k == 7 { 2.0 * tube.error[0] } else { 0.0 };
        let _ = watched.before(&mut ends).take(&row);
    }
    let found = watched.found();
    assert!((found.left.expect("it left") - 0.007).abs() < 1e-12 && !found.ended && found.farthest > 1.0);
    let holds: Vec<_> = ends.0.iter().map(|&[holds, _]| holds).collect();
    assert_eq!(holds, [vec![1.0; 7], vec![0.0; 14]].concat());
    assert!((found.certified_fraction - 7.0 / 21.0).abs() < 1e-12);
    assert!(ends.0[8][1] < 0.1, "back in it");
    // After the end.
    let _ = watched.before(&mut ends).take(&rows[20]);
    assert!(ends.0[21][1].is_nan());
    let mut whole = beside(&file, &scenario);
    rows.iter().chain([&rows[20]]).for_each(|row| {
        let _ = whole.before(&mut ends).take(row);
    });
    assert!(whole.found().ended && whole.found().words().contains("ends before t = 0.021 s"));
}

fn rows(trace: &Trace) -> Vec<Vec<f64>> {
    let columns = trace.columns();
    (0..columns[0].values.len()).map(|k| columns.iter().map(|column| column.values[k]).collect()).collect()
}

/// A file says something of its loop alone: not of other gains, a shorter period, a limit that may act, or a push; a smooth start makes another reference
/// of another start.
#[test]
fn of_another_loop_nothing_is_said() {
    let (_, _, file) = short();
    let same = ["duration = 0.02", "integration_tolerance = 1e-12"];
    for (more, why) in [
        ("controller.link.damping = [1.0, 1.0]", "controller.link.damping[0]"),
        ("control_period = 0.0005", "loop.control_period"),
        ("reference.amplitude = [1.0, 0.9]", "reference.terms[0].amplitude[1]"),
        ("plant.spring_hardening = [1.0, 1.0]", "plant.spring_hardening"),
    ] {
        let other = scenario("two-link-linear", &[&same[..], &[more]].concat());
        let found = beside(&file, &other).found();
        assert!(found.void.as_ref().is_some_and(|void| void.contains(why)), "{more}: {found:?}");
    }
    let mut limited = scenario("two-link-linear", &same);
    limited.plant.unlimited = false;
    limited.robot.limits.torque = vec![5.0, 5.0];
    let limited = beside(&file, &limited).found();
    assert!(
        limited
            .void
            .is_some_and(|void| void.starts_with("loop.limits.torque[0] is null in the file and \"5\""))
    );
    // Numbers that nothing can be counted with.
    let huge = file.replace("\"periods\": 20", "\"periods\": 18446744073709551615");
    assert!(huge != file && Beside::new(&huge, &scenario("two-link-linear", &same)).unwrap().is_err());
    // Shorter ones are a part of it.
    let shorter = scenario("two-link-linear", &["duration = 0.01", same[1]]);
    assert_eq!(beside(&file, &shorter).found().void, None);
    let smooth = scenario("two-link-tanh-smooth", &LOOP);
    let file = found(&smooth, 1e-5).unwrap_or_else(|none| panic!("{}", none.at)).file(&smooth).unwrap();
    let elsewhere = scenario("two-link-tanh-smooth", &[&LOOP[..], &["initial.q_l = [1e-6, 0.0]"]].concat());
    let elsewhere = beside(&file, &elsewhere).found();
    assert!(elsewhere.void.is_some_and(|void| void.starts_with("initial[0]")));
}
