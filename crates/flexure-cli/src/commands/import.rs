//! `flexure import`: a robot file, and a scenario, from a URDF.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use flexure::feasible;
use flexure::files::{Outside, Problem};
use flexure::robot::ImportOptions;
use flexure::scenario::{Drafts, load_scenario_with};
use serde::Serialize;

use super::print;
use crate::args::Import;
use crate::failure::{Failure, say};

/// The draft as a document.
#[derive(Serialize)]
struct Draft {
    joints: Vec<String>,
    toml: String,
    /// Keys of the numbers that are still to be supplied, for each joint that lacks some.
    missing: BTreeMap<String, Vec<&'static str>>,
    /// The scenario, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<String>,
    /// Files that were written.
    files: Vec<PathBuf>,
}

pub fn import(options: &Import, json: bool) -> Result<(), Failure> {
    let &Import { ref urdf, ref lock, assume, unknown_limits, scenario, .. } = options;
    let import = ImportOptions { locks: lock, assume, unknown_limits, file: None };
    let drafts = Drafts::of(urdf, &import, scenario, options.out.as_deref())?;
    say(&drafts.robot.warnings);
    say(drafts.robot.still_missing().as_ref());
    let files = drafts.write(options.force)?;
    if let Some(file) = drafts.scenario_file() {
        say(&doubts(&file));
    }
    let Drafts { robot, scenario, .. } = drafts;
    if json {
        let joints = robot.joints.into_iter().map(|joint| joint.name).collect();
        let missing = robot.missing.into_iter().collect();
        return print::json(&Draft { joints, toml: robot.toml, missing, scenario, files });
    }
    if files.is_empty() {
        return print::text(&robot.toml);
    }
    print::wrote(&files)
}

/// What is to be said of the scenario that was written at `path` before anybody runs it.
fn doubts(path: &Path) -> Vec<Problem> {
    let slowed = load_scenario_with(&path.to_string_lossy(), Outside::Allowed)
        .and_then(|scenario| feasible::slowed(&scenario));
    match slowed {
        Ok(problem) => problem.into_iter().collect(),
        Err(problems) => problems.iter().map(|problem| problem.clone().warning()).collect(),
    }
}
