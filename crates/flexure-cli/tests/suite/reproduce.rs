//! `flexure reproduce`: every experiment, and the same bytes every time.

use std::fs;

use serde_json::Value;

use crate::command::{Place, assert_summary};

const EXPERIMENTS: [&str; 8] = [
    "two-link-tanh",
    "two-link-linear",
    "two-link-coupled-tanh",
    "two-link-tanh-smooth",
    "two-link-linear-smooth",
    "two-link-coupled-tanh-smooth",
    "two-link-tanh-sensors",
    "two-link-coupled-tanh-sensors",
];

/// Those that converge practically.
const PRACTICAL: [&str; 2] = ["two-link-tanh-sensors", "two-link-coupled-tanh-sensors"];

/// Those whose rates are proved.
const CERTIFIED: [&str; 3] = ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh"];

/// Every wall-clock time set to zero: all that may differ between two runs.
fn timeless(mut document: Value) -> Value {
    for scenario in document["scenarios"].as_array_mut().unwrap() {
        scenario["wall_seconds"] = 0.into();
    }
    for certificate in document["certificates"].as_array_mut().unwrap() {
        certificate["wall_seconds"] = 0.into();
    }
    document
}

#[test]
fn all_files_the_same_bytes_on_any_number_of_threads() {
    let place = Place::new();
    let run = |threads: &str| {
        let mut command = place.command(&["reproduce", "--json", "--out", "out"]);
        let outcome: crate::command::Outcome =
            command.env("RAYON_NUM_THREADS", threads).output().unwrap().into();
        let document = outcome.done().json();
        fs::rename(place.path().join("out"), place.path().join(threads)).unwrap();
        document
    };
    let (one, four) = (run("1"), run("4"));
    assert_eq!(timeless(one.clone()), timeless(four));

    let mut expected: Vec<_> = EXPERIMENTS
        .iter()
        .flat_map(|name| ["csv", "svg", "png"].map(|ending| format!("{name}.{ending}")))
        .collect();
    expected.extend(CERTIFIED.map(|name| format!("{name}.certificate.json")));
    expected.push("report.html".into());
    expected.sort();
    assert_eq!(place.names("1"), expected);
    assert_eq!(place.names("4"), expected);
    for name in &expected {
        let bytes = |folder: &str| fs::read(place.path().join(folder).join(name)).unwrap();
        assert!(bytes("1") == bytes("4"), "{name} differs");
    }

    let scenarios = one["scenarios"].as_array().unwrap();
    let names: Vec<_> = scenarios.iter().map(|scenario| scenario["name"].as_str().unwrap()).collect();
    assert_eq!(names, EXPERIMENTS);
    for scenario in scenarios {
        assert_summary(scenario);
        assert_eq!(scenario["diverged_at"], Value::Null);
        assert_eq!(scenario["files"].as_array().unwrap().len(), 3);
    }
    let certificates = one["certificates"].as_array().unwrap();
    for (certificate, name) in certificates.iter().zip(CERTIFIED) {
        assert_eq!((&certificate["name"], &certificate["verdict"]), (&name.into(), &"proved".into()));
        assert_eq!(certificate["direct"]["verdict"], "proved", "the full inequality says so too");
        place.run(&["verify", &format!("1/{name}.certificate.json")]).done();
    }
    let practical = one["practical"].as_array().unwrap();
    assert_eq!(practical.len(), PRACTICAL.len());
    for (bounds, name) in practical.iter().zip(PRACTICAL) {
        assert_eq!((&bounds["name"], &bounds["from"]), (&name.into(), &5.0.into()));
        let alone: Vec<_> = bounds["alone"].as_object().unwrap().keys().collect();
        assert_eq!(alone, ["encoder", "velocity-filter"]);
        // The largest is what the run was held to, and the figure says it.
        let scenario = scenarios.iter().find(|scenario| scenario["name"] == name).unwrap();
        let links = bounds["links"].as_array().unwrap().iter().map(|link| link.as_f64().unwrap());
        assert_eq!(Value::from(links.fold(0.0, f64::max)), scenario["used"][0]["value"]);
        assert_eq!(scenario["rate_certified"], Value::Null, "nothing is proved of a loop with sensors");
        assert!(place.read(&format!("1/{name}.svg")).contains("from 5 s on: "), "{name}");
    }
    assert_eq!(one["report"], "out/report.html");
    let page = place.read("1/report.html");
    for name in EXPERIMENTS {
        assert!(page.contains(name), "{name}");
    }
}

#[test]
fn the_table_has_a_line_a_run_and_fits_100_columns() {
    let place = Place::new();
    let outcome = place.run(&["reproduce"]).done();
    assert_eq!(outcome.stderr, "", "progress is for terminals");
    assert!(outcome.stdout.lines().all(|line| line.chars().count() <= 100), "{}", outcome.stdout);
    for name in EXPERIMENTS {
        let of_run = |line: &&str| line.split_whitespace().next() == Some(name);
        // Of the summary, of the proof, of all imperfections and each of the two alone.
        let lines = 1 + usize::from(CERTIFIED.contains(&name)) + 3 * usize::from(PRACTICAL.contains(&name));
        assert_eq!(outcome.stdout.lines().filter(of_run).count(), lines, "{name} in\n{}", outcome.stdout);
    }
    assert!(outcome.stdout.contains("out/report.html"));
    assert_eq!(place.names("out").len(), 28);
}
