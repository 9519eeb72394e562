//! `flexure replay` and `flexure excite`: logs and the motion to log.

use std::fmt::Write;

use serde_json::Value;

use crate::command::{Place, ROBOT};

const SHORT: (&str, &str) = ("duration = 10.0", "duration = 0.3");

/// A folder with a short scenario and the trace of its run.
fn logged() -> Place {
    let place = Place::new();
    place.scenario("s.toml", &[SHORT]);
    place.run(&["run", "s.toml"]).done();
    place
}

#[test]
fn a_trace_is_laid_over_its_own_run() {
    let place = logged();
    let text = place.run(&["replay", "s.toml", "--log", "out/s.csv", "--out", "laid"]).done();
    for fragment in
        ["predicted", "loop", "301 samples, 1000 Hz", "wrote laid/s.replay.csv", "laid/s.replay.png"]
    {
        assert!(text.stdout.contains(fragment), "{fragment}: {}", text.stdout);
    }
    assert!(text.stdout.lines().all(|line| line.chars().count() <= 120), "{}", text.stdout);
    assert_eq!(place.names("laid"), ["s.replay.csv", "s.replay.png", "s.replay.svg"]);
    let header = place.read("laid/s.replay.csv").lines().next().unwrap().to_owned();
    for column in ["t", "q_l1", "q_m_loop2", "deflection_predicted1", "q_l_residual2", "u_m_loop_residual1"] {
        assert!(header.split(',').any(|name| name == column), "{column} in {header}");
    }
    let found =
        place.run(&["replay", "s.toml", "--log", "out/s.csv", "--out", "again", "--json"]).done().json();
    assert_eq!((&found["samples"], &found["diverged_at"]), (&301.into(), &Value::Null));
    for joint in found["joints"].as_array().unwrap() {
        assert_eq!(joint["loop_q_l"]["rms"], 0.0);
        // The run starts off its reference with thousands of N m, and the first window's start is no cubic: a number, not a small one.
        assert!(joint["predicted_deflection"]["rms"].as_f64().is_some_and(|rms| rms > 0.0), "{joint}");
    }
    assert_eq!(place.read("again/s.replay.csv"), place.read("laid/s.replay.csv"));
    assert_eq!(found["files"].as_array().unwrap().len(), 3);
}

/// The same log under other names, in degrees, as a trace.
#[test]
fn columns_are_said_on_a_line_or_in_a_file() {
    let place = logged();
    let trace = place.read("out/s.csv");
    let mut lines = trace.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let at = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let mut text = "stamp;m1;m2;tau a;tau b\n".to_owned();
    for row in lines {
        let degrees = |name| row[at(name)].parse::<f64>().unwrap().to_degrees();
        let (t, [a, b]) = (1e3 * row[0].parse::<f64>().unwrap(), [row[at("u_m1")], row[at("u_m2")]]);
        writeln!(text, "{t};{};{};{a};{b}", degrees("q_m1"), degrees("q_m2")).unwrap();
    }
    place.write("log.csv", text);
    let map = "t = { column = \"stamp\", unit = \"ms\" }\nq_m = { columns = \"m{}\", unit = \"deg\" }\nu_m = [\"tau a\", \"tau b\"]\n";
    place.write("map.toml", map);
    let replay = |columns: &str| {
        place.run(&["replay", "s.toml", "--log", "log.csv", "--columns", columns, "--json"]).done().json()
    };
    let found = replay("map.toml");
    for joint in found["joints"].as_array().unwrap() {
        assert!(joint["loop_q_m"]["rms"].as_f64().unwrap() < 1e-12);
        assert_eq!(joint["loop_q_l"], Value::Null);
    }
    let refused =
        place.run(&["replay", "s.toml", "--log", "log.csv", "--columns", "t=stamp,q_m=m{},u_m=tau {}"]);
    refused.refused(&["no column 'tau 1'", "known: stamp, m1"]);
}

