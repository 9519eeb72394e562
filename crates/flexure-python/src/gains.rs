//! Gains by search, and laws compared: what `tune` and `compare` of the command line do.

use std::path::{Path, PathBuf};

use flexure::compare::{Search, Task, check_budget, check_seeds, entrants, tasks};
use flexure::design::{SpecFile, Specified, design, spare_out};
use flexure::files::{Problems, folder_of, prepare, write_atomic};
use flexure::progress::Parts;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::documents::document;
use crate::failure::{raised, refused, unwritten};
use crate::scenario::{Scenario, outside};
use crate::watched::watched;

/// Finds gains, as `flexure tune`: a dict with the keys of its `--json`, and `toml`, the complete scenario, or None if no gains keep every
/// constraint. `spec` is the path of a SPEC file.
#[pyfunction]
#[pyo3(signature = (scenario, *, spec = None, budget = 40, seed = 0, out = None, progress = None))]
pub fn tune<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    spec: Option<PathBuf>,
    budget: usize,
    seed: u64,
    out: Option<PathBuf>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    check_budget(budget).map_err(|problem| refused(py, &problem))?;
    if let Some(out) = &out {
        prepare(folder_of(out)).map_err(unwritten)?;
    }
    let inputs: Vec<&Path> =
        std::iter::once(Path::new(&*scenario.source.name)).chain(spec.as_deref()).collect();
    let prepared = || {
        let spec = spec.as_deref().map_or_else(|| Ok(SpecFile::usual()), SpecFile::load)?;
        let specified = Specified::of(&scenario.loaded, &scenario.source.bundle, &spec)?;
        if let Some(out) = &out {
            spare_out(out, &inputs)?;
            specified.belongs(out, outside(scenario.source.allow_outside))?;
        }
        Ok((spec, specified))
    };
    let (spec, specified) = prepared().map_err(|problems: Problems| raised(py, &problems))?;
    let found = watched(py, progress, |progress| design(&specified, &spec, budget, seed, progress))?
        .map_err(|problems| raised(py, &problems))?;
    if found.broken_off {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    let text = found.feasible.then(|| specified.with(&found.controller, &found.comment()));
    if let (Some(out), Some(text)) = (&out, &text) {
        write_atomic(out, |file| file.write_all(text.as_bytes())).map_err(unwritten)?;
    }
    let answer = document(py, &found)?;
    answer.set_item("toml", text)?;
    Ok(answer)
}

/// Compares laws on tasks, each with gains from the same search, as `flexure compare`: a dict. Without scenarios the built-in tasks,
/// without controllers all laws.
#[pyfunction]
#[pyo3(signature = (scenarios = Vec::new(), *, controllers = Vec::new(), budget = 40, seed = 0, seeds = 5, progress = None))]
pub fn compare<'py>(
    py: Python<'py>,
    scenarios: Vec<PyRef<'py, Scenario>>,
    controllers: Vec<String>,
    budget: usize,
    seed: u64,
    seeds: usize,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let chosen = check_budget(budget).and_then(|()| check_seeds(seeds)).and_then(|()| entrants(&controllers));
    let entrants = chosen.map_err(|problem| refused(py, &problem))?;
    let tasks = if scenarios.is_empty() {
        tasks(&[], outside(false))
    } else {
        scenarios.iter().map(|scenario| Task::new(&scenario.loaded)).collect()
    };
    let tasks = tasks.map_err(|problems| raised(py, &problems))?;
    let pairs = tasks.len() * entrants.len();
    let search = Search { budget, seed, seeds };
    let found = watched(py, progress, |progress| {
        let parts = Parts::new(pairs);
        flexure::compare::compare(&tasks, &entrants, search, &|pair, fraction| {
            progress(parts.with(pair, fraction))
        })
    })?
    .map_err(|problems| raised(py, &problems))?;
    document(py, &found)
}
