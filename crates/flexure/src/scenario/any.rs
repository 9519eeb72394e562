//! A file that may be a robot or a scenario.

use std::path::Path;

use toml::de::DeTable;

use crate::files::base::Base;
use crate::files::{Problems, ROBOTS, Reading, bounds, builtin, source};
use crate::robot::Robot;
use crate::robot::document as robot;
use crate::scenario::document as scenario;
use crate::scenario::{Scenario, load_scenario_with};

/// What a file turned out to be.
#[derive(Clone, Debug)]
pub enum Checked {
    /// A robot file.
    Robot(Box<Robot>),
    /// A scenario file, with its robot.
    Scenario(Box<Scenario>),
}

/// Loads the robot or scenario at a path, or the built-in one of that name: a file with the key `links` is a robot. It is read
/// once, so that it may be a pipe. `reading` says whether files may name files outside of their folders, and what is changed.
///
/// # Errors
/// With everything that is wrong.
pub fn check<'a>(path_or_name: &str, reading: impl Into<Reading<'a>>) -> Result<Checked, Problems> {
    let reading = reading.into();
    let Reading { outside, changes } = reading;
    if builtin::is_name(path_or_name) {
        let is_robot = ROBOTS.iter().any(|(name, _)| *name == path_or_name);
        return Ok(if is_robot {
            Checked::Robot(Box::new(crate::robot::robot(path_or_name, &Base::BuiltIn, changes)?))
        } else {
            Checked::Scenario(Box::new(load_scenario_with(path_or_name, reading)?))
        });
    }
    let path = Path::new(path_or_name);
    let (source, base) = (source::read(path, bounds::LIMIT)?, Base::of(path, outside));
    // What is too much for a document is refused by either reader.
    let is_robot = bounds::objection(&source.text).is_none()
        && DeTable::parse_recoverable(&source.text).0.get_ref().contains_key("links");
    Ok(if is_robot {
        Checked::Robot(Box::new(robot::read(&source, &base, changes)?))
    } else {
        Checked::Scenario(Box::new(scenario::read(&source, &base, changes)?))
    })
}
