//! Sweeps: many runs of a scenario whose numbers change from one to the next.
//!
//! A row, one run, is a function of its index alone: where its point lies, its seed and what comes of it depend on nothing that ran
//! before. So rows are computed in any order, by any number of threads, programs and machines, and any of them can be run again,
//! with its trace. Rows come in shards: a shard is computed, written, taken into account and repeated as a whole, as a Parquet file
//! that is there or not. What there is to do is what is not in the folder; nobody keeps books.

mod collocated;
mod design;
mod document;
mod folder;
mod metric;
mod outcome;
mod parameter;
mod parquet;
mod sobol;
mod statistics;
mod streams;

use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::files::base::Base;
use crate::files::change::Change;
use crate::files::document as toml;
use crate::files::normal::Normal;
use crate::files::source::{self, Source};
use crate::files::{Bundle, Outside, Problem, Problems, Reading, bounds, suggest};
use crate::imperfections::Imperfection;
use crate::progress::Progress;
use crate::robot::JointKind;
use crate::scenario::{self, Scenario};
use crate::simulate::SIDE_BY_SIDE;
use document::{FORM, IN_HAND, Said, Seeds};
use streams::Stream;

pub use collocated::Collocated;
pub use design::Kind;
pub use folder::{Folder, MANIFEST, part_name};
pub use metric::{METRICS, Metric};
pub use outcome::{Outcome, Status};
pub use parameter::{Parameter, Value, Values};
pub use parquet::{Column, Columns};
pub use statistics::{Figures, Spread, Statistics, Told};

/// Rows that are looked through for those that are alike, which run several to a SIMD register: enough to fill one where rows are of a
/// few kinds in turn.
const TOGETHER: usize = 4 * SIDE_BY_SIDE;

/// Many runs of a scenario, by their indices.
///
/// ```
/// let text = r#"
///     scenario = "pendulum-tanh"
///     design = "sobol"
///     points = 8
///     set.duration = 0.1
///     [parameters]
///     "robot.joints.stiffness" = { from = 0.5, to = 2.0, scale = "log", relative = true }
/// "#;
/// let sweep = flexure::sweep::Sweep::from_text("soft", text, std::path::Path::new("."))?;
/// assert_eq!(sweep.rows(), 8);
/// let row = sweep.row(5);
/// // One loop alone differs from one beside others by less than the integrator's tolerance.
/// let alone = sweep.run(5)?.summary.rms_e_l; // rad
/// assert!((row.metric(&sweep, "rms_e_l").expect("kept") - alone).abs() < 1e-7 * alone);
/// # Ok::<(), flexure::Problems>(())
/// ```
#[derive(Debug)]
pub struct Sweep {
    name: String,
    said: Said,
    /// The scenario, with what is the same for all rows; so many of its changes are its own.
    scenario: Bundle,
    own: usize,
    identity: String,
    /// What is suspicious in the scenario of the first row.
    warnings: Vec<Problem>,
    /// The file, and changes from outside.
    text: String,
    set: Vec<String>,
}

/// A sweep with everything that it needs, as it stands in its folder: enough to go on with it anywhere.
#[derive(Deserialize, Serialize)]
struct Manifest {
    /// Version of Flexure.
    flexure: String,
    /// What it is, hashed.
    identity: String,
    /// Name of the file, and the file.
    name: String,
    text: String,
    /// Changes from outside.
    set: Vec<String>,
    /// The scenario with the files that it names, as [`Bundle::document`] writes it.
    scenario: serde_json::Value,
    rows: u64,
    shard: u64,
    columns: Vec<String>,
}

