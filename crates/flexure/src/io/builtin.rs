//! Robots and scenarios that need no files, and loading by name or path. One line adds one.

use std::path::Path;

use super::base::Base;
use super::diagnostic::{Problem, Problems};
use super::robot::{self, Robot};
use super::scenario::{self, Scenario};
use super::source::{self, Source};
use super::suggest;

macro_rules! data {
    ($folder:literal: $($name:literal)*) => {
        &[$(($name, include_str!(concat!("../../../../", $folder, "/", $name, ".toml")))),*]
    };
}

/// Built-in robots: name and text of the file.
pub const ROBOTS: &[(&str, &str)] = data!("robots":
    "quanser-2dof" "quanser-2dof-cad" "two-link-plausible" "pendulum-1dof" "panda" "planar-2r" "planar-3r" "tomei-3r"
    "tomei-3r-5kg");

/// Built-in scenarios: name and text of the file.
pub const SCENARIOS: &[(&str, &str)] = data!("scenarios":
    "two-link-tanh" "two-link-linear" "two-link-coupled-tanh"
    "two-link-tanh-smooth" "two-link-linear-smooth" "two-link-coupled-tanh-smooth"
    "two-link-hardware" "two-link-everything" "two-link-tanh-10khz"
    "pendulum-tanh" "panda-tanh-smooth" "planar-2r-tanh" "planar-3r-tanh" "tomei-3r-tanh" "tomei-3r-tanh-coupled" "tomei-3r-5kg-tanh");

/// Built-in scenarios that control laws are compared on: name and text of the file.
pub const TASKS: &[(&str, &str)] = data!("scenarios":
    "task-ideal-tracking" "task-hardware" "task-payload" "task-soft" "task-stiff"
    "task-delay-1ms" "task-delay-2ms" "task-delay-4ms" "task-encoder" "task-push" "task-friction" "task-panda");

/// Files that built-in robots are made from: name and text.
const FILES: &[(&str, &str)] = &[("panda.urdf", include_str!("../../../../robots/panda.urdf"))];

/// Loads the robot file at a path, or the built-in robot of that name.
///
/// A bare word without ending or folder is a name; anything else is a path.
///
/// # Errors
/// With everything that is wrong.
pub fn load_robot(path_or_name: &str) -> Result<Robot, Problems> {
    robot(path_or_name, &Base::Folder("".into()))
}

/// Loads the scenario file at a path, or the built-in scenario of that name.
///
/// A bare word without ending or folder is a name; anything else is a path.
///
/// # Errors
/// With everything that is wrong, in the robot's file as well.
pub fn load_scenario(path_or_name: &str) -> Result<Scenario, Problems> {
    if is_name(path_or_name) {
        let known = [SCENARIOS, TASKS].concat();
        let text = find(path_or_name, &known, "scenario")?;
        return scenario::read(&Source::new(path_or_name, text), &Base::BuiltIn);
    }
    let path = Path::new(path_or_name);
    scenario::read(&source::read(path, source::LIMIT)?, &Base::of(path))
}

/// The robot at `path_or_name`, relative to `base`.
pub(super) fn robot(path_or_name: &str, base: &Base) -> Result<Robot, Problems> {
    if is_name(path_or_name) {
        let text = find(path_or_name, ROBOTS, "robot")?;
        return robot::read(&Source::new(path_or_name, text), &Base::BuiltIn);
    }
    robot::read(&base.read(path_or_name, source::LIMIT)?, &base.beside(path_or_name))
}

/// Text of the file that built-in robots know as `path`.
pub(super) fn file(path: &str) -> Option<&'static str> {
    FILES.iter().find(|(known, _)| *known == path).map(|&(_, text)| text)
}

pub(super) fn is_name(text: &str) -> bool {
    !text.contains(['/', '\\', '.'])
}

fn find(name: &str, registry: &[(&str, &'static str)], what: &str) -> Result<&'static str, Problem> {
    registry.iter().find(|(known, _)| *known == name).map(|&(_, text)| text).ok_or_else(|| {
        let message = format!("no built-in {what} is called {}", suggest::quoted(name));
        let help = suggest::hint(name, registry.iter().map(|&(known, _)| known));
        Problem::new("unknown-name", message, format!("{help}; a path ends in .toml or begins with ./"))
    })
}

#[cfg(test)]
mod tests {
    use super::{ROBOTS, SCENARIOS, TASKS, load_robot, load_scenario};

    #[test]
    fn every_member_loads() {
        for (name, _) in ROBOTS {
            let robot = load_robot(name).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(robot.name, *name);
        }
        for (name, _) in SCENARIOS.iter().chain(TASKS) {
            let scenario = load_scenario(name).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(scenario.name, *name);
        }
    }
}
