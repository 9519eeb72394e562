//! Proofs, certificates and margins: what `certify`, `verify` and `margins` of the command line do. Results are dicts with the keys of
//! `--json`.

use std::path::{Path, PathBuf};

use flexure::files::{Problems, folder_of, prepare, read_text, spare};
use flexure::prove::documents::{Checked, FUNNEL, Kind, LARGEST, TUBE};
use flexure::prove::question::{Climb, Direct, Question, Region, prove_watched};
use flexure::prove::subject::differences;
use flexure::prove::summary::ProofSummary;
use flexure::prove::{robust, sampled_data};
use flexure::report::{write_certificate, write_document};
use flexure::sampled::probe;
use flexure::verify::Rejected;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;

use crate::arrays::Numbers;
use crate::documents::document;
use crate::failure::{raised, refused, said, unwritten};
use crate::scenario::Scenario;
use crate::watched::watched;

/// An argument of one number, or of several.
fn list(name: &'static str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<f64>>> {
    given.map(|given| Ok(Numbers::new(name, given)?.slice()?.to_vec())).transpose()
}

/// Proves how fast the closed loop contracts, and where, as `flexure certify`: a dict with the keys of its `--json`, and `certificate`,
/// its text, or None if nothing was proved. Errors in rad, links then motors, torques in N m, rates in 1/s. Whether a tube of the sampled loop is looked for
/// is `strongest`, True or False; if it is left out, it is where nothing else is asked for and that takes a minute or two.
#[pyfunction]
#[pyo3(signature = (scenario, *, error_box = None, initial_error = None, rate = None, disturbance = None, link_disturbance = None,
                    up_to_limits = false, slabs = None, velocity_error = None, sampled_tube = None, strongest = None,
                    direct = false, budget = 10_000, out = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub fn certify<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    error_box: Option<&Bound<'py, PyAny>>,
    initial_error: Option<&Bound<'py, PyAny>>,
    rate: Option<f64>,
    disturbance: Option<&Bound<'py, PyAny>>,
    link_disturbance: Option<&Bound<'py, PyAny>>,
    up_to_limits: bool,
    slabs: Option<usize>,
    velocity_error: Option<&Bound<'py, PyAny>>,
    sampled_tube: Option<&Bound<'py, PyAny>>,
    strongest: Option<bool>,
    direct: bool,
    budget: usize,
    out: Option<PathBuf>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let region = match (list("error_box", error_box)?, list("initial_error", initial_error)?) {
        (Some(_), Some(_)) => {
            return Err(PyTypeError::new_err("error_box or initial_error, not both"));
        }
        (Some(largest), None) => Region::Errors(largest),
        (None, Some(start)) => Region::Start(start),
        (None, None) => Region::Chosen,
    };
    if let Some(out) = &out {
        // Said before minutes of proof, not after.
        spare(out, "certificate", |text| text.contains("flexure-certificate"), &[])
            .map_err(|problem| refused(py, &problem))?;
        prepare(folder_of(out)).map_err(unwritten)?;
    }
    let loaded = scenario.loaded.clone();
    let direct = direct.then_some(Direct { budget });
    let [disturbance, link_disturbance] =
        [list("disturbance", disturbance)?, list("link_disturbance", link_disturbance)?];
    let velocity_error = list("velocity_error", velocity_error)?;
    if sampled_tube.is_some() && strongest == Some(true) {
        return Err(PyTypeError::new_err("sampled_tube or strongest, not both"));
    }
    let sampled_tube = list("sampled_tube", sampled_tube)?;
    let climb = match strongest {
        None => Climb::IfQuick,
        Some(true) => Climb::Always,
        Some(false) => Climb::Stay,
    };
    let question = Question {
        region,
        rate,
        disturbance,
        link_disturbance,
        up_to_limits,
        slabs,
        velocity_error,
        sampled_tube,
        climb,
        direct,
    };
    let question = question.fitting(&loaded).map_err(|problem| refused(py, &problem))?;
    if let Some(out) = out.as_ref().filter(|_| question.looks_for_tube(&loaded)) {
        TUBE.spare(&TUBE.beside(out)).map_err(|problem| refused(py, &problem))?;
    }
    if let Some(out) = out.as_ref().filter(|_| question.looks_for_funnel(&loaded)) {
        FUNNEL.spare(&FUNNEL.beside(out)).map_err(|problem| refused(py, &problem))?;
    }
    let found = watched(py, progress, |progress| {
        let proof = prove_watched(&loaded, &question, progress)?;
        let sampled = probe(&loaded)?;
        Ok((ProofSummary::new(&loaded, &proof, sampled), proof))
    })?;
    let (summary, proof) = found.map_err(|problems: Problems| raised(py, &problems))?;
    if proof.broken_off {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    let found = document(py, &summary)?;
    let certificate = proof.verdict.proved();
    if let (Some(out), Some(certificate)) = (&out, certificate) {
        write_certificate(out, certificate).map_err(unwritten)?;
    }
    if let Some(out) = &out {
        let loaded = &scenario.loaded;
        let tube = proof.sampled_tube.as_ref().and_then(|found| found.as_ref().ok());
        let funnel = proof.robust.as_ref().and_then(|found| found.as_ref().ok());
        let texts =
            [(TUBE, tube.map(|tube| tube.file(loaded))), (FUNNEL, funnel.map(|funnel| funnel.file(loaded)))];
        for (kind, text) in texts {
            let text = text.transpose().map_err(|problems| raised(py, &problems))?;
            text.map_or(Ok(()), |text| write_document(&kind.beside(out), &text)).map_err(unwritten)?;
        }
    }
    let text = certificate.map(serde_json::to_string_pretty).transpose();
    found.set_item("certificate", text.map_err(|error| PyRuntimeError::new_err(error.to_string()))?)?;
    Ok(found)
}

