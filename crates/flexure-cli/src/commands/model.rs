//! `flexure model`: the robot model at given states.

use std::path::Path;

use flexure::eval::evaluate_model;
use flexure::files::{Outside, load_states};
use flexure::robot::load_robot_with;

use super::print;
use crate::failure::{Failure, say};

pub fn model(robot: &str, outside: Outside, states: &Path, json: bool) -> Result<(), Failure> {
    let robot = load_robot_with(robot, outside)?;
    say(&robot.warnings);
    let states = load_states(states, robot.joint_count())?;
    print::rows(&evaluate_model(&robot, &states)?, json)
}
