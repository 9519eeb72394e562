//! `flexure eval`: the law at given states.

use std::path::Path;

use flexure::eval::evaluate_law;
use flexure::files::{Reading, load_states};
use flexure::scenario::load_scenario_with;

use super::print;
use crate::failure::{Failure, say};

pub fn eval(scenario: &str, reading: Reading<'_>, states: &Path, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario_with(scenario, reading)?;
    say(&scenario.warnings);
    let states = load_states(states, scenario.robot.joint_count())?;
    print::rows(&evaluate_law(&scenario, &states)?, json)
}
