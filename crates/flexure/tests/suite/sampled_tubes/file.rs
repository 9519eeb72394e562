//! Files of tubes: what is written is accepted for its loop alone, and nothing that says more.

use flexure::progress::unwatched;
use flexure::prove::documents::Checked;
use flexure::prove::sampled_data::SampledTube;
use flexure::prove::sampled_data::check::check;
use flexure::scenario::Scenario;
use flexure::verify::Rejected;
use serde_json::{Value, json};

use crate::common::Random;
use crate::common::packed::{numbers, text_of};
use crate::sampled_tubes::readings::hardware;
use crate::sampled_tubes::{found, scenario, with_delay};

/// A few periods of the arm with the paper's gains.
const SHORT: [&str; 2] = ["duration = 0.008", "reference.smooth_start.duration = 0.1"];

pub fn file(scenario: &Scenario, error: f64) -> String {
    let tube = found(scenario, error).unwrap_or_else(|none| panic!("{}", none.at));
    tube.file(scenario).expect("a law that tubes speak of")
}

fn checked(text: &str, scenario: &Scenario) -> Checked<SampledTube> {
    check(text, scenario, &unwatched).expect("a loop that tubes speak of")
}

/// With and without a delay, a fraction of a period and more than one, on counts and a filter, of seven joints.
#[test]
fn what_is_written_is_accepted() {
    let late = |delay: f64| {
        let mut late = with_delay(delay);
        late.duration = 0.008;
        late
    };
    let mut reads = hardware(&[]);
    reads.duration = 0.02;
    let cases = [
        (scenario("two-link-tanh-smooth", &SHORT), 1e-5),
        (late(5e-4), 1e-5),
        (late(1e-3), 1e-6),
        (reads, 5e-4),
        (scenario("panda-tanh-smooth", &["duration = 0.003"]), 1e-6),
    ];
    for (scenario, error) in cases {
        let Ok(tube) = found(&scenario, error) else {
            // A whole period late is more than these gains bear.
            assert_eq!(scenario.imperfections.len(), 1);
            continue;
        };
        let text = tube.file(&scenario).unwrap();
        let Checked::Holds(again) = checked(&text, &scenario) else { panic!("{}: rejected", scenario.name) };
        assert_eq!((again.rate, &again.error, &again.torque), (tube.rate, &tube.error, &tube.torque));
        // c, L and their text: readings that are kept are counted, not written.
        let size = tube.sections[0].center.len();
        assert!(
            text.len() < tube.sections.len() * (11 * size * (size + 3) / 2 + 60) + 60_000,
            "{}",
            text.len()
        );
        let mut other = scenario.clone();
        other.control_period *= 1.001;
        let Checked::Differs(differences) = checked(&text, &other) else { panic!("another period") };
        assert_eq!(differences[0].place, "loop.control_period");
    }
}

/// Claims by 1 % to the side that claims more, and each kind of number of sections by 1 %.
#[test]
fn nothing_that_says_more_is_accepted() {
    // On its way, so that 1 % of where it is counts.
    let moving = ["initial.dq_l = [0.5, 0.5]", "initial.dq_m = [0.5, 0.5]"];
    let scenario = scenario("two-link-tanh-smooth", &[&SHORT[..], &moving].concat());
    let document: Value = serde_json::from_str(&file(&scenario, 1e-5)).unwrap();
    let claims = |place: &str| {
        let text = document.pointer(place).unwrap().as_str().unwrap();
        let mut other = document.clone();
        let factor = if place.ends_with("rate") { 1.01 } else { 0.99 };
        *other.pointer_mut(place).unwrap() = format!("{}", text.parse::<f64>().unwrap() * factor).into();
        checked(&other.to_string(), &scenario)
    };
    let places = [0, 1, 2, 3].map(|i| format!("/claims/error/{i}"));
    let places =
        places.iter().map(String::as_str).chain(["/claims/rate", "/claims/torque/0", "/claims/torque/1"]);
    for place in places {
        let Checked::Rejected(Rejected::False { claim, .. }) = claims(place) else { panic!("{place}") };
        assert!(place.replace('/', " ").contains(claim.split('[').next().unwrap()), "{place}: {claim}");
    }
    // Of a section in the middle: c, L and both to either side.
    let (k, size) = (4, 8);
    let mut accepted = Vec::new();
    let all = numbers(&document["sections"][k]);
    for i in 0..all.len() {
        for factor in [1.01, 0.99] {
            let mut moved = all.clone();
            moved[i] *= factor;
            let mut other = document.clone();
            other["sections"][k] = text_of(&moved);
            match checked(&other.to_string(), &scenario) {
                Checked::Rejected(Rejected::False { .. }) => {}
                Checked::Holds(tube) => accepted.push((i, factor, tube.rate)),
                what => panic!("{i}: {what:?}"),
            }
        }
    }
    println!("of {} accepted: {accepted:?}", 2 * all.len());
    // An entry of L that has room on both sides is still one of a tube, at the rate that is claimed: most have none, and the middle has not.
    let rate: f64 = document["claims"]["rate"].as_str().unwrap().parse().unwrap();
    assert!(accepted.iter().all(|&(i, _, found)| i >= size && found >= rate), "{accepted:?}");
    assert!(accepted.len() < all.len() / 2, "{accepted:?}");
}

