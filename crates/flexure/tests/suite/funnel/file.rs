//! Files of funnels: what is written is accepted for its loop alone, and nothing that says more.

use std::path::Path;

use flexure::files::{Change, Reading};
use flexure::progress::unwatched;
use flexure::prove::documents::Checked;
use flexure::prove::question::Question;
use flexure::prove::robust::Robust;
use flexure::prove::robust::check::check;
use flexure::scenario::{Scenario, load_scenario_with, scenario_from_text};
use flexure::verify::Rejected;
use serde_json::{Value, json};

use crate::common::packed::{numbers, text_of};

/// What a funnel is asked for of a scenario with `changes`: torques on links and motors [N m], a part of the masses and one of springs.
pub struct Case {
    pub scenario: &'static str,
    pub changes: &'static [&'static str],
    pub torques: [f64; 2],
    pub mass: f64,
    pub spring: f64,
}

/// The arm with the gains of its hardware, under way within a second.
pub const SOFT: Case = Case {
    scenario: "two-link-hardware",
    changes: &["duration = 0.6", "reference.smooth_start.duration = 1.0"],
    torques: [0.01, 0.01],
    mass: 0.0,
    spring: 0.0,
};

/// The same with links that are up to 5 % heavier or lighter and springs 2 % stiffer or softer.
pub const OFF: Case = Case { torques: [0.002, 0.002], mass: 0.05, spring: 0.02, ..SOFT };

/// Three joints under gravity, one above the other.
pub const TREE: Case = Case {
    scenario: "planar-3r-tanh",
    changes: &["duration = 0.05", "reference.smooth_start.duration = 1.0"],
    torques: [1e-3, 1e-3],
    mass: 0.0,
    spring: 0.0,
};

impl Case {
    pub fn scenario(&self) -> Scenario {
        let changes: Vec<Change> =
            self.changes.iter().map(|change| Change::parse(change).expect("a change")).collect();
        let mut scenario = load_scenario_with(self.scenario, Reading::changed(&changes))
            .unwrap_or_else(|problems| panic!("{}: {problems}", self.scenario));
        let robot = &mut scenario.robot;
        robot.tolerances.link_mass.fill(self.mass);
        robot.tolerances.stiffness = robot.stiffness.iter().map(|k| k * self.spring).collect();
        scenario
    }

    pub fn funnel(&self, scenario: &Scenario) -> Robust {
        let [links, motors] = self.torques.map(|torque| Some(vec![torque; scenario.robot.joint_count()]));
        let question = Question { link_disturbance: links, disturbance: motors, ..Question::default() };
        let found = scenario.certify(&question).unwrap().robust.expect("asked for");
        found.unwrap_or_else(|none| panic!("{}: {}", self.scenario, none.at))
    }
}

/// The scenario and the file of a case.
pub fn written(case: &Case) -> (Scenario, Robust, String) {
    let scenario = case.scenario();
    let funnel = case.funnel(&scenario);
    let text = funnel.file(&scenario).expect("a law that funnels speak of");
    (scenario, funnel, text)
}

fn checked(text: &str, scenario: &Scenario) -> Checked<Robust> {
    check(text, scenario, &unwatched).expect("a loop that funnels speak of")
}

#[test]
fn what_is_written_is_accepted() {
    for case in [SOFT, OFF, TREE] {
        let (scenario, funnel, text) = written(&case);
        let Checked::Holds(again) = checked(&text, &scenario) else { panic!("{}: rejected", case.scenario) };
        // The same code on the same numbers.
        assert_eq!((again.rate, &again.error, &again.slabs), (funnel.rate, &funnel.error, &funnel.slabs));
        assert_eq!(again.torque.bound, funnel.torque.bound, "{}", case.scenario);
        assert_eq!(again.torque_rate.bound, funnel.torque_rate.bound, "{}", case.scenario);
        let mut other = scenario.clone();
        other.duration *= 2.0;
        let Checked::Differs(differences) = checked(&text, &other) else { panic!("another run") };
        assert_eq!(differences[0].place, "duration");
        let mut looser = scenario.clone();
        looser.robot.tolerances.stiffness.iter_mut().for_each(|k| *k += 0.01);
        let Checked::Differs(differences) = checked(&text, &looser) else { panic!("other robots") };
        assert_eq!(differences[0].place, "tolerances.stiffness[0]");
    }
}

