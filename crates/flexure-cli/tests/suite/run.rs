//! `flexure run`: one closed loop and its files.

use serde_json::Value;

use crate::command::{Place, ROBOT, assert_summary};

const SHORT: (&str, &str) = ("duration = 10.0", "duration = 0.05");

#[test]
fn text_names_the_files_and_json_has_the_summary() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    let text = place.run(&["run", "short.toml"]).done();
    assert_eq!(text.stderr, "");
    let files = ["out/short.csv", "out/short.svg", "out/short.png"];
    for file in files {
        assert!(text.stdout.contains(&format!("wrote {file}")), "{}", text.stdout);
    }
    let trace = place.read("out/short.csv");

    let summary = place.run(&["run", "short.toml", "--json", "--out", "other/place"]).done().json();
    assert_summary(&summary);
    assert_eq!(summary["name"], "short");
    assert_eq!((&summary["controller"], &summary["phi"]), (&"vcbc".into(), &"tanh".into()));
    assert_eq!(summary["diverged_at"], Value::Null);
    assert_eq!(summary["files"][0], "other/place/short.csv");
    assert_eq!(place.names("other/place"), ["short.csv", "short.png", "short.svg"]);
    assert_eq!(place.read("other/place/short.csv"), trace);
}

#[test]
fn the_trace_has_a_row_an_instant_and_numbers_everywhere() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    place.run(&["run", "short.toml"]).done();
    let trace = place.read("out/short.csv");
    let mut lines = trace.lines();
    let header: Vec<_> = lines.next().unwrap().split(',').collect();
    let vectors = ["q_l", "q_m", "dq_l", "dq_m", "q_ld", "e_l", "e_m", "sigma_l", "sigma_m", "u_l", "u_m"];
    for column in vectors.iter().flat_map(|name| [format!("{name}1"), format!("{name}2")]) {
        assert!(header.contains(&&*column), "{column} in {header:?}");
    }
    assert_eq!(header[0], "t");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 51, "both ends are recorded");
    assert!(rows.iter().all(|row| row.len() == header.len() && row.iter().all(|x| x.is_finite())));
    for (k, row) in (0_u32..).zip(&rows) {
        assert!((row[0] - 1e-3 * f64::from(k)).abs() < 1e-12, "row {k} is at {} s", row[0]);
    }
}

/// The files are those of the built-in scenario under another name: so are the numbers.
#[test]
fn a_scenario_elsewhere_names_its_robot_by_a_relative_path() {
    let place = Place::new();
    place.write("data/robots/arm.toml", ROBOT);
    place.scenario("data/scenarios/mine.toml", &[("\"quanser-2dof\"", "\"../robots/arm.toml\""), SHORT]);
    place.scenario("built-in.toml", &[SHORT]);
    place.run(&["run", "data/scenarios/mine.toml"]).refused(&["mine.toml:3:9", "--allow-outside"]);
    place.run(&["run", "data/scenarios/mine.toml", "--allow-outside"]).done();
    place.run(&["run", "built-in.toml"]).done();
    assert_eq!(place.read("out/mine.csv"), place.read("out/built-in.csv"));
    let absolute = place.path().join("data/scenarios/mine.toml");
    let elsewhere = Place::new();
    elsewhere.run(&["--allow-outside", "run", absolute.to_str().unwrap()]).done();
    assert_eq!(elsewhere.read("out/mine.csv"), place.read("out/mine.csv"));
}

#[test]
fn an_uneven_duration_is_said_and_rounded_to_whole_periods() {
    let place = Place::new();
    place.scenario("uneven.toml", &[("duration = 10.0", "duration = 0.0124")]);
    let outcome = place.run(&["run", "uneven.toml"]).done();
    for fragment in ["uneven.toml:4:", "no multiple of control_period", "12 periods, 0.012 s"] {
        assert!(outcome.stderr.contains(fragment), "{}", outcome.stderr);
    }
    assert_eq!(outcome.stderr.matches("warning[").count(), 1, "{}", outcome.stderr);
    assert_eq!(place.read("out/uneven.csv").lines().count(), 14);
}

#[test]
fn a_later_run_replaces_the_files_of_an_earlier_one() {
    let place = Place::new();
    place.write("out/short.csv", "old").scenario("short.toml", &[SHORT]);
    place.run(&["run", "short.toml"]).done();
    assert!(place.read("out/short.csv").starts_with("t,"));
    assert_eq!(place.names("out").len(), 3);
}

/// A loop that misses every deadline stays where it is, bounded and lost: the answer is no, with joint, value, limit and time.
#[test]
fn a_loop_that_does_not_follow_is_an_answer() {
    let place = Place::new();
    let late = "[[imperfection]]\nkind = \"deadline\"\nprobability = 1.0\n\n[sources]";
    place.scenario("late.toml", &[("duration = 10.0", "duration = 2.0"), ("[sources]", late)]);
    let outcome = place.run(&["run", "late.toml"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&[
        "error[lost]",
        "late: the loop does not follow: joint joint1: position error of",
        "[accept]",
    ]);
    assert!(outcome.stdout.contains("follows its reference: no; accepted are"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("from t = 1 s on (half of the run)"), "{}", outcome.stdout);

    let outcome = place.run(&["run", "late.toml", "--json"]);
    assert_eq!(outcome.code, Some(1));
    let summary = outcome.json();
    assert_summary(&summary);
    assert_eq!((&summary["follows"], &summary["diverged_at"]), (&false.into(), &Value::Null));
    let reason = &summary["reasons"][0];
    assert_eq!((&reason["joint"], &reason["measure"]), (&"joint1".into(), &"error".into()));
    assert_eq!(reason["limit"], 0.05);
    assert!(reason["value"].as_f64().unwrap() > 0.8 && reason["time"].as_f64().unwrap() >= 1.0, "{reason}");
    assert_eq!(summary["accepted"]["bounds"].as_array().unwrap().len(), 6);

    place.scenario("sound.toml", &[("duration = 10.0", "duration = 0.5")]);
    let outcome = place.run(&["run", "sound.toml", "--json"]).done();
    assert_eq!(
        (&outcome.json()["follows"], &outcome.json()["reasons"]),
        (&true.into(), &Value::Array(vec![]))
    );
}

#[test]
fn what_is_accepted_is_checked() {
    let place = Place::new();
    for (line, fragments) in [
        ("error = -0.1", ["accept.error", "must be > 0"]),
        ("settling = 20.0", ["accept.settling is 20 s", "must be < duration, 10 s"]),
        ("at_limit = 2.0", ["accept.at_limit", "2"]),
        ("errors = 0.1", ["unknown key 'errors' in [accept]", "did you mean 'error'?"]),
        ("speed = [1.0, 2.0, 3.0]", ["accept.speed: 2 numbers expected", "got 3"]),
    ] {
        place.scenario("bad.toml", &[("error = 0.05", line)]);
        place.run(&["run", "bad.toml"]).refused(&fragments);
    }
}