/// What is no such file is not accepted, whatever is wrong with it, and told where.
#[test]
fn what_is_no_tube_is_told_so() {
    let scenario = scenario("two-link-tanh-smooth", &SHORT);
    let text = file(&scenario, 1e-5);
    let document: Value = serde_json::from_str(&text).unwrap();
    let with = |place: &str, value: Value| {
        let mut other = document.clone();
        *other.pointer_mut(place).unwrap() = value;
        other.to_string()
    };
    let all = numbers(&document["sections"][3]);
    let section = |i: usize, x: f64| {
        let mut moved = all.clone();
        moved[i] = x;
        with("/sections/3", text_of(&moved))
    };
    let mut more = document.clone();
    more["more"] = json!(1);
    let fewer = document["sections"].as_array().unwrap()[1..].to_vec();
    let cases = [
        (String::new(), "the file"),
        (text[..text.len() / 2].to_owned(), "the file"),
        (text.replacen("\"version\": 1", "\"version\": 1, \"version\": 1", 1), "the file"),
        (more.to_string(), "the file"),
        (with("/version", json!(2)), "format"),
        (with("/format", json!("flexure-certificate")), "format"),
        (with("/sections", fewer.into()), "sections"),
        (with("/sections/3", json!("###")), "sections[3]"),
        (with("/sections/3", text_of(&all[1..])), "sections[3]"),
        (with("/sections/3", text_of(&[&all[..], &all[..8]].concat())), "sections[3]"),
        (section(0, f64::NAN), "sections[3]"),
        (section(5, f64::INFINITY), "sections[3]"),
        (section(8, -1.0), "sections[3]"),
        (section(8, 0.0), "sections[3]"),
        (with("/kept/3", json!(4)), "kept"),
        (with("/kept", json!([])), "kept"),
        (with("/kept/3", json!(-4)), "the file"),
        (with("/asked/rate", json!("-1")), "asked"),
        (with("/asked/extents", json!(["1e-5"])), "claims"),
        (with("/asked/rate", json!(20.0)), "the file"),
        (with("/claims/rate", json!("+9")), "claims.rate"),
        (document.as_object().unwrap().values().cloned().collect::<Value>().to_string(), "the file"),
        (text.replacen("\"waiting\": 0", "\"waiting\": 3, \"waiting\": 0", 1), "the file"),
        (with("/claims/error", json!([])), "claims"),
        (with("/claims/rate", json!("fast")), "claims.rate"),
        (with("/claims/torque/0", json!("inf")), "claims.torque"),
    ];
    for (text, expected) in cases {
        let shown = &text[..text.len().min(300)];
        match checked(&text, &scenario) {
            Checked::Rejected(Rejected::Malformed { place, .. }) => assert_eq!(place, expected, "{shown}"),
            what => panic!("{expected}: {what:?}"),
        }
    }
    // Nothing is added to the loop or left out of it, not even what is null.
    for (place, key) in [("/loop", "friction"), ("/robot", "extra"), ("/controller/link", "more")] {
        let mut other = document.clone();
        other.pointer_mut(place).unwrap()[key] = Value::Null;
        assert!(matches!(checked(&other.to_string(), &scenario), Checked::Differs(_)), "{place}");
    }
    let mut other = document.clone();
    other["loop"].as_object_mut().unwrap().remove("filter");
    assert!(matches!(checked(&other.to_string(), &scenario), Checked::Differs(_)));
    let outside = with("/sections/0", {
        let mut first = numbers(&document["sections"][0]);
        first[0] += 1e-3;
        text_of(&first)
    });
    let Checked::Rejected(Rejected::False { reason, .. }) = checked(&outside, &scenario) else {
        panic!("outside")
    };
    assert!(reason.contains("the start of the run"), "{reason}");
    // What was asked for says where a search begins: it makes nothing true.
    let random = &mut Random(4);
    for _ in 0..4 {
        let [extent, rate] =
            [1e-5 * (1.0 + random.next()), 20.0 + 5.0 * random.next()].map(|x| x.to_string());
        let asked = json!({ "extents": [extent, "1e-5"], "rate": rate });
        let mut other: Value = serde_json::from_str(&with("/claims/rate", json!("19.76"))).unwrap();
        other["asked"] = asked;
        let said = checked(&other.to_string(), &scenario);
        assert!(matches!(said, Checked::Rejected(Rejected::False { .. })), "{said:?}");
    }
}
