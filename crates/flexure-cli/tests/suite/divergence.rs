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
