//! `simulate`: a scenario from beginning to end.

use flexure::feasible;
use flexure::files::Problems;
use flexure::sampled::probe;
use flexure::simulate::{Run, Trace, exceeded, preload, run, run_shaped, run_with};
use numpy::IntoPyArray as _;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::documents::document;
use crate::failure::{OF_JOBS, documents, raised, warn};
use crate::own_law::{Series, own_law, own_shaping};
use crate::scenario::Scenario;
use crate::watched::watched;

/// Simulates a scenario: a dict with the summary, the columns of the trace as arrays, their units, when it diverged (None if it did
/// not), whether the loop is stable as sampled, what speaks against it beside its errors, and what the guard kept of its stops.
#[pyfunction]
#[pyo3(signature = (scenario, *, law = None, shaping = None, progress = None))]
pub fn simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: Option<Py<PyAny>>,
    shaping: Option<Series>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let loaded = scenario.loaded.clone();
    let before = || {
        let beyond = feasible::exceeded(&loaded, &feasible::usage(&loaded)?);
        Ok((beyond, preload(&loaded)?.into_iter().chain(feasible::slowed(&loaded)?).collect::<Vec<_>>()))
    };
    let (beyond, doubts) = py.detach(before).map_err(|problems: Problems| raised(py, &problems))?;
    warn(py, &doubts, OF_JOBS)?;
    let shaping = own_shaping(shaping, law.is_some())?;
    let (law, of_law) = law.map(own_law).unzip();
    let found = watched(py, progress, |progress| match (law, shaping) {
        // What the sampled loop does is known of the scenario's own law.
        (None, None) => Ok((run(&loaded, progress)?, probe(&loaded)?)),
        (Some(law), _) => Ok((run_with(&loaded, law, progress)?, None)),
        (None, Some(shaping)) => Ok((run_shaped(&loaded, &shaping, progress)?, None)),
    })?;
    if let Some(error) = of_law.and_then(|of_law| of_law.take()) {
        return Err(error);
    }
    let (run, sampled) = found.map_err(|problems: Problems| raised(py, &problems))?;
    if run.broken_off.is_some() {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    if run.divergence.is_none() {
        warn(py, &exceeded(&loaded.robot, &run.trace), OF_JOBS)?;
    }
    let Run { summary, trace, divergence, faults, .. } = run;
    let unstable = sampled.as_ref().and_then(|sampled| sampled.problem(&loaded));
    let objections: Vec<_> = unstable.into_iter().chain(beyond).collect();
    warn(py, &objections.iter().map(|problem| problem.clone().warning()).collect::<Vec<_>>(), OF_JOBS)?;
    let (columns, units) = arrays(py, trace)?;
    let found = PyDict::new(py);
    found.set_item("summary", document(py, &summary)?)?;
    found.set_item("trace", columns)?;
    found.set_item("units", units)?;
    found.set_item("diverged_at", divergence.map(|divergence| divergence.time))?;
    found.set_item("divergence", divergence.map(|divergence| divergence.to_string()))?;
    found.set_item("sampled", document(py, &sampled)?)?;
    found.set_item("objections", documents(py, objections.iter())?)?;
    found.set_item("faults", document(py, &faults)?)?;
    Ok(found)
}

/// The columns of a trace, and their units, by name.
pub fn arrays(py: Python<'_>, trace: Trace) -> PyResult<(Bound<'_, PyDict>, Bound<'_, PyDict>)> {
    let (columns, units) = (PyDict::new(py), PyDict::new(py));
    for column in trace.into_columns() {
        units.set_item(&column.name, column.unit)?;
        columns.set_item(&column.name, column.values.into_pyarray(py))?;
    }
    Ok((columns, units))
}