/// What is wrong with a log is one message, exit code 2, and nothing is written.
#[test]
fn nasty_logs() {
    let place = logged();
    let trace = place.read("out/s.csv");
    let with = |change: &dyn Fn(usize, &str) -> Option<String>| -> String {
        trace.lines().enumerate().filter_map(|(i, line)| change(i, line)).map(|line| line + "\n").collect()
    };
    let same = |line: &str| Some(line.to_owned());
    let cell = |line: &str, column: usize, value: &str| {
        let mut cells: Vec<_> = line.split(',').collect();
        cells[column] = value;
        Some(cells.join(","))
    };
    let cases: [(String, &[&str]); 12] = [
        (String::new(), &["log.csv", "is empty"]),
        ("\0\0\0\u{1b}[2J".repeat(50), &["header"]),
        (
            with(&|i, line| if i == 100 { cell(line, 1, "nan") } else { same(line) }),
            &["log.csv:101:", "is NaN"],
        ),
        (
            with(&|i, line| if i == 100 { cell(line, 1, "1,5") } else { same(line) }),
            &["log.csv:101:", "cells in this row"],
        ),
        (
            with(&|i, line| if i == 100 { cell(line, 1, "zwölf") } else { same(line) }),
            &["log.csv:101:", "must be a number"],
        ),
        (
            with(&|i, line| (!(100..150).contains(&i)).then(|| line.to_owned())),
            &["log.csv:101", "samples are missing", "gaps: 1"],
        ),
        (
            with(&|i, line| if i == 100 { cell(line, 0, "0.0") } else { same(line) }),
            &["log.csv:101:1", "runs back"],
        ),
        (with(&|i, line| (i < 60).then(|| line.to_owned())), &["59 samples", "at least 100"]),
        (
            with(&|i, line| if i == 0 { same(&line.replace("u_m", "torque")) } else { same(line) }),
            &["no column 'u_m1'"],
        ),
        (
            with(&|i, line| if i == 0 { same(&line.replace("q_l2,", "q_l9,")) } else { same(line) }),
            &["no column 'q_l2'"],
        ),
        (
            with(&|i, line| if i == 200 { same(&line[..line.len() / 2]) } else { same(line) }),
            &["log.csv:201:1", "as in the header"],
        ),
        (
            with(&|i, line| if i == 0 { same(line) } else { cell(line, 3, &format!("{}", 3 * i)) }),
            &["joint1", "motor"],
        ),
    ];
    for (text, fragments) in cases {
        place.write("log.csv", text);
        for json in [false, true] {
            let mut args = vec!["replay", "s.toml", "--log", "log.csv", "--out", "laid"];
            args.extend(json.then_some("--json"));
            let outcome = place.run(&args);
            if json { outcome.error_taken().refused(fragments) } else { outcome.refused(fragments) }
        }
        assert_eq!(place.names("."), ["log.csv", "out", "s.toml"], "nothing is written");
    }
    place.run(&["replay", "s.toml", "--log", "none.csv"]).refused(&["cannot read none.csv"]);
    let nowhere = ["replay", "s.toml", "--log", "out/s.csv", "--horizon", "0", "--out", "new/folder"];
    place.run(&nowhere).refused(&["horizon is 0 s"]);
    assert_eq!(place.names("."), ["log.csv", "out", "s.toml"], "no folder is made");
    place.run(&["replay", "s.toml", "--log", "."]).refused(&["cannot read ."]);
    assert_eq!(place.run(&["replay", "s.toml"]).code, Some(2));
    place.run(&["replay", "s.toml", "--log", "out/s.csv", "--horizon", "0"]).refused(&["horizon is 0 s"]);
    place.run(&["replay", "s.toml", "--log", "out/s.csv", "--horizon", "nan"]).refused(&["horizon is NaN s"]);
    place.run(&["replay", "pendulum-tanh", "--log", "out/s.csv"]).refused(&["more than the 1 joints"]);
}

/// The scenario that is written is checked, run, and its trace is a log.
#[test]
fn a_designed_motion_runs_and_is_logged() {
    let place = Place::new();
    let design =
        ["excite", "two-link-plausible", "--duration", "4", "--control-period", "0.002", "--budget", "20"];
    let text = place.run(&design).done();
    assert!(
        text.stdout.contains("± K") && text.stdout.contains("wrote two-link-plausible-excite.toml"),
        "{}",
        text.stdout
    );
    assert_eq!(place.names("."), ["two-link-plausible-excite.toml"]);
    let written = place.read("two-link-plausible-excite.toml");
    let found = place.run(&[&design[..], &["--json", "--out", "motions/m.toml"]].concat()).done().json();
    assert_eq!(found["toml"].as_str().unwrap(), written, "the same seed, the same motion");
    assert_eq!(place.read("motions/m.toml"), written);
    assert_eq!(found["joints"].as_array().unwrap().len(), 2);
    assert!(found["usage"].as_array().unwrap().iter().all(|usage| usage["share"].as_f64().unwrap() < 0.81));
    place.run(&["check", "motions/m.toml"]).done();
    place.run(&["run", "motions/m.toml"]).done();
    let laid = place.run(&["replay", "motions/m.toml", "--log", "out/m.csv", "--json"]).done().json();
    assert!(laid["joints"][0]["loop_q_l"]["rms"].as_f64().unwrap() < 1e-4);
}

#[test]
fn motions_that_cannot_be_designed() {
    let place = Place::new();
    for (args, fragments) in [
        (&["excite", "panda", "--duration", "1"][..], &["--duration is 1 s", "from 2 to 600"][..]),
        (&["excite", "panda", "--duration", "nan"], &["--duration is NaN s"]),
        (&["excite", "panda", "--control-period", "1e-9"], &["--control-period"]),
        (&["excite", "panda", "--budget", "0"], &["--budget is 0"]),
        (&["excite", "panda", "--link-resolution", "-1"], &["one count is -1 rad"]),
        (&["excite", "pendulum-1dof"], &["torque_limit", "how hard"]),
        (&["excite", "none.toml"], &["cannot read"]),
        (&["excite", "pandaa"], &["panda"]),
        (&["excite", "two-link-tanh"], &["two-link-tanh"]),
        (&["excite", "pendulum-1dof", "--out", "new/folder/m.toml"], &["torque_limit"]),
    ] {
        place.run(args).refused(fragments);
        assert_eq!(place.names("."), Vec::<String>::new(), "{args:?}");
    }
    // No file is lost, be it the robot's.
    place.write("arm.toml", ROBOT).write("notes.md", "# Notes");
    for (out, reason) in
        [("arm.toml", "is what is read"), ("notes.md", "is no motion"), (".", "is no motion")]
    {
        let args = ["excite", "arm.toml", "--duration", "4", "--budget", "1", "--out", out];
        place.run(&args).refused(&[reason, "it is left as it is", "name another file"]);
    }
    assert_eq!((place.read("arm.toml"), place.read("notes.md")), (ROBOT.to_owned(), "# Notes".to_owned()));
}
