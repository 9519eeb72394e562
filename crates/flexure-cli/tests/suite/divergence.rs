//! A control period at which the loop diverges: the answer is no, and what happened until then is kept.

use serde_json::Value;

use crate::command::{Place, SCENARIO, altered, assert_summary};

const HALF_RATE: (&str, &str) = ("control_period = 0.001", "control_period = 0.002");

#[test]
fn the_paper_gains_diverge_at_500_hertz() {
    let place = Place::new();
    place.scenario("slow.toml", &[HALF_RATE]);
    let outcome = place.run(&["run", "slow.toml"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&[
        "slow.toml:5:18",
        "slow: the loop diverged at t = ",
        "unstable",
        "control_period = 0.001 is short enough",
    ]);
    assert_eq!(place.names("out"), ["slow.csv", "slow.png", "slow.svg"]);

    let outcome = place.run(&["run", "slow.toml", "--json"]);
    assert_eq!(outcome.code, Some(1));
    let summary = outcome.json();
    assert_summary(&summary);
    let diverged_at = summary["diverged_at"].as_f64().unwrap();
    assert!(diverged_at > 0.0 && diverged_at < 10.0);
    assert_eq!(summary["settling_time"], Value::Null);
    outcome.said(&[&format!("t = {diverged_at:.4} s")]);
    assert_eq!(place.names("out"), ["slow.csv", "slow.png", "slow.svg"], "and no temporary file");

    let trace = place.read("out/slow.csv");
    let times: Vec<f64> =
        trace.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    let last = *times.last().unwrap();
    assert!(last <= diverged_at && diverged_at - last <= 2.0 * 0.002, "{last} and {diverged_at}");
    assert!(
        trace.lines().skip(1).flat_map(|line| line.split(',')).all(|x| x.parse::<f64>().unwrap().is_finite())
    );
}

#[test]
fn a_loop_that_diverges_at_once_has_no_figures_and_a_trace_of_a_header() {
    let start = "q_l = [0.0, 0.0]\nq_m = [0.0, 0.0]";
    let smooth = "[reference.smooth_start]\nduration = 1.0\n[controller]";
    let text =
        altered(SCENARIO, &[(start, "q_l = [1e20, 0.0]\nq_m = [1e20, 0.0]"), ("[controller]", smooth)]);
    let place = Place::new();
    place.write("far.toml", text);
    let outcome = place.run(&["run", "far.toml", "--json"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    let summary = outcome.json();
    assert_summary(&summary);
    assert_eq!(summary["diverged_at"], 0.0);
    for key in ["max_abs_e_l", "rms_e_l", "final_abs_e_l", "max_abs_u_m", "rms_u_m", "rate_pointwise"] {
        assert_eq!(summary[key], Value::Null, "{key}");
    }
    assert_eq!(place.read("out/far.csv").lines().count(), 1);
    let table = place.run(&["run", "far.toml"]).stdout;
    assert!(table.contains('—') && !table.contains("NaN"), "{table}");
}

/// It stands still where it shall, for so short a time that nothing shows: yet small errors would grow, and every command says no.
#[test]
fn a_loop_that_is_unstable_is_a_no_even_if_its_run_ends_before() {
    let place = Place::new();
    let standing = [
        HALF_RATE,
        ("duration = 10.0", "duration = 0.02"),
        ("amplitude = [1.0, 1.0]", "amplitude = [0.0, 0.0]"),
    ];
    place.scenario("still.toml", &standing);
    let outcome = place.run(&["run", "still.toml", "--json"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    let summary = outcome.json();
    assert_eq!((&summary["follows"], &summary["sampled"]["stable"]), (&true.into(), &false.into()));
    let compare: &[&str] = &["compare", "still.toml", "--controllers", "vcbc", "--budget", "1"];
    for command in [&["check", "still.toml"][..], &["margins", "still.toml"], &["certify", "still.toml"]] {
        let outcome = place.run(command);
        assert_eq!(outcome.code, Some(1), "{command:?}: {outcome:?}");
        outcome.said(&["unstable"]);
    }
    // The search finds other gains: whether these are stable decides.
    let outcome = place.run(&[compare, &["--json"]].concat());
    let score = &outcome.json()["tasks"][0]["scores"][0];
    assert_eq!(score["follows"], score["sampled"]["stable"], "{score}");
}

/// With 40 ms of delay at 1 kHz nobody looks at the sampled loop: that is said, and nothing is said to shrink.
#[test]
fn a_loop_that_is_not_looked_at_says_so() {
    let place = Place::new();
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 0.04\n\n[sources]";
    place.scenario("late.toml", &[("duration = 10.0", "duration = 2.0"), ("[sources]", late)]);
    let words = "sampled loop: not looked at, 80 torques";
    let checked = place.run(&["check", "late.toml"]).done();
    assert!(checked.stderr.contains("not looked at"), "{checked:?}");
    let outcome = place.run(&["run", "late.toml"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stdout.contains(words) && !outcome.stderr.contains("small errors shrink"), "{outcome:?}");
}
