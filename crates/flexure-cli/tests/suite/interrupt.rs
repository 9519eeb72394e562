//! Ctrl-C: what was found is printed, once, and the exit code says that it is a part.
#![cfg(unix)]

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::command::{Outcome, Place, SCENARIO, altered};

/// An arm that moves for more than an hour: longer than anybody waits here.
fn long() -> String {
    altered(SCENARIO, &[("duration = 10.0", "duration = 4500.0")])
}

fn started(place: &Place, args: &[&str]) -> Child {
    place.command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Presses Ctrl-C.
fn interrupt(child: &Child) {
    let pid = child.id().to_string();
    assert!(Command::new("sh").args(["-c", "kill -INT \"$0\"", &pid]).status().unwrap().success());
}

/// What a command prints that is broken off after `seconds`, and how long it took from then on.
fn broken_off(place: &Place, args: &[&str], seconds: f64) -> (Outcome, Duration) {
    let child = started(place, args);
    sleep(Duration::from_secs_f64(seconds));
    interrupt(&child);
    let since = Instant::now();
    let outcome = Outcome::from(child.wait_with_output().unwrap());
    assert_eq!(outcome.code, Some(130), "{outcome:?}");
    outcome.said(&["error[interrupted]", "broken off"]);
    (outcome, since.elapsed())
}

/// The document of a command that is broken off once `is_there` says that something was found: machines are slower and faster.
fn partial(place: &Place, args: &[&str], is_there: impl Fn(&Value) -> bool) -> Value {
    for seconds in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0] {
        let (outcome, _) = broken_off(place, &[args, &["--json"]].concat(), seconds);
        let document = outcome.json();
        assert_eq!(document["interrupted"], true, "{document}");
        assert_eq!(document["error"]["code"], "interrupted", "{document}");
        if is_there(&document) {
            return document;
        }
    }
    panic!("nothing was found by {args:?} in half a minute");
}

#[test]
fn a_run_ends_where_it_is_and_leaves_its_trace() {
    let place = Place::new();
    place.write("long.toml", long());
    let json = partial(&place, &["run", "long.toml"], |json| json["steps"].as_u64() > Some(0));
    assert_eq!(json["follows"], false);
    let reason = &json["reasons"][0];
    let end = reason["time"].as_f64().unwrap();
    assert!(end > 0.0 && end < 4500.0 && reason["words"].as_str().unwrap().contains("broken off"), "{json}");
    let trace = place.read("out/long.csv");
    let last: f64 = trace.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((last - end).abs() < 1e-9, "{last} {end}");
    assert_eq!(place.names("out"), ["long.csv", "long.png", "long.svg"]);

    let (outcome, _) = broken_off(&place, &["run", "long.toml", "--page", "pages"], 2.0);
    assert!(outcome.stdout.contains("long: broken off at t = "), "{outcome:?}");
    assert!(!outcome.stdout.contains("follows its reference"), "{outcome:?}");
    let page = place.read("pages/long.run.html");
    assert!(page.contains("<strong>– no verdict</strong> long: broken off at t = "), "{page}");
    assert!(
        page.contains("whether it follows its reference is not known") && !page.contains("does not follow")
    );
    // Nothing is proved of what was not looked at.
    assert!(!page.contains("proved bound"), "{page}");
}

/// Before its first instant a run has nothing, and leaves nothing.
#[test]
fn what_was_not_begun_leaves_no_file() {
    let place = Place::new();
    place.write("long.toml", long());
    for seconds in [0.05, 0.1, 0.2, 0.4] {
        broken_off(&place, &["run", "long.toml"], seconds);
        assert!(place.names("out").iter().all(|name| name.starts_with("long.")), "{:?}", place.names("out"));
    }
}

#[test]
fn margins_are_open_where_the_search_was() {
    let place = Place::new();
    let smooth = "[reference.smooth_start]\nduration = 0.5\n[controller]";
    place.write(
        "s.toml",
        altered(SCENARIO, &[("duration = 10.0", "duration = 400.0"), ("[controller]", smooth)]),
    );
    let args = ["margins", "s.toml", "--page", "pages"];
    let json = partial(&place, &args, |json| json["loops"].is_array());
    assert!(json["error"]["hint"].as_str().unwrap().contains("no page is written"), "{json}");
    assert_eq!(place.names("pages"), [""; 0]);
    let found = &json["loops"][0];
    let edges = ["delay", "gain_low", "gain_high", "stiffness_low", "stiffness_high", "noise"];
    assert!(edges.iter().any(|edge| found[edge]["edge"] == "open"), "{found}");
    assert!(
        edges.iter().filter(|edge| found[*edge]["edge"] == "open").all(|edge| found[edge]["holds"].is_f64())
    );
}

