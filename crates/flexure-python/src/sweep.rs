//! Sweeps: what `flexure sweep` does, in parts, so that any engine can put them together.

use std::path::PathBuf;

use flexure::files::{Change, Problems, Reading};
use flexure::sweep::{Column, Folder, Statistics, Sweep as Many, Values, part_name};
use numpy::IntoPyArray as _;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::changes::{changes, toml};
use crate::documents::document;
use crate::failure::{raised, refused, said, unfinished, warn};
use crate::scenario::{Scenario, outside};
use crate::watched::watched;

/// Many runs of a scenario whose numbers change, by their indices: each row is a function of its index alone.
#[pyclass(frozen, module = "flexure")]
pub struct Sweep {
    many: Many,
}

#[pymethods]
impl Sweep {
    #[new]
    #[pyo3(signature = (path, *, set = None, allow_outside = false))]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        set: Option<&Bound<'_, PyAny>>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        let set: Vec<Change> = changes(set)?
            .iter()
            .map(|change| Change::parse(change))
            .collect::<Result<_, _>>()
            .map_err(|problem| refused(py, &problem))?;
        let reading = Reading { outside: outside(allow_outside), changes: &set };
        let many = Many::load(&path.to_string_lossy(), reading).map_err(|problems| raised(py, &problems))?;
        warn(py, many.warnings(), 1)?;
        Ok(Self { many })
    }

    /// Of a scenario in hand: what stands in a sweep file, as arguments.
    #[staticmethod]
    #[pyo3(signature = (scenario, parameters, *, name = None, design = None, points = None, seed = None, seeds = None, metrics = None,
                        shard = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn of(
        py: Python<'_>,
        scenario: &Scenario,
        parameters: &Bound<'_, PyDict>,
        name: Option<&str>,
        design: Option<Bound<'_, PyAny>>,
        points: Option<Bound<'_, PyAny>>,
        seed: Option<Bound<'_, PyAny>>,
        seeds: Option<Bound<'_, PyAny>>,
        metrics: Option<Bound<'_, PyAny>>,
        shard: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let given = [
            ("design", design),
            ("points", points),
            ("seed", seed),
            ("seeds", seeds),
            ("metrics", metrics),
            ("shard", shard),
            ("parameters", Some(parameters.clone().into_any())),
        ];
        let mut text = String::new();
        for (key, value) in given {
            let Some(value) = value else { continue };
            text = text + key + " = " + &toml(key, &value)? + "\n";
        }
        let name = name.unwrap_or(&scenario.loaded.name);
        let many =
            Many::of(&scenario.source.bundle, name, &text).map_err(|problems| raised(py, &problems))?;
        warn(py, many.warnings(), 1)?;
        Ok(Self { many })
    }

    /// From what `document` gave, anywhere.
    #[staticmethod]
    fn from_document(py: Python<'_>, text: &str) -> PyResult<Self> {
        let many = Many::from_document(text).map_err(|problems| raised(py, &problems))?;
        Ok(Self { many })
    }

    /// All that is needed to go on with it anywhere: files too.
    fn document(&self) -> String {
        self.many.document()
    }

    /// Name of its file, without the ending.
    #[getter]
    fn name(&self) -> &str {
        self.many.name()
    }

    /// A hash of what it is: the same for files that differ in comments and spaces only.
    #[getter]
    fn identity(&self) -> &str {
        self.many.identity()
    }

    /// Runs in all.
    #[getter]
    fn rows(&self) -> u64 {
        self.many.rows()
    }

    /// Shards in all: the parts that are computed, written and repeated as a whole.
    #[getter]
    fn shards(&self) -> u64 {
        self.many.shards()
    }

    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.many.columns()
    }

    /// What changes: dicts with key, relative, unit (empty for none), and from, to, scale or values.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for parameter in self.many.parameters() {
            let entry = PyDict::new(py);
            entry.set_item("key", &parameter.key)?;
            entry.set_item("relative", parameter.relative)?;
            entry.set_item("unit", parameter.unit())?;
            match &parameter.values {
                Values::Between { from, to, logarithmic, points } => {
                    entry.set_item("from", from)?;
                    entry.set_item("to", to)?;
                    entry.set_item("scale", if *logarithmic { "log" } else { "linear" })?;
                    entry.set_item("points", points)?;
                }
                Values::Listed(values) => {
                    let values: Vec<_> = values.iter().map(|(value, _)| value).collect();
                    entry.set_item("values", document(py, &values)?)?;
                }
            }
            list.append(entry)?;
        }
        Ok(list)
    }

    /// What is kept of each run: dicts with name, unit and what.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for metric in self.many.metrics() {
            let entry = PyDict::new(py);
            entry.set_item("name", metric.name)?;
            entry.set_item("unit", metric.unit)?;
            entry.set_item("what", metric.what)?;
            list.append(entry)?;
        }
        Ok(list)
    }

    /// The file name of a shard.
    fn part_name(&self, shard: u64) -> PyResult<String> {
        self.shard_there(shard).map(|()| part_name(shard))
    }

    /// The scenario of a row.
    fn scenario(&self, py: Python<'_>, row: i64) -> PyResult<Scenario> {
        let row = counted(row)?;
        let scenario = self.many.bundle(row).map_err(Problems::from).and_then(Scenario::of);
        scenario.map_err(|problems| raised(py, &problems))
    }

    /// Computes a row: a dict with its index, seed, status, parameters and metrics; None for a metric that it does not have.
    fn row<'py>(&self, py: Python<'py>, row: i64) -> PyResult<Bound<'py, PyDict>> {
        let row = counted(row)?;
        self.many.bundle(row).map_err(|problem| refused(py, &problem))?;
        let outcome = watched(py, None, |_| self.many.row(row))?;
        let found = PyDict::new(py);
        found.set_item("row", outcome.row)?;
        found.set_item("seed", outcome.seed)?;
        found.set_item("status", outcome.status.name())?;
        for (parameter, value) in self.many.parameters().iter().zip(&outcome.values) {
            found.set_item(&parameter.key, document(py, value)?)?;
        }
        for (metric, value) in self.many.metrics().iter().zip(&outcome.metrics) {
            found.set_item(metric.name, value)?;
        }
        Ok(found)
    }

    /// The file of a shard as bytes: Parquet. On so many threads; on all cores without.
    #[pyo3(signature = (shard, *, threads = None, progress = None))]
    fn shard<'py>(
        &self,
        py: Python<'py>,
        shard: u64,
        threads: Option<usize>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        self.shard_there(shard)?;
        let pool = pool(threads)?;
        let bytes = watched(py, progress, |progress| pool.install(|| self.many.shard(shard, progress)))?;
        Ok(PyBytes::new(py, &bytes.map_err(|problems| raised(py, &problems))?))
    }

    /// Computes the shards of a folder that are not there, from `first` to before `end`: how many.
    #[pyo3(signature = (folder, first, end, *, threads = None, progress = None))]
    fn _complete(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        first: u64,
        end: u64,
        threads: Option<usize>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<u64> {
        let pool = pool(threads)?;
        let done = watched(py, progress, |progress| {
            let folder = Folder::of(&self.many, &folder)?;
            pool.install(|| folder.complete(&self.many, first..end, progress))
        })?;
        done.map_err(|reason| unfinished(py, reason))
    }

    /// What the rows of shards come to, of whose files only the ends are given, as bytes.
    fn _statistics<'py>(&self, py: Python<'py>, ends: Vec<(u64, Vec<u8>)>) -> PyResult<Bound<'py, PyAny>> {
        let mut statistics = Statistics::none(&self.many);
        for (shard, end) in &ends {
            let found = Statistics::of_end(&self.many, *shard, end).map_err(|error| {
                let message = format!("{}: {error}", part_name(*shard));
                said(py, "damaged", &message, "remove the file and run the sweep again: it is computed anew")
            })?;
            statistics.absorb(&found);
        }
        document(py, &statistics.told(&self.many))
    }

    /// Columns of the rows of shards, whose files are given as bytes, in their order.
    fn _table<'py>(
        &self,
        py: Python<'py>,
        files: Vec<(u64, Vec<u8>)>,
        names: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let columns = py.detach(|| self.many.columns_of(files, &names));
        let found = PyDict::new(py);
        for (name, column) in columns.map_err(|problems| raised(py, &problems))? {
            match column {
                Column::Whole(whole) => found.set_item(name, whole.into_pyarray(py))?,
                Column::Number(numbers) => found.set_item(name, numbers.into_pyarray(py))?,
                Column::Text(texts) => found.set_item(name, texts)?,
            }
        }
        Ok(found)
    }

    fn __repr__(&self) -> String {
        let keys: Vec<_> = self.many.parameters().iter().map(|parameter| parameter.key.as_str()).collect();
        format!("Sweep({}: {} runs, {})", self.many.name(), self.many.rows(), keys.join(", "))
    }

    fn __len__(&self) -> usize {
        usize::try_from(self.many.rows()).unwrap_or(usize::MAX)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().many.identity() == self.many.identity())
    }

    fn __hash__(&self) -> u64 {
        crate::scenario::hashed(self.many.identity())
    }

    /// It goes with its files.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_document")?, (slf.get().many.document(),)))
    }
}

/// A row as a number that may be one.
fn counted(row: i64) -> PyResult<u64> {
    u64::try_from(row).map_err(|_| PyIndexError::new_err(format!("row {row}: rows are counted from 0")))
}

/// Most threads.
const MOST_THREADS: usize = 1024;

/// Threads that work side by side: so many, or one for each core.
fn pool(threads: Option<usize>) -> PyResult<ThreadPool> {
    if let Some(threads) = threads.filter(|threads| !(1..=MOST_THREADS).contains(threads)) {
        return Err(PyValueError::new_err(format!("threads: {threads}; expected 1 to {MOST_THREADS}")));
    }
    let built = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    built.map_err(|error| PyValueError::new_err(format!("threads: {error}")))
}

impl Sweep {
    fn shard_there(&self, shard: u64) -> PyResult<()> {
        let shards = self.many.shards();
        if shard < shards {
            return Ok(());
        }
        Err(PyIndexError::new_err(format!("shard {shard}: there are {shards}, counted from 0")))
    }
}