impl Sweep {
    /// Loads the sweep file at a path; changes are made to its scenario, as those of its `[set]`, after them.
    ///
    /// # Errors
    /// With everything that is wrong, in the files that it names as well, and in what becomes of them at the ends of the parameters.
    pub fn load<'a>(path: &str, reading: impl Into<Reading<'a>>) -> Result<Self, Problems> {
        let Reading { outside, changes } = reading.into();
        let source = source::read(Path::new(path), bounds::LIMIT)?;
        let name = Path::new(path)
            .file_stem()
            .map_or_else(|| path.to_owned(), |stem| stem.to_string_lossy().into_owned());
        Self::read(&name, &source, &Base::of(Path::new(path), outside), changes)
    }

    /// Reads one from `text`, which is called `name`; paths in it start from `folder` and stay there or below.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn from_text(name: &str, text: &str, folder: &Path) -> Result<Self, Problems> {
        let base = Base::Folder(folder.to_owned(), Outside::Refused);
        Self::read(name, &Source::new(name, text), &base, &[])
    }

    fn read(name: &str, source: &Source, base: &Base, set: &[Change]) -> Result<Self, Problems> {
        let ((scenario, said), _) =
            toml::parse(source, &[], &FORM, |root, _| document::scenario(root).zip(document::said(root)))?;
        let (scenario, base) = scenario::source_at(&scenario, base)?;
        Self::assembled(name, source, said, &Bundle::new(scenario, base, &[]), set)
    }

    /// Of a scenario that was read before, with its changes. `text` is a sweep file that names none.
    ///
    /// # Errors
    /// As [`load`](Self::load), and `range` for a name that is none of a folder.
    pub fn of(scenario: &Bundle, name: &str, text: &str) -> Result<Self, Problems> {
        if name.is_empty() || name.starts_with('.') || name.contains(['/', '\\', '\0']) {
            let message = format!("{} is no name of a sweep", suggest::quoted(name));
            return Err(Problem::new(
                "range",
                message,
                "its rows lie in a folder of this name: soft-springs",
            )
            .into());
        }
        let source = Source::new(name, text);
        let (said, _) = toml::parse(&source, &[], &IN_HAND, |root, _| {
            if let Some(named) = root.get("scenario") {
                named.error("contradiction", "a scenario is named, and given", "leave the key out");
            }
            document::said(root)
        })?;
        Self::assembled(name, &source, said, scenario, &[])
    }

    /// From what [`document`](Self::document) wrote, anywhere.
    ///
    /// # Errors
    /// If it is no such document, or of another version of Flexure.
    pub fn from_document(text: &str) -> Result<Self, Problems> {
        let manifest: Manifest = serde_json::from_str(text).map_err(|error| {
            let message = format!("{MANIFEST} is no description of a sweep: {error}");
            Problem::new("syntax", message, "it is written by `flexure sweep`: name another folder")
        })?;
        let ours = env!("CARGO_PKG_VERSION");
        if manifest.flexure != ours {
            let message = format!("the sweep is of Flexure {}, and this is {ours}", manifest.flexure);
            let help = "numbers may differ between versions: go on with the other one, or begin again in another folder";
            return Err(Problem::new("version", message, help).into());
        }
        let source = Source::new(&manifest.name, &manifest.text);
        let set: Result<Vec<Change>, Problem> = manifest.set.iter().map(|set| Change::parse(set)).collect();
        let scenario = Bundle::from_document(&manifest.scenario.to_string())?;
        let (said, _) = toml::parse(&source, &[], &IN_HAND, |root, _| document::said(root))?;
        let sweep = Self::assembled(&manifest.name, &source, said, &scenario, &set?)?;
        if sweep.identity == manifest.identity {
            return Ok(sweep);
        }
        let message = format!("{MANIFEST} was changed: it is not the sweep that it was written for");
        Err(Problem::new("changed", message, "begin again in another folder").into())
    }

    fn assembled(
        name: &str,
        source: &Source,
        mut said: Said,
        scenario: &Bundle,
        set: &[Change],
    ) -> Result<Self, Problems> {
        for change in said.set.iter().chain(set) {
            refuse_overlap(change, &said.parameters)?;
        }
        let fixed = scenario.with(&said.set).with(set);
        for parameter in said.parameters.iter_mut().filter(|parameter| parameter.relative) {
            let key = Change::parse(&format!("{} = 0", parameter.key))?;
            parameter.base = scenario::numbers(&key, &fixed)?;
        }
        let mut sweep = Self {
            name: name.to_owned(),
            said,
            scenario: fixed,
            own: scenario.changes.len(),
            identity: String::new(),
            warnings: Vec::new(),
            text: source.of_file().to_owned(),
            set: set.iter().map(|change| change.text().to_owned()).collect(),
        };
        let looked_at = sweep.looked_at()?;
        sweep.warnings = looked_at.first().map(|scenario| scenario.warnings.clone()).unwrap_or_default();
        let draws = |scenario: &Scenario| scenario.imperfections.iter().any(Imperfection::draws);
        if sweep.said.seeds.count() > 1 && !looked_at.iter().any(draws) {
            let message = "nothing is random in these runs: every seed of a point gives the same";
            let hint = "leave seeds out, or add an [[imperfection]] that draws, as noise";
            sweep.warnings.push(Problem::new("same", message, hint).warning());
        }
        let digests = looked_at.iter().map(Scenario::digest).collect();
        sweep.identity = identity(source, &sweep.set, digests);
        // What no row near the ends of its parameters has read is read by none: rows do not depend on what becomes of files.
        sweep.scenario = sweep.scenario.closed();
        Ok(sweep)
    }

    /// Reads the scenario of the first row, and with each end of each parameter: what is wrong with them is wrong with the sweep.
    fn looked_at(&self) -> Result<Vec<Scenario>, Problems> {
        let first = self.said.design.point(0, &self.said.parameters);
        let mut points = vec![first.clone()];
        for (i, parameter) in self.said.parameters.iter().enumerate() {
            points.extend(parameter.ends().into_iter().map(|end| {
                let mut point = first.clone();
                point[i] = end;
                point
            }));
        }
        points.iter().map(|point| Scenario::of(&self.changed(point, 0)?)).collect()
    }

    /// Name of its file, without the ending.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What is suspicious in the scenario of its first row.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// What it is, hashed: the same for files that differ in comments and spaces only.
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// Everything that is needed to go on with it anywhere, as JSON.
    pub fn document(&self) -> String {
        let manifest = Manifest {
            flexure: env!("CARGO_PKG_VERSION").to_owned(),
            identity: self.identity.clone(),
            name: self.name.clone(),
            text: self.text.clone(),
            set: self.set.clone(),
            // Changes of [set] and from outside are made when it is read.
            scenario: serde_json::from_str(&self.scenario.with_first(self.own).document())
                .unwrap_or_default(),
            rows: self.rows(),
            shard: self.said.shard,
            columns: self.columns(),
        };
        serde_json::to_string_pretty(&manifest).unwrap_or_default()
    }

    /// What changes, in the order of the keys.
    pub fn parameters(&self) -> &[Parameter] {
        &self.said.parameters
    }

    /// What is kept of each run.
    pub fn metrics(&self) -> &[&'static Metric] {
        &self.said.metrics
    }

    /// Which joints of the robot turn, which slide; none if the first row is refused.
    pub(crate) fn kinds(&self) -> Vec<JointKind> {
        self.scenario(0).map_or_else(|_| Vec::new(), |scenario| scenario.robot.kinds())
    }

    /// How points are spread.
    pub fn design(&self) -> Kind {
        self.said.design.kind
    }

    /// Runs in all: points times seeds.
    pub fn rows(&self) -> u64 {
        self.said.design.points * self.said.seeds.count()
    }

    /// Shards in all.
    pub fn shards(&self) -> u64 {
        self.rows().div_ceil(self.said.shard)
    }

    /// The shard that a row is in.
    pub fn shard_of(&self, row: u64) -> u64 {
        row / self.said.shard
    }

    /// Rows of a shard.
    pub fn rows_of(&self, shard: u64) -> Range<u64> {
        shard * self.said.shard..((shard + 1) * self.said.shard).min(self.rows())
    }

    /// Names of the columns: row, seed, status, parameters, metrics.
    pub fn columns(&self) -> Vec<String> {
        let parameters = self.said.parameters.iter().map(|parameter| parameter.key.clone());
        let metrics = self.said.metrics.iter().map(|metric| metric.name.to_owned());
        ["row", "seed", "status"].map(str::to_owned).into_iter().chain(parameters).chain(metrics).collect()
    }

    /// Values of the parameters of a row.
    pub fn values(&self, row: u64) -> Vec<Value> {
        self.said.design.point(row / self.said.seeds.count(), &self.said.parameters)
    }

    /// Seed of a row: what is random in its run.
    pub fn seed(&self, row: u64) -> u64 {
        match &self.said.seeds {
            Seeds::Own(_) => Stream { seed: self.said.design.seed, purpose: "seed" }.bits(row, 0) >> 11,
            Seeds::Shared(seeds) => seeds[usize::try_from(row % seeds.len() as u64).unwrap_or(0)],
        }
    }

    /// The scenario of a row, with the files that it is made of.
    ///
    /// # Errors
    /// `range` if there is no such row.
    pub fn bundle(&self, row: u64) -> Result<Bundle, Problem> {
        if row >= self.rows() {
            let (name, rows) = (suggest::quoted(&self.name), self.rows());
            let message = format!("row {row}: {name} has {rows} rows, counted from 0");
            return Err(Problem::new("range", message, "name a row that is there"));
        }
        self.changed(&self.values(row), self.seed(row))
    }

    /// The scenario of a row.
    ///
    /// # Errors
    /// If its numbers do not go together, or there is no such row.
    pub fn scenario(&self, row: u64) -> Result<Scenario, Problems> {
        Scenario::of(&self.bundle(row)?)
    }

    fn changed(&self, values: &[Value], seed: u64) -> Result<Bundle, Problem> {
        let mut changes = Vec::with_capacity(values.len() + 1);
        for (parameter, value) in self.said.parameters.iter().zip(values) {
            changes.extend(parameter.changes(value)?);
        }
        changes.push(Change::parse_from("seeds", &format!("seed = {seed}"))?);
        Ok(self.scenario.with(&changes))
    }

    /// What comes of a row.
    pub fn row(&self, row: u64) -> Outcome {
        let found = Outcome::of(self, row..row + 1, &crate::progress::unwatched);
        let found = found.ok().and_then(|mut outcomes| outcomes.pop());
        found.unwrap_or_else(|| Outcome::refused(self, row))
    }

    /// The run of a row, with its trace.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario), and as [`Scenario::open`].
    pub fn run(&self, row: u64) -> Result<crate::simulate::Run, Problems> {
        self.scenario(row)?.simulate()
    }

    /// What comes of the rows of a shard, computed side by side. `progress` is told the fraction of them that is done.
    ///
    /// # Errors
    /// [`Problems::interrupted`] if it was broken off.
    pub fn outcomes(&self, shard: u64, progress: Progress<'_>) -> Result<Vec<Outcome>, Problems> {
        let rows = self.rows_of(shard);
        let (count, done) = ((rows.end - rows.start) as f64, AtomicU64::new(0));
        let fraction = || done.load(Ordering::Relaxed) as f64 / count;
        let part = |from| {
            let part = from..rows.end.min(from + TOGETHER as u64);
            let outcomes = Outcome::of(self, part.clone(), &|_| progress(fraction()))?;
            done.fetch_add(part.end - part.start, Ordering::Relaxed);
            Ok(outcomes)
        };
        let starts: Vec<u64> = rows.clone().step_by(TOGETHER).collect();
        let outcomes: Result<Vec<_>, Problems> = starts.into_par_iter().with_max_len(1).map(part).collect();
        Ok(outcomes?.into_iter().flatten().collect())
    }

    /// The file of a shard: Parquet, with the statistics of its rows.
    ///
    /// # Errors
    /// [`Problems::interrupted`] if it was broken off.
    pub fn shard(&self, shard: u64, progress: Progress<'_>) -> Result<Vec<u8>, Problems> {
        let outcomes = self.outcomes(shard, progress)?;
        parquet::written(self, &outcomes)
    }

    /// Columns of the rows in `files`, the shards by their numbers, by the names of the columns, in the order of the files.
    ///
    /// # Errors
    /// If there is no such column, or a file is damaged or another one.
    pub fn columns_of(&self, files: Vec<(u64, Vec<u8>)>, names: &[String]) -> Result<Columns, Problems> {
        let mut columns = parquet::empty(self, names)?;
        for (shard, file) in files {
            parquet::read(self, shard, file, &mut columns).map_err(|error| {
                let message = format!("{}: {error}", part_name(shard));
                Problem::new(
                    "damaged",
                    message,
                    "remove the file and run the sweep again: it is computed anew",
                )
            })?;
        }
        Ok(columns)
    }
}

