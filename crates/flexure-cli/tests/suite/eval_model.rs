//! `flexure eval` and `flexure model`: numbers at states, against an independent implementation.

use serde_json::{Value, json};

use crate::command::Place;

/// Largest error, relative to the largest entry of the expected value.
const TOLERANCE: f64 = 1e-10;

/// The cases of the golden file that have the parameters of the built-in scenarios.
fn golden() -> Vec<Value> {
    let file: Value =
        serde_json::from_str(include_str!("../../../flexure/tests/golden/two_link.json")).unwrap();
    let default = [
        ("K", json!([9.0, 4.0])),
        ("M_m", json!([0.23, 0.01])),
        ("D_l", json!([0.8, 0.55])),
        ("D_m", json!([0.2, 90.0])),
        ("Lambda_l", json!([55.0, 30.0])),
        ("Lambda_m", json!([70.0, 60.0])),
        ("K_ld", json!([15.0, 10.0])),
        ("K_md", json!([10.0, 5.0])),
        ("kappa", json!([10.0, 8.0, 10.0, 8.0])),
    ];
    let cases = file["cases"].as_array().unwrap().iter();
    cases.filter(|case| default.iter().all(|(key, value)| case[key] == *value)).cloned().collect()
}

/// A states file of the samples, with `u_test` as motor torque.
fn states(samples: &[Value]) -> String {
    let line = |sample: &Value| {
        let keys = ["t", "q_l", "q_m", "dq_l", "dq_m"];
        let mut state: serde_json::Map<_, _> =
            keys.iter().map(|key| ((*key).to_owned(), sample[key].clone())).collect();
        state.insert("u_m".into(), sample["u_test"].clone());
        format!("{}\n", Value::Object(state))
    };
    samples.iter().map(line).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap_or_else(|| panic!("{number} is no number"))],
    }
}

#[track_caller]
fn assert_close(key: &str, got: &Value, expected: &Value) {
    let (got, expected) = (numbers(got), numbers(expected));
    assert_eq!(got.len(), expected.len(), "{key}");
    // Values that are all but zero are compared as such.
    let scale = expected.iter().fold(1e-5, |scale: f64, x| scale.max(x.abs()));
    for (g, e) in got.iter().zip(&expected) {
        assert!((g - e).abs() <= TOLERANCE * scale, "{key}: {got:?}, expected {expected:?}");
    }
}

