//! Robots and scenarios that need no files: their texts. One line adds one.

use std::path::Path;

use crate::files::diagnostic::Problem;
use crate::files::suggest;

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
    "two-link-tanh-sensors" "two-link-coupled-tanh-sensors"
    "two-link-hardware" "two-link-everything" "two-link-tanh-10khz"
    "pendulum-tanh" "panda-tanh-smooth" "planar-2r-tanh" "planar-3r-tanh" "tomei-3r-tanh" "tomei-3r-tanh-coupled" "tomei-3r-5kg-tanh");

/// Built-in scenarios that control laws are compared on: name and text of the file.
pub const TASKS: &[(&str, &str)] = data!("scenarios":
    "task-ideal-tracking" "task-hardware" "task-payload" "task-soft" "task-stiff"
    "task-delay-1ms" "task-delay-2ms" "task-delay-4ms" "task-encoder" "task-push" "task-friction" "task-panda");

/// Files that built-in robots are made from: name and text.
const FILES: &[(&str, &str)] = &[("panda.urdf", include_str!("../../../../robots/panda.urdf"))];

/// Text of the file that built-in robots know as `path`.
pub(crate) fn file(path: &str) -> Option<&'static str> {
    FILES.iter().find(|(known, _)| *known == path).map(|&(_, text)| text)
}

/// Whether `text` is a name: a bare word without ending or folder.
pub(crate) fn is_name(text: &str) -> bool {
    !text.contains(['/', '\\', '.'])
}

/// The text called `name` in `registry`, a list of built-in files of the kind `what`.
pub(crate) fn find(
    name: &str,
    registry: &[(&str, &'static str)],
    what: &str,
) -> Result<&'static str, Problem> {
    registry.iter().find(|(known, _)| *known == name).map(|&(_, text)| text).ok_or_else(|| {
        if let Some(problem) = of_other_kind(name) {
            return problem;
        }
        let message = format!("no built-in {what} is called {}", suggest::quoted(name));
        let help = if Path::new(name).exists() {
            format!("for the file or folder of that name write ./{name}")
        } else {
            let known = suggest::hint(name, registry.iter().map(|&(known, _)| known));
            format!("{known}; a path ends in .toml or begins with ./")
        };
        Problem::new("unknown-name", message, help)
    })
}

/// What to say of a `name` that is one of a robot where a scenario is expected, or the other way round.
fn of_other_kind(name: &str) -> Option<Problem> {
    let scenarios = || SCENARIOS.iter().chain(TASKS);
    let has = |text: &str, robot: &str| robot_of(text).is_some_and(|found| found == robot);
    if ROBOTS.iter().any(|(known, _)| *known == name) {
        let with: Vec<&str> =
            scenarios().filter(|(_, text)| has(text, name)).map(|(scenario, _)| *scenario).collect();
        let help = match with.as_slice() {
            [] => format!("no built-in scenario has it; in a file of yours: robot = \"{name}\""),
            with => format!(
                "built-in scenarios with it: {}; in a file of yours: robot = \"{name}\"",
                with.join(", ")
            ),
        };
        return Some(Problem::new("wrong-kind", format!("'{name}' is a robot, must be a scenario"), help));
    }
    let (_, text) = scenarios().find(|(known, _)| *known == name)?;
    let help = robot_of(text).map_or_else(String::new, |robot| format!("its robot is {robot}"));
    Some(Problem::new("wrong-kind", format!("'{name}' is a scenario, must be a robot"), help))
}

/// The robot that the text of a built-in scenario names.
fn robot_of(text: &str) -> Option<&str> {
    let line = text.lines().find_map(|line| line.strip_prefix("robot = \""))?;
    line.split('"').next()
}

#[cfg(test)]
mod tests {
    use super::{ROBOTS, SCENARIOS, TASKS, find, robot_of};

    #[test]
    fn robots_and_scenarios_are_told_apart() {
        for (name, text) in SCENARIOS.iter().chain(TASKS) {
            let robot = robot_of(text).expect("a robot");
            assert!(ROBOTS.iter().any(|(known, _)| *known == robot), "{name}: {robot}");
            let problem = find(robot, SCENARIOS, "scenario").expect_err("a robot");
            assert!(
                problem.code_word() == "wrong-kind" && problem.hint().contains(name),
                "{}",
                problem.hint()
            );
            let problem = find(name, ROBOTS, "robot").expect_err("a scenario");
            assert!(
                problem.code_word() == "wrong-kind" && problem.hint().ends_with(robot),
                "{}",
                problem.hint()
            );
        }
        assert_eq!(find("pand", ROBOTS, "robot").expect_err("neither").code_word(), "unknown-name");
    }
}
