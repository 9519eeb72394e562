//! The recipe of CONTRIBUTING.md: a kind that only tests know, its text in the guide and here the same.

use std::f64::consts::TAU;

use flexure_core::linalg::Vector;
use flexure_core::memory::{length, restore, save};

use crate::imperfections::stages::Tick;
use crate::imperfections::{CurrentLoop, Effects, Imperfection};
use crate::scenario::{load_scenario, scenario_from_text};

const GUIDE: &str = include_str!("../../../../CONTRIBUTING.md");

/// Control period \[s\].
const PERIOD: f64 = 1e-3;

#[test]
fn the_guide_shows_the_file_and_the_line() {
    let file = include_str!("current_loop.rs");
    assert!(GUIDE.contains(&format!("```rust\n{file}```")));
    let list = include_str!("mod.rs");
    let line = "    current_loop::CurrentLoop,\n";
    assert!(GUIDE.contains(&format!("```rust\n{line}```")) && list.contains(line));
}

#[test]
fn the_file_and_the_line_are_enough() {
    let text =
        crate::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-hardware").expect("built in");
    let entry = "[[imperfection]]\nkind = \"current-loop\"\ncutoff = [40.0, 50.0]\n";
    let read = |entry: &str| scenario_from_text("s", &format!("{}{entry}", text.1), ".".as_ref());
    let scenario = read(entry).expect("a kind with its keys");
    let plain = load_scenario("two-link-hardware").expect("built in");
    assert_eq!(scenario.imperfections.len(), plain.imperfections.len() + 1);
    assert!(scenario.imperfections.iter().any(|imperfection| imperfection.kind() == "current-loop"));
    for (bad, message) in
        [(entry.repeat(2), "a second current-loop"), (format!("{entry}slope = 1"), "'slope'")]
    {
        assert!(read(&bad).unwrap_err().to_string().contains(message));
    }
    // It acts in a run.
    let short = |mut scenario: crate::scenario::Scenario| {
        scenario.duration = 0.1;
        crate::simulate::measure(&scenario).expect("a robot of two joints").summary.rms_u_m.to_bits()
    };
    assert_ne!(short(scenario), short(plain));
}

/// A step is 1 − e^{−ωt} later, and goes on so after it was saved and restored. 1e-12: a hundred roundings.
#[test]
fn a_step_comes_with_a_lag() {
    let lag = [Imperfection::CurrentLoop(CurrentLoop { cutoff: vec![40.0] })];
    let mut drive = Effects::of(&lag, 1, PERIOD, 0).actuator;
    drive.start(&Vector([-1.0]));
    let mut saved = vec![0.0; length(&mut drive, 1)];
    let given = |drive: &mut crate::imperfections::stages::Actuator, k| {
        drive.actuate(&Tick::new(k, PERIOD), Vector([1.0])).last()[0]
    };
    for k in 0..100_u32 {
        save(&mut drive, 1, &mut saved).unwrap();
        let u = given(&mut drive, u64::from(k));
        let expected = 1.0 - 2.0 * (-TAU * 40.0 * PERIOD * f64::from(k + 1)).exp();
        assert!((u - expected).abs() < 1e-12, "{u} and {expected}");
        given(&mut drive, u64::from(k));
        restore(&mut drive, 1, &saved).unwrap();
        assert_eq!(given(&mut drive, u64::from(k)).to_bits(), u.to_bits());
    }
}
