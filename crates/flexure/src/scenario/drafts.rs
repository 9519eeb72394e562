//! A robot file, and a scenario, from a URDF: as texts, and as files.

use std::path::{Path, PathBuf};

use crate::files::{Problem, Problems, WriteError, create_folder, read_text, write_together};
use crate::robot::{self, ImportOptions, MAX_JOINTS};
use crate::scenario::draft;

/// What is made of a URDF.
#[derive(Clone, Debug)]
pub struct Drafts {
    /// The robot.
    pub robot: robot::Import,
    /// The scenario, if one was asked for.
    pub scenario: Option<String>,
    places: Option<Places>,
}

impl Drafts {
    /// Of the URDF at a path, with a scenario if `scenario`; for files at `out`: a folder, or the robot's file, PATH.toml. A scenario alone
    /// is for the current folder.
    ///
    /// # Errors
    /// If there is no such URDF, or it cannot be used.
    pub fn of(
        urdf: &str,
        options: &ImportOptions<'_>,
        scenario: bool,
        out: Option<&Path>,
    ) -> Result<Self, Problems> {
        let places = Places::of(urdf, scenario, out);
        let file = places.as_ref().map(|places| places.urdf.as_str());
        let robot = robot::import(urdf, &ImportOptions { file, ..*options })?;
        let lock = options.locks;
        let twice =
            lock.iter().enumerate().find(|(i, own)| lock[..*i].iter().any(|earlier| earlier.0 == own.0));
        if let Some((_, (name, _))) = twice {
            let message = format!("joint {name:?} is locked twice");
            return Err(Problem::new("lock", message, "give each joint one position").into());
        }
        if robot.joints.len() > MAX_JOINTS {
            let joints: Vec<_> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
            let count = joints.len();
            let message =
                format!("{count} joints of {urdf} move; this program is built for at most {MAX_JOINTS}");
            let hint = format!("hold some still, --lock JOINT=POSITION once for each: {}", joints.join(", "));
            return Err(Problem::new("joints", message, hint).into());
        }
        let scenario = scenario.then(|| draft(&robot, places.as_ref().map_or("", |places| &places.robot)));
        Ok(Self { robot, scenario, places })
    }

    /// Writes them, together or not at all, and the URDF beside them where they could not name it otherwise; files that exist are
    /// replaced if `force`. Returns the paths; none for drafts that have no place.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&self, force: bool) -> Result<Vec<PathBuf>, WriteError> {
        let Some(places) = &self.places else { return Ok(Vec::new()) };
        let mut texts = vec![(places.folder.join(&places.robot), self.robot.toml.as_str())];
        if let Some(scenario) = &self.scenario {
            texts.push((places.folder.join(&places.scenario), scenario.as_str()));
        }
        let copy = places.folder.join(&places.urdf);
        let urdf = &self.robot.urdf;
        if places.copied && read_text(&copy, urdf.len() as u64).ok().as_ref() != Some(urdf) {
            texts.push((copy, urdf.as_str()));
        }
        create_folder(&places.folder)?;
        write_together(&texts, force)?;
        let plain = |path: &Path| path.strip_prefix(".").unwrap_or(path).to_owned();
        Ok(texts.iter().map(|(path, _)| plain(path)).collect())
    }

    /// Where the scenario is written, if there is one that can be run: nothing is still to be supplied.
    pub fn scenario_file(&self) -> Option<PathBuf> {
        let places =
            self.places.as_ref().filter(|_| self.scenario.is_some() && self.robot.missing.is_empty())?;
        Some(places.folder.join(&places.scenario))
    }
}

/// Where drafts go.
#[derive(Clone, Debug)]
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
    fn of(urdf: &str, scenario: bool, out: Option<&Path>) -> Option<Self> {
        let out = out.or(scenario.then(|| Path::new(".")))?;
        let urdf = Path::new(urdf);
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
