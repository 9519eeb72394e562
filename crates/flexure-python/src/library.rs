//! What is registered, drafts from URDFs, and the paper's experiments: what `list`, `import` and `reproduce` of the command line do.

use std::collections::BTreeMap;
use std::path::PathBuf;

use flexure::check::Findings;
use flexure::files::{Unfinished, prepare};
use flexure::progress::Parts;
use flexure::prove::summary::ProofSummary;
use flexure::reproduce::{
    Certified, REPRODUCED, certificates, practical, reproduce as experiments, write_certificates,
    write_experiment, write_report,
};
use flexure::robot::{DriveClass, ImportOptions};
use flexure::scenario::Drafts;
use flexure::simulate::Summary;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::documents::document;
use crate::failure::{OF_JOBS, documents, raised, refused, unfinished, unwritten, warn};
use crate::robot::Robot;
use crate::scenario::{Scenario, outside};
use crate::watched::watched;

/// Built-in robots and scenarios, and the kinds that files choose from: a dict for each section, from names to a line on each.
#[pyfunction]
pub fn registered(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let found = PyDict::new(py);
    for (section, members) in flexure::registered::registered() {
        found.set_item(section, members.into_iter().collect::<BTreeMap<_, _>>())?;
    }
    Ok(found)
}

/// What is in a scenario, a robot, or the file of one, as `flexure check`: a dict.
#[pyfunction]
#[pyo3(signature = (given, *, allow_outside = false))]
pub fn check<'py>(
    py: Python<'py>,
    given: &Bound<'py, PyAny>,
    allow_outside: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let found = if let Ok(scenario) = given.cast::<Scenario>() {
        let loaded = scenario.get().loaded.clone();
        py.detach(|| Findings::of_scenario(&loaded))
    } else if let Ok(robot) = given.cast::<Robot>() {
        Findings::of_robot(&robot.get().loaded)
    } else {
        let path: PathBuf = given.extract()?;
        py.detach(|| Findings::of_file(&path.to_string_lossy(), outside(allow_outside)))
    };
    let findings = found.map_err(|problems| raised(py, &problems))?;
    let found = document(py, &findings)?;
    found.set_item("ok", findings.exceeded.is_empty())?;
    found.set_item("warnings", documents(py, findings.warnings.iter())?)?;
    found.set_item("errors", documents(py, findings.exceeded.iter())?)?;
    Ok(found)
}

/// A robot file, and with `scenario` a scenario to start with, from a URDF, as `flexure import`: a dict with the keys of its `--json`.
#[pyfunction]
#[pyo3(signature = (urdf, *, lock = Vec::new(), assume = None, unknown_limits = false, scenario = false, out = None, force = false))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub fn import_urdf<'py>(
    py: Python<'py>,
    urdf: PathBuf,
    lock: Vec<(String, f64)>,
    assume: Option<&str>,
    unknown_limits: bool,
    scenario: bool,
    out: Option<PathBuf>,
    force: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let assume = assume.map(DriveClass::named).transpose().map_err(|problem| refused(py, &problem))?;
    let options = ImportOptions { locks: &lock, assume, unknown_limits, file: None };
    // Without a place it stays a text.
    let out = out.or_else(|| scenario.then(|| PathBuf::from(".")));
    let drafts = Drafts::of(&urdf.to_string_lossy(), &options, scenario, out.as_deref())
        .map_err(|problems| raised(py, &problems))?;
    warn(py, &drafts.robot.warnings, OF_JOBS)?;
    warn(py, drafts.robot.still_missing().as_slice(), OF_JOBS)?;
    let files = drafts.write(force).map_err(unwritten)?;
    let found = PyDict::new(py);
    let joints: Vec<_> = drafts.robot.joints.iter().map(|joint| &joint.name).collect();
    found.set_item("joints", joints)?;
    found.set_item("toml", &drafts.robot.toml)?;
    found.set_item("missing", drafts.robot.missing.iter().cloned().collect::<BTreeMap<_, _>>())?;
    found.set_item("scenario", &drafts.scenario)?;
    found.set_item("files", files)?;
    Ok(found)
}

/// The paper's experiments, as `flexure reproduce`: traces, figures, certificates and report.html in the folder `out`; a dict with the
/// summaries of the runs, the certificates and how far the practical ones converge.
#[pyfunction]
#[pyo3(signature = (out, *, progress = None))]
pub fn reproduce<'py>(
    py: Python<'py>,
    out: PathBuf,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    prepare(&out).map_err(unwritten)?;
    let runs = watched(py, progress, |progress| {
        let parts = Parts::new(REPRODUCED.len());
        experiments(&out, &|part, fraction| progress(parts.with(part, fraction)))
    })?
    .map_err(|reason| unfinished(py, reason))?;
    let (runs, traces): (Vec<_>, Vec<_>) = runs.into_iter().unzip();
    if runs.iter().any(|experiment| experiment.run.broken_off.is_some()) {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    let certified = py.detach(certificates).map_err(|problems| raised(py, &problems))?;
    let practical = py.detach(|| practical(&runs)).map_err(|problems| raised(py, &problems))?;
    let write = || -> Result<PathBuf, Unfinished> {
        let mut written = runs.iter().zip(traces);
        written.try_for_each(|(experiment, trace)| write_experiment(experiment, trace).map(drop))?;
        write_certificates(&out, &certified)?;
        write_report(&out, &runs, &certified, &practical)
    };
    let report = py.detach(write).map_err(|reason| unfinished(py, reason))?;
    let summaries: Vec<&Summary> = runs.iter().map(|experiment| &experiment.run.summary).collect();
    let certificates: Vec<ProofSummary> = certified.iter().map(Certified::summary).collect();
    let found = PyDict::new(py);
    found.set_item("scenarios", document(py, &summaries)?)?;
    found.set_item("certificates", document(py, &certificates)?)?;
    found.set_item("practical", document(py, &practical)?)?;
    found.set_item("report", report)?;
    Ok(found)
}
