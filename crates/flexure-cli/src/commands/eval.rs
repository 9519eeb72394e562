//! `flexure eval`: the law at given states.

use std::path::Path;

use flexure::evaluate::evaluate_law;
use flexure::io::{load_scenario, load_states};

use super::print;
use crate::failure::{Failure, say};

pub fn eval(scenario: &str, states: &Path, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario(scenario)?;
    say(&scenario.warnings);
    let states = load_states(states, scenario.robot.joint_count())?;
    print::rows(&evaluate_law(&scenario, &states)?, json)
}
