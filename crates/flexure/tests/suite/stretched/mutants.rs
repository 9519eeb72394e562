//! Every number of the claim moved to the unsafe side: neither checker accepts it.

use flexure::Scenario;
use flexure::verify::{Rejected, verify};
use serde_json::{Value, json};

use super::certified;
use crate::verify::python;

/// One joint, so that no number has room.
fn certificate() -> Value {
    let scenario = Scenario::load("pendulum-tanh").unwrap();
    serde_json::to_value(certified(&scenario, 2.0, 1.0)).unwrap()
}

fn with(certificate: &Value, path: &str, value: Value) -> String {
    let mut other = certificate.clone();
    *other.pointer_mut(path).unwrap() = value;
    other.to_string()
}

fn code(text: &str) -> i32 {
    match verify(text) {
        Ok(_) => 0,
        Err(Rejected::False { .. }) => 1,
        Err(Rejected::Malformed { .. }) => 2,
    }
}

#[test]
fn nothing_more_is_accepted_and_nothing_that_is_no_claim() {
    let certificate = certificate();
    let number = |path: &str| certificate.pointer(path).unwrap().as_str().unwrap().parse::<f64>().unwrap();
    let scaled =
        |path: &str, factor: f64| with(&certificate, path, json!((number(path) * factor).to_string()));
    let mut cases = vec![(certificate.to_string(), 0)];
    cases.push((scaled("/stretched/rate", 1.0 + 1e-6), 1));
    cases.push((scaled("/stretched/rate", 0.999), 0));
    for side in 0..2 {
        let [speed, exponent] = ["velocity_error", "exponent"].map(|key| format!("/stretched/{key}/{side}"));
        cases.push((scaled(&speed, 1.001), 1));
        cases.push((scaled(&speed, 0.9), 0));
        cases.push((scaled(&speed, -1.0), 1));
        cases.extend([0.8, 1.2].map(|factor| (scaled(&exponent, factor), 1)));
        cases.extend(["0", "1", "1.5", "-0.3"].map(|b| (with(&certificate, &exponent, json!(b)), 1)));
        cases.push((with(&certificate, &exponent, Value::Null), 1));
        cases.push((with(&certificate, &exponent, json!(0.3)), 2));
    }
    // What the claim rests on.
    for path in ["/controller/link/shaping/0", "/controller/motor/shaping/0", "/controller/link/damping/0"] {
        cases.push((scaled(path, 0.9), 1));
    }
    for path in ["/robot/stiffness/0", "/robot/motor_inertia/0"] {
        cases.push((scaled(path, 1.3), 1));
    }
    cases.push((with(&certificate, "/stretched/rate", json!("0")), 1));
    cases.push((with(&certificate, "/stretched/exponent", json!(["0.3"])), 2));
    cases.push((with(&certificate, "/stretched/velocity_error", json!(["1", "1", "1"])), 2));
    cases.push((with(&certificate, "/stretched", Value::Null), 0));
    cases.push((with(&certificate, "/version", json!(2)), 2));
    let (texts, wanted): (Vec<String>, Vec<i32>) = cases.into_iter().unzip();
    let found: Vec<i32> = texts.iter().map(|text| code(text)).collect();
    let wrong: Vec<_> = (0..texts.len()).filter(|&k| found[k] != wanted[k]).collect();
    assert!(
        wrong.is_empty(),
        "{:?}",
        wrong.iter().map(|&k| (k, found[k], wanted[k], verify(&texts[k]).err())).collect::<Vec<_>>()
    );
    assert!(python::codes(&texts).is_none_or(|codes| codes == wanted));
}
