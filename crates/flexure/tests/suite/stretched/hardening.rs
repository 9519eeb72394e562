//! A link metric that grows with the error, Π_l = Π + h q̃²: refused without a bound of velocity errors, certified with one.

use std::path::Path;

use flexure::Scenario;
use flexure::files::SCENARIOS;
use flexure::prove::engine::number::Number;
use flexure::prove::proposition::proposition;
use flexure::prove::question::Question;
use flexure::scenario::scenario_from_text;
use flexure::verify::{Rejected, verify};
use serde_json::{Value, json};

use super::full::{Loop, State};
use super::{certified, mass};
use crate::verify::python;

/// A scenario of the paper's arm whose link metric, (55, 30) N m/rad, doubles at an error of 1 rad.
fn hardening(name: &str) -> Scenario {
    let (_, text) = SCENARIOS.iter().find(|(known, _)| *known == name).unwrap();
    let text =
        text.replacen("damping = [15.0, 10.0]", "metric_hardening = [55.0, 30.0]\ndamping = [15.0, 10.0]", 1);
    let scenario = scenario_from_text("hardening.toml", &text, Path::new("."));
    let scenario = scenario.unwrap_or_else(|problems| panic!("{problems}"));
    assert!(scenario.vcbc().unwrap().link.hardens().is_some());
    scenario
}

/// 3/2 Λ − ½ √(Λ² + h/Π s²), at whatever error: and there is one at which it is no more.
#[test]
fn linear_shaping_has_the_rate_in_closed_form() {
    let scenario = hardening("two-link-linear-smooth");
    for speed in [0.0, 2.0, 10.0] {
        let certificate = certified(&scenario, 3.0, speed);
        let claim = certificate.stretched.as_ref().unwrap();
        let rate = claim.rate.approximate();
        let exact = 1.5 * 30.0 - 0.5 * f64::hypot(30.0, speed);
        assert!(certificate.contraction_rate.is_none() && claim.exponent.iter().all(Option::is_none));
        assert!(rate < exact && rate > exact * (1.0 - 1e-7), "{rate} {exact}");

        let of = Loop::of(&certificate);
        let slowest = |error: f64| {
            let state = State { error: vec![0.0, error, 0.0, 0.0], speed: vec![0.0, speed, 0.0, 0.0] };
            [-1.0, 1.0]
                .map(|cosine| of.rate(&[None; 4], &state, &mass(cosine)))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        let least = (0..3000).map(|k| slowest(0.001 * f64::from(k))).fold(f64::INFINITY, f64::min);
        assert!(
            least >= rate * (1.0 - 1e-9) && least < rate * (1.0 + 1e-5),
            "{rate} certified, {least} sampled"
        );
    }
}

/// The decay of V, in which ½ Π q̃² is ½ Π q̃² + h q̃⁴/12: at least at the certified convergence rate, at every error of the region.
#[test]
fn convergence_is_that_of_the_potential() {
    let scenario = hardening("two-link-tanh-smooth");
    let certificate = certified(&scenario, 3.0, 1.0);
    let rate = certificate.convergence_rate.approximate();
    for (gain, metric) in [(55.0, 55.0), (30.0, 30.0)] {
        for k in 1..300 {
            let x = 0.01 * f64::from(k);
            let [slope, potential] =
                [metric * (x + x.powi(3) / 3.0), metric * (0.5 * x.powi(2) + x.powi(4) / 12.0)];
            assert!(slope * gain * x.tanh() >= 2.0 * rate * potential);
        }
    }
}

#[test]
fn both_checkers_read_it_and_refuse_what_is_not_claimed() {
    let mut cases = Vec::new();
    for name in ["two-link-linear-smooth", "two-link-tanh-smooth"] {
        let scenario = hardening(name);
        assert!(
            proposition(&scenario, &Question::default(), None)
                .unwrap_err()
                .to_string()
                .contains("metric_hardening")
        );
        let certificate = certified(&scenario, 2.0, 1.0);
        let rate = certificate.stretched.as_ref().map(|claim| Number::approximate(&claim.rate));
        println!("{name}: {rate:?} 1/s");
        let certificate = serde_json::to_value(&certificate).unwrap();
        let with = |path: &str, value: Value| {
            let mut other = certificate.clone();
            *other.pointer_mut(path).unwrap() = value;
            other.to_string()
        };
        cases.push((certificate.to_string(), 0));
        cases.push((with("/controller/link/hardening/1", json!("60")), 1));
        cases.push((with("/controller/link/hardening/1", json!("-30")), 1));
        cases.push((with("/controller/link/hardening/1", json!("0")), 0));
        cases.push((with("/controller/link/hardening", Value::Null), 1));
        cases.push((with("/controller/motor/hardening", json!(["1", "1"])), 2));
        cases.push((with("/contraction_rate", json!("0.001")), 1));
        cases.push((with("/structure", json!([{"name": "ph-like", "holds": true, "witness": null}])), 1));
        cases.push((with("/stretched", Value::Null), 0));
        cases.push((with("/stretched/velocity_error/1", json!("30")), 1));
    }
    let (texts, wanted): (Vec<String>, Vec<i32>) = cases.into_iter().unzip();
    for (text, wanted) in texts.iter().zip(&wanted) {
        let found = verify(text);
        let code = match &found {
            Ok(_) => 0,
            Err(Rejected::False { .. }) => 1,
            Err(Rejected::Malformed { .. }) => 2,
        };
        assert_eq!(code, *wanted, "{found:?} {text}");
    }
    assert!(python::codes(&texts).is_none_or(|codes| codes == wanted));
}
