//! `flexure import`: a robot file, and a scenario, from a URDF.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use flexure::feasible;
use flexure::files::{Outside, Problem, create_folder, read_text, write_together};
use flexure::robot::{self, ImportOptions, MAX_JOINTS};
use flexure::scenario::{self, load_scenario_with};
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
    let places = Places::of(options);
    let file = places.as_ref().map(|places| places.urdf.as_str());
    let draft = robot::import(urdf, &ImportOptions { locks: lock, assume, unknown_limits, file })?;
    say(&draft.warnings);
    if let Some((name, _)) =
        lock.iter().enumerate().find_map(|(i, own)| lock[..i].iter().find(|earlier| earlier.0 == own.0))
    {
        let message = format!("joint {name:?} is locked twice");
        return Err(Failure::input("lock", message, "give each joint one position"));
    }
    let joints: Vec<_> = draft.joints.iter().map(|joint| joint.name.clone()).collect();
    if joints.len() > MAX_JOINTS {
        let message =
            format!("{} joints of {urdf} move; this program is built for at most {MAX_JOINTS}", joints.len());
        let hint = format!("hold some still, --lock JOINT=POSITION once for each: {}", joints.join(", "));
        return Err(Failure::input("joints", message, &hint));
    }
    say(draft.still_missing().as_ref());
    let mut texts = Vec::new();
    let scenario =
        scenario.then(|| scenario::draft(&draft, places.as_ref().map_or("", |places| &places.robot)));
    if let Some(places) = &places {
        texts.push((places.folder.join(&places.robot), draft.toml.as_str()));
        if let Some(scenario) = &scenario {
            texts.push((places.folder.join(&places.scenario), scenario.as_str()));
        }
        let copy = places.folder.join(&places.urdf);
        if places.copied && read_text(&copy, draft.urdf.len() as u64).ok().as_ref() != Some(&draft.urdf) {
            texts.push((copy, draft.urdf.as_str()));
        }
        create_folder(&places.folder)?;
        write_together(&texts, options.force)?;
    }
    if let (Some(places), Some(_), true) = (&places, &scenario, draft.missing.is_empty()) {
        say(&doubts(&places.folder.join(&places.scenario)));
    }
    let plain = |path: &Path| path.strip_prefix(".").unwrap_or(path).to_owned();
    let files: Vec<_> = texts.iter().map(|(path, _)| plain(path)).collect();
    if json {
        let missing = draft.missing.into_iter().collect();
        return print::json(&Draft { joints, toml: draft.toml, missing, scenario, files });
    }
    if files.is_empty() {
        return print::text(&draft.toml);
    }
    files.iter().try_for_each(|file| print::line(&format!("wrote {}", file.display())))
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

/// Where drafts go.
struct Places {
    folder: PathBuf,
    /// Names in the folder.
    robot: String,
    scenario: String,
    /// The URDF from the folder on.
    urdf: String,
    /// Whether it is to be copied there: files name only what lies in their folder or below.
    copied: bool,
}

impl Places {
    /// None for standard output.
    fn of(options: &Import) -> Option<Self> {
        let current = options.scenario.then(|| Path::new("."));
        let out = options.out.as_deref().or(current)?;
        let urdf = Path::new(&options.urdf);
        let is_file = out.extension().is_some_and(|ending| ending == "toml");
        let (folder, named) =
            if is_file { (out.parent().unwrap_or(Path::new("")), out) } else { (out, urdf) };
        let stem = named.file_stem().unwrap_or_default().to_string_lossy();
        let name = urdf.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let inside = folder.canonicalize().ok().zip(urdf.canonicalize().ok());
        let inside = inside.and_then(|(folder, urdf)| Some(urdf.strip_prefix(folder).ok()?.to_owned()));
        Some(Self {
            robot: format!("{stem}.toml"),
            scenario: format!("{stem}-scenario.toml"),
            copied: inside.is_none(),
            urdf: inside.map_or(name, |path| path.to_string_lossy().into_owned()),
            folder: folder.to_owned(),
        })
    }
}