/// A limit of how fast torques change is one like the others: kept where the bound is below it, named where it is above, and of another robot's file where it differs.
#[test]
fn rates_of_torques_have_limits() {
    let mut scenario = SOFT.scenario();
    let bound = SOFT.funnel(&scenario).torque_rate.bound;
    scenario.robot.limits.torque_rate = vec![1.001 * bound[0], 0.999 * bound[1]];
    let funnel = SOFT.funnel(&scenario);
    let of_rates: Vec<_> = funnel.limits.iter().filter(|limit| limit.key == "torque_rate_limit").collect();
    assert_eq!(of_rates.iter().map(|limit| limit.joint).collect::<Vec<_>>(), [0, 1]);
    assert!(of_rates[0].verdict.proved() == Some(&bound[0]) && of_rates[1].verdict.proved().is_none());
    assert!(!funnel.keeps_limits());
    let text = funnel.file(&scenario).expect("a law that funnels speak of");
    let Checked::Differs(differences) = checked(&text, &SOFT.scenario()) else { panic!("other limits") };
    assert_eq!(differences[0].place, "limits.torque_rate[0]");
    // Where the fourth derivative of the reference jumps, so do torques.
    let mut jumps = scenario_from_text("jumps.toml", JUMPS, Path::new("."))
        .unwrap_or_else(|problems| panic!("{problems}"));
    jumps.controller = SOFT.scenario().controller;
    let found = Case { torques: [1e-3, 1e-3], ..SOFT }.funnel(&jumps);
    assert!(found.torque_rate.bound.iter().all(|bound| bound.is_infinite()), "{:?}", found.torque_rate);
    let Checked::Holds(_) = checked(&found.file(&jumps).expect("a law"), &jumps) else {
        panic!("no bound is no claim")
    };
}

const JUMPS: &str = "robot = 'two-link-plausible'\nduration = 0.6\ncontrol_period = 0.002\ninitial = 'at rest'\n\
                     [reference]\nkind = 'septic'\nfrom = [0.0, 0.0]\nto = [0.05, 0.05]\nstart = 0.2\nduration = 1.0\n\
                     [controller]\nkind = 'vcbc'\n";

/// Claims by 1 % to the side that claims more, larger torques, and each kind of number of a slab by 1 %.
#[test]
fn nothing_that_says_more_is_accepted() {
    let (scenario, _, text) = written(&SOFT);
    let document: Value = serde_json::from_str(&text).unwrap();
    let times = |place: &str, factor: f64| {
        let mut other = document.clone();
        let there = other.pointer_mut(place).unwrap();
        *there = format!("{}", there.as_str().unwrap().parse::<f64>().unwrap() * factor).into();
        checked(&other.to_string(), &scenario)
    };
    let claims = [
        ("/claims/rate", 1.01),
        ("/claims/error/0", 0.99),
        ("/claims/error/3", 0.99),
        ("/claims/velocity_error/1", 0.99),
        ("/claims/velocity/0", 0.99),
        ("/claims/deflection/1", 0.99),
        ("/claims/torque/1", 0.99),
        ("/claims/torque_rate/0", 0.99),
        ("/claims/room", 1.02),
        ("/torques/links/0", 1.02),
        ("/torques/motors/1", 1.02),
    ];
    for (place, factor) in claims {
        let Checked::Rejected(Rejected::False { claim, .. }) = times(place, factor) else {
            panic!("{place}")
        };
        let of_slabs = place.starts_with("/torques") || place.ends_with("room");
        let named = if of_slabs { "slabs[" } else { claim.split('[').next().unwrap() };
        assert!(claim.starts_with(named) && (of_slabs || place.contains(named)), "{place}: {claim}");
    }
    // Of a slab under way: its times, and the diagonal of one of its ellipsoids. A few other numbers have room for 1 %.
    let k = 20;
    let all = numbers(&document["slabs"][k]);
    let instants = all.windows(2).position(|two| two[1] < two[0]).unwrap() + 1;
    let holds = |i: usize, factor: f64| {
        let mut moved = all.clone();
        moved[i] *= factor;
        let mut other = document.clone();
        other["slabs"][k] = text_of(&moved);
        match checked(&other.to_string(), &scenario) {
            Checked::Rejected(_) => false,
            Checked::Holds(_) => true,
            what => panic!("{i}: {what:?}"),
        }
    };
    for time in [0, instants - 1] {
        assert!(!holds(time, 1.01) && !holds(time, 0.99), "time {time}");
    }
    for row in 0..8 {
        let i = instants + 36 + row * (row + 3) / 2;
        assert!(!(holds(i, 1.01) && holds(i, 0.99)), "row {row}");
    }
}

