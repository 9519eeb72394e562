//! Loading a robot by name or path.

use crate::files::base::Base;
use crate::files::source::{self, Source};
use crate::files::{Problems, ROBOTS, builtin};
use crate::robot::document::{self, Robot};

/// Loads the robot file at a path, or the built-in robot of that name.
///
/// A bare word without ending or folder is a name; anything else is a path.
///
/// # Errors
/// With everything that is wrong.
pub fn load_robot(path_or_name: &str) -> Result<Robot, Problems> {
    robot(path_or_name, &Base::Folder("".into()))
}

impl Robot {
    /// Loads the robot file at a path, or the built-in robot of that name, as [`load_robot`] does.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn load(path_or_name: &str) -> Result<Self, Problems> {
        load_robot(path_or_name)
    }
}

/// The robot at `path_or_name`, relative to `base`.
pub(crate) fn robot(path_or_name: &str, base: &Base) -> Result<Robot, Problems> {
    if builtin::is_name(path_or_name) {
        let text = builtin::find(path_or_name, ROBOTS, "robot")?;
        return document::read(&Source::new(path_or_name, text), &Base::BuiltIn);
    }
    document::read(&base.read(path_or_name, source::LIMIT)?, &base.beside(path_or_name))
}

#[cfg(test)]
mod tests {
    use super::{ROBOTS, load_robot};

    #[test]
    fn every_robot_loads() {
        for (name, _) in ROBOTS {
            let robot = load_robot(name).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(robot.name, *name);
        }
    }
}