/// Laws one after the other: the task that every law was finished on is ranked, the other is not, and nothing is written.
#[test]
fn a_comparison_has_what_was_finished() {
    let place = Place::new();
    let duration = |seconds: &str| altered(SCENARIO, &[("duration = 10.0", seconds)]);
    place.write("quick.toml", duration("duration = 0.2")).write("slow.toml", duration("duration = 4500.0"));
    let args = ["compare", "quick.toml", "slow.toml", "--controllers", "vcbc,pd", "--budget", "2"];
    let json = partial(&place, &args, |json| json["tasks"].as_array().is_some_and(|tasks| !tasks.is_empty()));
    assert_eq!(json["tasks"].as_array().unwrap().len(), 1, "{json}");
    assert_eq!(json["tasks"][0]["task"], "quick");
    assert_eq!(json["ranking"].as_array().unwrap().len(), 2);
    assert_eq!(json["files"].as_array().unwrap().len(), 0);
    assert_eq!(place.names("out"), [""; 0]);
}

#[test]
fn a_proof_has_its_rates_and_no_certificate() {
    let place = Place::new();
    let args = ["certify", "panda-tanh-smooth", "--direct", "--budget", "1000000"];
    let json = partial(&place, &args, |json| json["contraction_rate"].is_f64());
    assert!(json["contraction_rate"].as_f64().unwrap() > 1.0);
    assert_eq!((&json["file"], &json["verdict"]), (&Value::Null, &"undecided".into()));
    assert_eq!(place.names("out"), [""; 0]);
}

/// A tube that was looked for unasked, and not waited for, takes nothing from the certificate.
#[test]
fn a_proof_whose_tube_was_not_waited_for_has_its_certificate() {
    let place = Place::new();
    let args = ["certify", "two-link-tanh-smooth", "--set", "duration=30"];
    let json = partial(&place, &args, |json| json["contraction_rate"].is_f64());
    assert_eq!((&json["step"], &json["sampled_tube"]), (&"ideal".into(), &Value::Null));
    assert_eq!(json["file"], "out/two-link-tanh-smooth.certificate.json");
    assert_eq!(place.names("out"), ["two-link-tanh-smooth.certificate.json"]);
}

/// A search for gains that is broken off has the best so far, and writes it if it keeps what was looked at.
#[test]
fn a_search_for_gains_keeps_the_best_so_far() {
    let place = Place::new();
    let scenario = "robot = \"two-link-plausible\"\nduration = 2.0\ncontrol_period = 0.001\ninitial = \"at rest\"\n\
                    [reference]\nkind = \"sine\"\namplitude = 0.05\nfrequency = 3.0\n\
                    [reference.smooth_start]\nduration = 0.5\n[controller]\nkind = \"vcbc\"\n\
                    [disturbance_observer]\nbandwidth = 20.0\n\
                    [[imperfection]]\nkind = \"delay\"\ncomputation = 0.001\n";
    place.write("arm.toml", scenario);
    let args = ["tune", "arm.toml", "--budget", "100000"];
    let json = partial(&place, &args, |json| json["runs"].as_u64() > Some(0));
    assert_eq!(json["gains"].as_array().map(Vec::len), Some(6), "{json}");
    assert_eq!(json["feasible"] == true, place.path().join("arm-tuned.toml").exists(), "{json}");
}

/// What waits for a writer that never comes ends all the same, says one thing, and writes nothing.
#[test]
fn a_command_that_waits_is_ended() {
    let place = Place::new();
    assert!(Command::new("mkfifo").arg(place.path().join("pipe")).status().unwrap().success());
    for args in [
        &["eval", "two-link-tanh", "--states", "./pipe"][..],
        &["check", "./pipe"],
        &["run", "./pipe"],
        &["verify", "./pipe"],
    ] {
        let (outcome, took) = broken_off(&place, args, 1.0);
        assert_eq!(outcome.stdout, "", "{outcome:?}");
        assert!(took < Duration::from_secs(5), "{took:?}");
        let (outcome, _) = broken_off(&place, &[args, &["--json"]].concat(), 1.0);
        assert_eq!(outcome.json()["interrupted"], true);
        assert_eq!(place.names("out"), [""; 0]);
    }
}

#[test]
fn the_second_ctrl_c_ends_at_once() {
    let place = Place::new();
    place.write("long.toml", long());
    let child = started(&place, &["run", "long.toml"]);
    sleep(Duration::from_secs(1));
    interrupt(&child);
    // A signal that is still to be delivered is not counted twice.
    sleep(Duration::from_millis(5));
    interrupt(&child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
}

/// The proof takes a moment, the run for its picture minutes.
#[test]
fn a_proof_is_there_where_its_picture_was_not_waited_for() {
    let place = Place::new();
    place.write("long.toml", long());
    let args = ["certify", "long.toml", "--out", "c.json", "--page", "pages"];
    let (outcome, time) = broken_off(&place, &args, 4.0);
    assert!(
        outcome.stdout.contains("wrote c.json") && outcome.stdout.contains("long: proved"),
        "{outcome:?}"
    );
    assert!(time < Duration::from_secs(5), "{time:?}");
    assert_eq!(place.names("pages"), Vec::<String>::new());
    outcome.said(&["its page is not"]);
}
