//! The second checker of tubes, in Python, accepts what is written, for arms and trees, early and late, and nothing that says more.
//!
//! Set `FLEXURE_OFFLINE=1` to leave the test out where python-flint cannot be had.

use serde_json::{Value, json};

use crate::common::packed::{numbers, text_of};
use crate::common::python;
use crate::sampled_tubes::file::file;
use crate::sampled_tubes::readings::hardware;
use crate::sampled_tubes::{scenario, with_delay};

/// Exit code and words for a file, so many of whose periods are followed.
fn checked(text: &str, sample: usize) -> Option<(i32, String)> {
    python::checked("check_tube.py", text, sample)
}

/// The file with another `value` at a `place`.
fn with(document: &Value, place: &str, value: Value) -> String {
    let mut other = document.clone();
    *other.pointer_mut(place).unwrap() = value;
    other.to_string()
}

/// The file with so many times as much at a `place`.
fn claimed(document: &Value, place: &str, factor: f64) -> String {
    let claim: f64 = document.pointer(place).unwrap().as_str().unwrap().parse().unwrap();
    with(document, place, json!(format!("{}", claim * factor)))
}

#[test]
fn the_second_checker_accepts_tubes() {
    let late = |delay: f64| {
        let mut late = with_delay(delay);
        late.duration = 0.12;
        late
    };
    let moving = ["duration = 0.12", "reference.smooth_start.duration = 0.1"];
    // Under gravity, at rest but for rounding: their smooth start brings them to rest.
    let tree = ["duration = 0.01"];
    for (scenario, error, sample) in [
        (scenario("two-link-tanh-smooth", &moving), 1e-5, 3),
        (scenario("two-link-linear-smooth", &moving), 1e-5, 2),
        (late(5e-4), 1e-5, 2),
        (scenario("planar-2r-tanh", &tree), 1e-5, 2),
        (scenario("planar-3r-tanh", &tree), 1e-6, 1),
    ] {
        let Some((code, said)) = checked(&file(&scenario, error), sample) else {
            println!("left out: FLEXURE_OFFLINE is set and python3 has no python-flint");
            return;
        };
        println!("{}: {said}", scenario.name);
        assert!(code == 0 && said.contains("proved for periods 0"), "{}: {said}", scenario.name);
    }
}

/// The arm as its hardware runs it, for so long in s, on counts of 15 µrad, with other `changes` of its text.
fn counted(seconds: &str, changes: &[(&str, &str)]) -> String {
    let duration = format!("duration = {seconds}");
    let own = [("duration = 0.5", duration.as_str()), ("resolution = 1e-4", "resolution = 1.5e-5")];
    file(&hardware(&[&own, changes].concat()), 5e-4)
}

/// Filters, readings that are off, torques a part of a period late; every period, and a sample whose P it has to find from the readings before.
#[test]
fn the_second_checker_finds_what_readings_do() {
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 1e-3\n\n[sources]";
    for (text, sample, of) in [
        (counted("0.04", &[]), 20, "proved for all 20 periods"),
        (counted("0.04", &[("[sources]", late)]), 2, "proved for periods 0, 19 of 20"),
    ] {
        let Some((code, said)) = checked(&text, sample) else { return };
        println!("{said}");
        assert!(code == 0 && said.contains(of), "{said}");
    }
}

/// Readings that are off by more than the file is of, and claims and numbers that say more.
#[test]
fn the_second_checker_is_not_fooled_about_readings() {
    let text = counted("0.012", &[]);
    let document: Value = serde_json::from_str(&text).unwrap();
    let with = |place: &str, value: Value| with(&document, place, value);
    let claimed = |place: &str, factor: f64| claimed(&document, place, factor);
    let narrower = |k: usize, i: usize, factor: f64| {
        let mut all = numbers(&document["sections"][k]);
        all[i] *= factor;
        with(&format!("/sections/{k}"), text_of(&all))
    };
    let refuted = [
        (claimed("/claims/rate", 1.25), "rate"),
        (claimed("/claims/error/2", 0.98), "error"),
        (claimed("/claims/torque/0", 0.98), "torque"),
        (with("/loop/off/2", json!("1.5e-4")), "torque"),
        // The first number of L after the sixteen of the middle.
        (narrower(4, 16, 0.9), "period 3"),
        // Readings that are forgotten at once.
        (with("/kept", json!(vec![0; 7])), "period 0"),
        (claimed("/loop/filter/forward/0", 1.01), "the start is not in E_0"),
    ];
    for (text, what) in refuted {
        let Some((code, said)) = checked(&text, 20) else { return };
        assert!(code == 1 && said.contains(what), "{what}: {said}");
    }
    let (code, said) = checked(&with("/loop/off", json!(["1e-5"])), 20).unwrap();
    assert!(code == 2 && said.contains("off has another length"), "{said}");
}

/// A period or two of the arm with the paper's gains, with claims and numbers that say more, and what is no such file.
#[test]
fn the_second_checker_is_not_fooled() {
    let scenario =
        scenario("two-link-tanh-smooth", &["duration = 0.002", "reference.smooth_start.duration = 0.1"]);
    let text = file(&scenario, 1e-5);
    let document: Value = serde_json::from_str(&text).unwrap();
    let with = |place: &str, value: Value| with(&document, place, value);
    let claimed = |place: &str, factor: f64| claimed(&document, place, factor);
    let section = |k: usize, i: usize, change: &dyn Fn(f64) -> f64| {
        let mut moved = numbers(&document["sections"][k]);
        moved[i] = change(moved[i]);
        with(&format!("/sections/{k}"), text_of(&moved))
    };
    let refuted = [
        (claimed("/claims/rate", 1.02), "rate"),
        (claimed("/claims/error/0", 0.99), "error"),
        (claimed("/claims/torque/1", 0.99), "torque"),
        // The run is then so far from the middle.
        (section(1, 0, &|c| c + 1e-9), "error"),
        (section(1, 8, &|l| 0.99 * l), "period 0"),
        (section(0, 0, &|c| c + 2e-5), "the start is not in E_0"),
        (with("/loop/control_period", json!("0.0011")), "period 0"),
    ];
    for (text, what) in refuted {
        let Some((code, said)) = checked(&text, 2) else { return };
        assert!(code == 1 && said.contains(what), "{what}: {said}");
    }
    let twice = text.replacen("\"waiting\": 0", "\"waiting\": 0, \"waiting\": 0", 1);
    let unknown = [
        (String::new(), "not a file of a tube"),
        (text[..text.len() / 2].to_owned(), "not a file of a tube"),
        (twice, "not a file of a tube"),
        (with("/sections/1", json!("###")), "not a file of a tube"),
        (section(1, 0, &|_| f64::NAN), "not finite"),
        (with("/kept/1", json!(4)), "kept"),
        (with("/reference", Value::Null), "does not know"),
    ];
    for (text, what) in unknown {
        let (code, said) = checked(&text, 2).unwrap();
        assert!(code == 2 && said.contains(what), "{what}: {said}");
    }
}
