//! `simulate`: a scenario from beginning to end.

use flexure::simulate::{Run, Trace, exceeded, run};
use numpy::IntoPyArray as _;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::documents::document;
use crate::failure::{raised, warn};
use crate::scenario::Scenario;
use crate::watched::watched;

/// Simulates a scenario: a dict with the summary, the columns of the trace as arrays, their units, when it diverged (None if it did
/// not), and what the guard kept of its stops.
#[pyfunction]
#[pyo3(signature = (scenario, *, progress = None))]
pub fn simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let loaded = scenario.loaded.clone();
    let found = watched(py, progress, |progress| run(&loaded, progress))?;
    let Run { summary, trace, divergence, broken_off, faults } =
        found.map_err(|problems| raised(py, &problems))?;
    if broken_off.is_some() {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    if divergence.is_none() {
        warn(py, &exceeded(&loaded.robot, &trace))?;
    }
    let (columns, units) = arrays(py, trace)?;
    let found = PyDict::new(py);
    found.set_item("summary", document(py, &summary)?)?;
    found.set_item("trace", columns)?;
    found.set_item("units", units)?;
    found.set_item("diverged_at", divergence.map(|divergence| divergence.time))?;
    found.set_item("divergence", divergence.map(|divergence| divergence.to_string()))?;
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
