//! `flexure model`: the robot model at given states.

use std::path::Path;

use flexure::evaluate::evaluate_model;
use flexure::io::load_robot;

use super::print;
use crate::failure::{Failure, warn};

pub fn model(robot: &str, states: &Path, json: bool) -> Result<(), Failure> {
    let robot = load_robot(robot)?;
    warn(&robot.warnings);
    let states = print::states(states, robot.joints())?;
    print::rows(&evaluate_model(&robot, &states)?, json)
}
