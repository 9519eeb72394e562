//! Whole loops with imperfections, estimators and guards, as scenario files describe them.

#![allow(clippy::float_cmp, reason = "flags are 0 or 1, files give decimals, and nothing is exactly nothing")]

mod effects;
mod estimators;
mod faults;
mod guards;
mod hardware;
mod identity;
mod limits;

use std::path::Path;

use flexure::scenario::load_scenario;
use flexure::scenario::{Scenario, scenario_from_text};
use flexure::simulate::Run;
use flexure::simulate::run;

/// A built-in scenario with tables added to its text, `duration` s long.
fn with(name: &str, duration: f64, more: &str) -> Scenario {
    let text = flexure::files::SCENARIOS.iter().find(|(known, _)| *known == name).expect("built in").1;
    let line = text.lines().find(|line| line.starts_with("duration = ")).expect("a duration");
    let text = format!("{}\n{more}\n", text.replacen(line, &format!("duration = {duration}"), 1));
    scenario_from_text(name, &text, Path::new(".")).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// The ideal loop on the plausible arm: 2 ms, the gains of its hardware scenario.
fn ideal(duration: f64) -> Scenario {
    let mut scenario = load_scenario("two-link-hardware").expect("built in");
    scenario.duration = duration;
    scenario.imperfections.clear();
    scenario.guard = None;
    scenario
}

/// `scenario` with these imperfections and no others.
fn with_these(mut scenario: Scenario, imperfections: Vec<flexure::imperfections::Imperfection>) -> Scenario {
    scenario.imperfections = imperfections;
    scenario
}

/// What comes of it.
fn simulate(scenario: &Scenario) -> Run {
    run(scenario, &flexure::progress::unwatched).expect("a robot of two joints")
}

/// Whether two runs have the same bits in every column that both have, and how many those are.
fn same_bits(a: &Run, b: &Run) -> usize {
    let mut common = 0;
    for column in a.trace.columns() {
        let Some(other) = b.trace.column(&column.name) else { continue };
        common += 1;
        assert_eq!(column.values.len(), other.len(), "{}", column.name);
        for (k, (x, y)) in column.values.iter().zip(other).enumerate() {
            assert_eq!(x.to_bits(), y.to_bits(), "{} differs at instant {k}: {x} and {y}", column.name);
        }
    }
    common
}
