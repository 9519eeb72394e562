//! A file that may be a robot or a scenario.

use crate::files::{Problems, ROBOTS, builtin, source};
use crate::robot::{Robot, load_robot};
use crate::scenario::{Scenario, load_scenario};

/// What a file turned out to be.
#[derive(Clone, Debug)]
pub enum Checked {
    /// A robot file.
    Robot(Box<Robot>),
    /// A scenario file, with its robot.
    Scenario(Box<Scenario>),
}

/// Loads the robot or scenario at a path, or the built-in one of that name: a file with the key `links` is a robot.
///
/// # Errors
/// With everything that is wrong.
pub fn check(path_or_name: &str) -> Result<Checked, Problems> {
    let is_robot = if builtin::is_name(path_or_name) {
        ROBOTS.iter().any(|(name, _)| *name == path_or_name)
    } else {
        let text = source::read(path_or_name.as_ref(), source::LIMIT)?.text;
        toml::de::DeTable::parse_recoverable(&text).0.get_ref().contains_key("links")
    };
    Ok(if is_robot {
        Checked::Robot(Box::new(load_robot(path_or_name)?))
    } else {
        Checked::Scenario(Box::new(load_scenario(path_or_name)?))
    })
}