/// What is no such file is not accepted, whatever is wrong with it, and told where.
#[test]
fn what_is_no_funnel_is_told_so() {
    let (scenario, _, text) = written(&SOFT);
    let document: Value = serde_json::from_str(&text).unwrap();
    let with = |place: &str, value: Value| {
        let mut other = document.clone();
        *other.pointer_mut(place).unwrap() = value;
        other.to_string()
    };
    let all = numbers(&document["slabs"][3]);
    let slab = |i: usize, x: f64| {
        let mut moved = all.clone();
        moved[i] = x;
        with("/slabs/3", text_of(&moved))
    };
    let mut more = document.clone();
    more["more"] = json!(1);
    let cases = [
        (String::new(), "the file"),
        (text[..text.len() / 2].to_owned(), "the file"),
        (text.replacen("\"version\": 2", "\"version\": 2, \"version\": 2", 1), "the file"),
        (more.to_string(), "the file"),
        (with("/claims", json!([])), "the file"),
        (with("/version", json!(1)), "format"),
        (with("/format", json!("flexure-certificate")), "format"),
        (with("/slabs", json!([])), "slabs"),
        (with("/slabs/3", json!("###")), "slabs[3]"),
        (with("/slabs/3", text_of(&all[1..])), "slabs[3]"),
        (with("/slabs/3", text_of(&all[..40])), "slabs[3]"),
        (slab(0, f64::NAN), "slabs[3]"),
        (slab(0, 1e9), "slabs[3]"),
        (slab(8, f64::INFINITY), "slabs[3]"),
        (slab(5, -1.0), "slabs[3]"),
        (with("/claims/rate", json!("+4")), "claims.rate"),
        (with("/claims/room", json!("0.5")), "claims.room"),
        (with("/claims/error", json!([])), "claims.error"),
        (with("/claims/torque/0", json!("inf")), "claims.torque"),
        (with("/claims/torque", json!(["1"])), "claims.torque"),
        (with("/torques/links/0", json!("-0.1")), "torques.links"),
        (with("/torques/links", json!(["0.1"])), "torques.links"),
        (with("/torques/motors/0", json!("many")), "torques.motors"),
        (with("/claims/rate", json!(4.0)), "the file"),
    ];
    for (text, expected) in cases {
        let shown = &text[..text.len().min(300)];
        match checked(&text, &scenario) {
            Checked::Rejected(Rejected::Malformed { place, .. }) => assert_eq!(place, expected, "{shown}"),
            what => panic!("{expected}: {what:?}"),
        }
    }
    for (place, key) in [("/robot", "extra"), ("/controller/link", "more"), ("/limits", "more")] {
        let mut other = document.clone();
        other.pointer_mut(place).unwrap()[key] = Value::Null;
        assert!(matches!(checked(&other.to_string(), &scenario), Checked::Differs(_)), "{place}");
    }
    // Slabs that are missing, at the beginning, within and at the end, or twice there.
    let slabs = document["slabs"].as_array().unwrap();
    let parts = [&slabs[1..], &slabs[..slabs.len() - 1], &[&slabs[..9], &slabs[10..]].concat()];
    let twice = [&slabs[..9], &slabs[8..]].concat();
    for part in parts.into_iter().chain([&twice[..]]) {
        let said = checked(&with("/slabs", part.to_vec().into()), &scenario);
        assert!(matches!(said, Checked::Rejected(Rejected::False { .. })), "{said:?}");
    }
}
