//! Loading a scenario by name or path.

use std::path::Path;

use crate::files::base::Base;
use crate::files::bounds;
use crate::files::change::{Change, Numbers};
use crate::files::source::{self, Source};
use crate::files::{Bundle, Outside, Problem, Problems, Reading, SCENARIOS, TASKS, builtin, suggest};
use crate::robot;
use crate::scenario::document::{self, Scenario};

/// Loads the scenario file at a path, or the built-in scenario of that name.
///
/// A bare word without ending or folder is a name; anything else is a path. Files that a file names must lie in its folder
/// or below: see [`load_scenario_with`].
///
/// # Errors
/// With everything that is wrong, in the robot's file as well.
pub fn load_scenario(path_or_name: &str) -> Result<Scenario, Problems> {
    load_scenario_with(path_or_name, Outside::Refused)
}

/// As [`load_scenario`]; `reading` says whether files may name files outside of their folders, and what is changed.
///
/// # Errors
/// With everything that is wrong, in the robot's file as well.
pub fn load_scenario_with<'a>(
    path_or_name: &str,
    reading: impl Into<Reading<'a>>,
) -> Result<Scenario, Problems> {
    Ok(Scenario::bundled(path_or_name, reading)?.0)
}

/// The text of the scenario at a path or of that name, and what paths in it are relative to.
pub(crate) fn source(path_or_name: &str, outside: Outside) -> Result<(Source, Base), Problems> {
    if builtin::is_name(path_or_name) {
        let known = [SCENARIOS, TASKS].concat();
        let text = builtin::find(path_or_name, &known, "scenario")?;
        return Ok((Source::new(path_or_name, text), Base::BuiltIn));
    }
    let path = Path::new(path_or_name);
    Ok((source::read(path, bounds::LIMIT)?, Base::of(path, outside)))
}

/// The text of the scenario at a path, from `base` on, or of that name, and what paths in it are relative to.
pub(crate) fn source_at(path_or_name: &str, base: &Base) -> Result<(Source, Base), Problems> {
    if builtin::is_name(path_or_name) {
        return source(path_or_name, Outside::Refused);
    }
    Ok((base.read(path_or_name, bounds::LIMIT)?, base.beside(path_or_name)))
}

/// The numbers that stand at the key of `key` in the scenario of `bundle`, or in the file of its robot, there also those that its joints
/// have at that key by themselves, each with its key.
pub(crate) fn numbers(key: &Change, bundle: &Bundle) -> Result<Vec<(String, Numbers)>, Problems> {
    let (source, changes) = (&bundle.source, &bundle.changes);
    let own: Vec<Change> = changes.iter().filter(|change| !change.is_of_robot()).cloned().collect();
    let mut found = Vec::new();
    match key.of_robot() {
        None => found.extend(key.numbers(source, &own).map(|numbers| (key.key().to_owned(), numbers))),
        Some(of_file) => {
            let of_robot: Vec<Change> = changes.iter().filter_map(Change::of_robot).collect();
            let robot = Change::parse("robot = 0")?.said(source, &own);
            if let Some(robot) = robot.map(|robot| robot::source_at(&robot, &bundle.base())).transpose()? {
                let all = of_file.numbers(&robot, &of_robot);
                found.extend(all.map(|numbers| (key.key().to_owned(), numbers)));
                for own in key.of_each(&robot, &of_robot) {
                    let numbers = Change::parse(&format!("{own} = 0"))?
                        .of_robot()
                        .and_then(|own| own.numbers(&robot, &of_robot));
                    found.extend(numbers.map(|numbers| (own, numbers)));
                }
            }
        }
    }
    if found.is_empty() {
        let message =
            format!("{} is relative, and the file has no numbers there", suggest::quoted(key.key()));
        let hint = "give the key in the file, or in [set], or leave relative out";
        return Err(Problem::new("missing-number", message, hint).into());
    }
    Ok(found)
}

impl Scenario {
    /// Loads the scenario file at a path, or the built-in scenario of that name, as [`load_scenario`] does.
    ///
    /// # Errors
    /// With everything that is wrong, in the robot's file as well.
    pub fn load(path_or_name: &str) -> Result<Self, Problems> {
        load_scenario(path_or_name)
    }

    /// As [`load_scenario_with`], with everything that was read.
    ///
    /// # Errors
    /// With everything that is wrong, in the robot's file as well.
    pub fn bundled<'a>(
        path_or_name: &str,
        reading: impl Into<Reading<'a>>,
    ) -> Result<(Self, Bundle), Problems> {
        let Reading { outside, changes } = reading.into();
        let (source, base) = source(path_or_name, outside)?;
        let bundle = Bundle::new(source, base, changes);
        Ok((Self::of(&bundle)?, bundle))
    }

    /// The scenario of a bundle.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn of(bundle: &Bundle) -> Result<Self, Problems> {
        document::read(&bundle.source, &bundle.base(), &bundle.changes)
    }
}

#[cfg(test)]
mod tests {
    use super::{SCENARIOS, TASKS, load_scenario};

    #[test]
    fn every_scenario_loads() {
        for (name, _) in SCENARIOS.iter().chain(TASKS) {
            let scenario = load_scenario(name).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(scenario.name, *name);
        }
    }
}
