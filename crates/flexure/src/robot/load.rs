//! Loading a robot by name or path.

use std::path::Path;

use crate::files::base::Base;
use crate::files::bounds;
use crate::files::change::Change;
use crate::files::source::{self, Source};
use crate::files::{Bundle, Outside, Problems, ROBOTS, builtin};
use crate::robot::document::{self, Robot};

/// Loads the robot file at a path, or the built-in robot of that name.
///
/// A bare word without ending or folder is a name; anything else is a path. Files that the file names must lie in its folder
/// or below: see [`load_robot_with`].
///
/// # Errors
/// With everything that is wrong.
pub fn load_robot(path_or_name: &str) -> Result<Robot, Problems> {
    load_robot_with(path_or_name, Outside::Refused)
}

/// As [`load_robot`]; `outside` says whether the file may name files outside of its folder.
///
/// # Errors
/// With everything that is wrong.
pub fn load_robot_with(path_or_name: &str, outside: Outside) -> Result<Robot, Problems> {
    Ok(Robot::bundled(path_or_name, outside)?.0)
}

impl Robot {
    /// Loads the robot file at a path, or the built-in robot of that name, as [`load_robot`] does.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn load(path_or_name: &str) -> Result<Self, Problems> {
        load_robot(path_or_name)
    }

    /// As [`load_robot_with`], with everything that was read.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn bundled(path_or_name: &str, outside: Outside) -> Result<(Self, Bundle), Problems> {
        let path = Path::new(path_or_name);
        let is_name = builtin::is_name(path_or_name);
        let base = if is_name { Base::BuiltIn } else { Base::of(path, outside) };
        let source =
            if is_name { source_at(path_or_name, &base)? } else { source::read(path, bounds::LIMIT)? };
        let bundle = Bundle::new(source, base, &[]);
        Ok((Self::of(&bundle)?, bundle))
    }

    /// The robot of a bundle.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn of(bundle: &Bundle) -> Result<Self, Problems> {
        document::read(&bundle.source, &bundle.base(), &bundle.changes)
    }
}

/// The robot at `path_or_name`, relative to `base`, its file changed by `changes`.
pub(crate) fn robot(path_or_name: &str, base: &Base, changes: &[Change]) -> Result<Robot, Problems> {
    let beside = if builtin::is_name(path_or_name) { Base::BuiltIn } else { base.beside(path_or_name) };
    document::read(&source_at(path_or_name, base)?, &beside, changes)
}

/// The text of its file.
pub(crate) fn source_at(path_or_name: &str, base: &Base) -> Result<Source, Problems> {
    if builtin::is_name(path_or_name) {
        return Ok(Source::new(path_or_name, builtin::find(path_or_name, ROBOTS, "robot")?));
    }
    Ok(base.read(path_or_name, bounds::LIMIT)?)
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