fn lines(stdout: &str) -> Vec<Value> {
    stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn the_law_agrees_with_the_golden_file() {
    let place = Place::new();
    let cases = golden();
    assert_eq!(cases.len(), 3, "one for each shaping function");
    for case in &cases {
        let samples = case["samples"].as_array().unwrap();
        let scenario = format!("two-link-{}", case["phi"].as_str().unwrap());
        place.write("states.jsonl", states(samples));
        let rows = lines(&place.run(&["eval", &scenario, "--states", "states.jsonl"]).done().stdout);
        assert_eq!(rows.len(), samples.len());
        for (row, sample) in rows.iter().zip(samples) {
            assert_eq!(row["t"], sample["t"]);
            for key in ["u_m", "u_l", "q_md", "e_l", "e_m", "sigma_l", "sigma_m", "H"] {
                assert_close(key, &row[key], &sample["expect"][key]);
            }
        }
    }
}

#[test]
fn the_model_agrees_with_the_golden_file() {
    let place = Place::new();
    let case = &golden()[0];
    let samples = case["samples"].as_array().unwrap();
    place.write("states.jsonl", states(samples));
    let rows = lines(&place.run(&["model", "quanser-2dof", "--states", "states.jsonl"]).done().stdout);
    assert_eq!(rows.len(), samples.len());
    for (row, sample) in rows.iter().zip(samples) {
        let expected = &sample["expect"];
        for key in ["M_l", "E_l", "S_l", "dM_l", "H"] {
            assert_close(key, &row[key], &expected[key]);
        }
        assert_close("dx", &row["dx"], &expected["dx_with_u_test"]);
        assert_eq!((numbers(&row["bias"]).len(), numbers(&row["ddq_l"]).len()), (2, 2));
    }
}

#[test]
fn stdin_does_as_well_as_a_file_and_json_is_one_document() {
    let place = Place::new();
    let input = states(golden()[0]["samples"].as_array().unwrap());
    place.write("states.jsonl", &input);
    for command in [["eval", "two-link-tanh"], ["model", "quanser-2dof"]] {
        let with = |more: &[&'static str]| [&command[..], &["--states"], more].concat();
        let from_file = place.run(&with(&["states.jsonl"])).done();
        let from_stdin = place.fed(&with(&["-"]), &input).done();
        assert_eq!(from_file.stdout, from_stdin.stdout);
        assert_eq!(from_stdin.stderr, "");
        let document = place.fed(&with(&["-", "--json"]), &input).done().json();
        assert_eq!(document, Value::Array(lines(&from_file.stdout)));
    }
}

#[test]
fn without_a_torque_there_is_no_state_derivative() {
    let state = r#"{"q_l": [0, 0], "q_m": [0, 0], "dq_l": [0, 0], "dq_m": [0, 0]}"#;
    let place = Place::new();
    let row = place.fed(&["model", "quanser-2dof", "--states", "-"], state).done().json();
    assert!(row.get("dx").is_none() && row.get("M_l").is_some(), "{row}");
    let row = place.fed(&["eval", "two-link-tanh", "--states", "-"], state).done().json();
    assert_eq!(row["t"], 0.0, "the time is zero if none is given");
}

/// The acceleration that the springs give takes the torque that the springs give.
#[test]
fn the_torque_on_the_links_is_what_springs_and_damping_leave() {
    let place = Place::new();
    let mut state = json!({"q_l": [0.3, -0.8], "q_m": [0.5, -0.2], "dq_l": [1.5, -2.0], "dq_m": [0.0, 1.0]});
    let run = |state: &Value| {
        place.fed(&["model", "quanser-2dof", "--states", "-"], state.to_string()).done().json()
    };
    state["ddq_l"] = run(&state)["ddq_l"].clone();
    let row = run(&state);
    // K (q_m − q_l) − D_l q̇_l
    assert_close("tau_l", &row["tau_l"], &json!([9.0 * 0.2 - 0.8 * 1.5, 4.0 * 0.6 + 0.55 * 2.0]));
    assert!(row.get("dtau_l").is_none() && row.get("ddtau_l").is_none(), "not asked for: {row}");
}

/// Rates of the torque against differences of torques along a polynomial.
#[test]
fn torque_rates_are_rates_of_the_torque() {
    let derivatives = [[0.3, -0.8], [1.5, -2.0], [-3.0, 4.0], [5.0, 7.0], [11.0, -13.0]];
    let h = 1e-3;
    let line = |step: i32| {
        let t = h * f64::from(step);
        // Derivative k of the polynomial at t.
        let at = |k: usize| {
            [0, 1].map(|joint| {
                derivatives[k..]
                    .iter()
                    .enumerate()
                    .rev()
                    .fold(0.0, |sum, (i, x)| x[joint] + sum * t / (i + 1) as f64)
            })
        };
        let rest = [0.0; 2];
        let (q, v, a, jerk, snap) = (at(0), at(1), at(2), at(3), at(4));
        let state = json!({"t": t, "q_l": q, "q_m": rest, "dq_l": v, "dq_m": rest, "ddq_l": a, "d3q_l": jerk, "d4q_l": snap});
        format!("{state}\n")
    };
    let place = Place::new();
    let states: String = (-2..=2).map(line).collect();
    let rows = lines(&place.fed(&["model", "quanser-2dof", "--states", "-"], states).done().stdout);
    let torque: Vec<_> = rows.iter().map(|row| numbers(&row["tau_l"])).collect();
    let differences = |weights: [f64; 5], scale: f64| -> Vec<f64> {
        (0..2).map(|i| weights.iter().zip(&torque).map(|(w, tau)| w * tau[i]).sum::<f64>() / scale).collect()
    };
    for (key, expected, tolerance) in [
        ("dtau_l", differences([1.0, -8.0, 0.0, 8.0, -1.0], 12.0 * h), 1e-9),
        // Rounding of 1e-15 N m over h².
        ("ddtau_l", differences([-1.0, 16.0, -30.0, 16.0, -1.0], 12.0 * h * h), 1e-7),
    ] {
        for (g, e) in numbers(&rows[2][key]).iter().zip(&expected) {
            assert!((g - e).abs() <= tolerance * e.abs(), "{key}: {}, expected {expected:?}", rows[2]);
        }
    }
}

/// JSON has no word for a number that is not finite, and null would be taken for "not computed".
#[test]
fn a_result_that_is_not_finite_is_refused_at_its_state() {
    let place = Place::new();
    let good = r#"{"q_l": [0, 0], "q_m": [0, 0], "dq_l": [0, 0], "dq_m": [0, 0]}"#;
    let huge = r#"{"q_l": [0, 0], "q_m": [0, 0], "dq_l": [1e200, 0], "dq_m": [0, 0]}"#;
    for command in [["eval", "two-link-tanh"], ["model", "quanser-2dof"]] {
        let outcome = place.fed(&[&command[..], &["--states", "-"]].concat(), format!("{good}\n\n{huge}\n"));
        outcome.refused(&["standard input:3:1", "must be finite"]);
    }
    // Products of these in the rate of the torque, and nowhere else, are beyond 1e308.
    let huge = r#"{"q_l": [0, 1], "q_m": [0, 0], "dq_l": [1e150, 0], "dq_m": [0, 0], "ddq_l": [1e200, 0], "d3q_l": [0, 0]}"#;
    let outcome = place.fed(&["model", "quanser-2dof", "--states", "-"], format!("{good}\n{huge}\n"));
    outcome.refused(&["standard input:2:1", "dtau_l is", "must be finite"]);
}
