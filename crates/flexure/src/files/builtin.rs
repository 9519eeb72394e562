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