/// Checks the claims of a certificate, its text or the path of its file, without what made it, as `flexure verify`: a dict. With `against`,
/// what it has differently from that scenario. Of the path of a tube's file, which needs `against`, it follows every ellipsoid. Raises FlexureError for a claim that does not
/// hold, and for what is no such file.
#[pyfunction]
#[pyo3(signature = (certificate, *, against = None))]
pub fn verify<'py>(
    py: Python<'py>,
    certificate: PathBuf,
    against: Option<&Scenario>,
) -> PyResult<Bound<'py, PyDict>> {
    if let Some(kind) = [TUBE, FUNNEL].into_iter().find(|kind| kind.is_of(&certificate)) {
        return verify_beside(py, kind, &certificate, against);
    }
    let given = certificate.to_string_lossy().into_owned();
    let text = if given.trim_start().starts_with('{') {
        given
    } else {
        read_text(&certificate, flexure::verify::LARGEST).map_err(|problem| refused(py, &problem))?
    };
    let report =
        py.detach(|| flexure::verify::verify(&text)).map_err(|found| rejected(py, "certificate", found))?;
    let found = PyDict::new(py);
    found.set_item("name", report.name)?;
    found.set_item("contraction_rate", report.contraction_rate)?;
    found.set_item("convergence_rate", report.convergence_rate)?;
    found.set_item("claims", document(py, &report.claims)?)?;
    found.set_item("about", document(py, &report.about)?)?;
    found.set_item("assumptions", report.assumptions)?;
    if let Some(scenario) = against {
        let found_there = differences(&text, &scenario.loaded).map_err(|problems| raised(py, &problems))?;
        found.set_item("same", found_there.is_empty())?;
        found.set_item("differences", document(py, &found_there)?)?;
    }
    Ok(found)
}

/// That a file is no `what`, or that what it claims does not hold.
fn rejected(py: Python<'_>, what: &str, rejected: Rejected) -> PyErr {
    let message = match rejected {
        Rejected::False { claim, reason } => format!("{claim} does not hold: {reason}"),
        Rejected::Malformed { place, reason, .. } => format!("no {what}: {place}: {reason}"),
    };
    said(py, what, &message, "")
}

/// `verify` of a file of this `kind`.
fn verify_beside<'py>(
    py: Python<'py>,
    kind: Kind,
    path: &Path,
    against: Option<&Scenario>,
) -> PyResult<Bound<'py, PyDict>> {
    let Some(scenario) = against else {
        let message = format!("a {} is checked by following a loop: give its scenario as against", kind.name);
        return Err(PyTypeError::new_err(message));
    };
    let text = read_text(path, LARGEST).map_err(|problem| refused(py, &problem))?;
    let loaded = &scenario.loaded;
    if kind == FUNNEL {
        let checked = watched(py, None, |progress| robust::check::check(&text, loaded, progress))?;
        followed(py, kind, checked.map_err(|problems| raised(py, &problems))?)
    } else {
        let checked = watched(py, None, |progress| sampled_data::check::check(&text, loaded, progress))?;
        followed(py, kind, checked.map_err(|problems| raised(py, &problems))?)
    }
}

/// What came of following a file of this `kind`.
fn followed<T: Serialize>(py: Python<'_>, kind: Kind, checked: Checked<T>) -> PyResult<Bound<'_, PyDict>> {
    match checked {
        Checked::Holds(found) => {
            let found = document(py, &found)?.cast_into::<PyDict>()?;
            found.set_item("same", true)?;
            found.set_item("differences", PyList::empty(py))?;
            Ok(found)
        }
        Checked::Differs(differences) => {
            let found = PyDict::new(py);
            found.set_item("same", false)?;
            found.set_item("differences", document(py, &differences)?)?;
            Ok(found)
        }
        Checked::Rejected(found) => Err(rejected(py, kind.name, found)),
        Checked::BrokenOff => Err(PyKeyboardInterrupt::new_err(())),
    }
}

/// How much delay, torque gain, stiffness error and noise the loop bears, as `flexure margins`: a dict. With `sampled_tube`, a list of rad, also the delay up to which a tube of
/// the sampled loop is proved.
#[pyfunction]
#[pyo3(signature = (scenario, *, sampled_tube = None, progress = None))]
pub fn margins<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    sampled_tube: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let sampled_tube = list("sampled_tube", sampled_tube)?;
    let loaded = scenario.loaded.clone();
    let found = watched(py, progress, |progress| {
        sampled_tube.as_ref().map_or(Ok(()), |error| flexure::margins::check_tube(&loaded, error))?;
        let mut found = flexure::margins::margins(&loaded, progress)?;
        if let Some(error) = sampled_tube.as_ref().filter(|_| !found.broken_off) {
            found.prove_delay(&loaded, error, progress)?;
        }
        Ok(found)
    })?
    .map_err(|problems| raised(py, &problems))?;
    if found.broken_off { Err(PyKeyboardInterrupt::new_err(())) } else { document(py, &found) }
}