/// That what is the same for all rows is neither a parameter nor the seed.
fn refuse_overlap(change: &Change, parameters: &[Parameter]) -> Result<(), Problem> {
    let key = change.key();
    if key == "seed" {
        let message = "seed is set, and every row has one of its own".to_owned();
        return Err(Problem::new(
            "contradiction",
            message,
            "seeds = 10, or seeds = [1, 2, 3], in the sweep file",
        ));
    }
    if parameters.iter().any(|parameter| parameter.key == key) {
        let message = format!("{} is set, and a parameter", suggest::quoted(key));
        return Err(Problem::new("contradiction", message, "leave one of them out"));
    }
    Ok(())
}

/// A hash of what a sweep is: its file, what was changed from outside, what the scenarios at its ends say, the version.
fn identity(source: &Source, set: &[String], digests: Vec<String>) -> String {
    let mut file = Normal::Text(String::new());
    // It was read before.
    let _ = toml::parse(source, &[], &IN_HAND, |root, _| {
        file = root.normal().without(&["scenario"]);
        Some(())
    });
    let texts = |texts: Vec<String>| Normal::List(texts.into_iter().map(Normal::Text).collect());
    let version = Normal::Text(env!("CARGO_PKG_VERSION").to_owned());
    Normal::List(vec![version, file, texts(set.to_vec()), texts(digests)]).digest()
}
