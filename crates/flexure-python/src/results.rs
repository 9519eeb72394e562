//! What the command line does, as functions: results are dicts with the keys of `--json`.

use std::path::{Path, PathBuf};

use flexure::compare::{Search, Task, check_budget, check_seeds, entrants, tasks};
use flexure::design::{SpecFile, Specified};
use flexure::files::{Problem, Problems, Reading, read_text, write_atomic};
use flexure::identify::{RobotFile, Settings};
use flexure::logs::{Columns, read_log};
use flexure::prove::question::{Direct, Question, Region, prove_watched};
use flexure::prove::subject::differences;
use flexure::prove::summary::ProofSummary;
use flexure::report::write_certificate;
use flexure::sampled::probe;
use flexure::verify::Rejected;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::documents::document;
use crate::failure::{of, raised, warn};
use crate::scenario::{Scenario, outside};
use crate::watched::watched;

/// One number, or several.
#[derive(FromPyObject)]
pub enum OneOrMore {
    One(f64),
    More(Vec<f64>),
}

impl OneOrMore {
    fn list(self) -> Vec<f64> {
        match self {
            Self::One(x) => vec![x],
            Self::More(all) => all,
        }
    }
}

fn refused(py: Python<'_>, problem: &Problem) -> PyErr {
    of(py, &[problem])
}

/// Proves how fast the closed loop contracts, and where, as `flexure certify`: a dict with the keys of its `--json`, and `certificate`,
/// its text, or None if nothing was proved. Errors in rad, links then motors, torques in N m, rates in 1/s, speed in rad/s.
#[pyfunction]
#[pyo3(signature = (scenario, *, error_box = None, initial_error = None, rate = None, disturbance = None, direct = false, speed = 5.0,
                    budget = 1000, out = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub fn certify<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    error_box: Option<OneOrMore>,
    initial_error: Option<OneOrMore>,
    rate: Option<f64>,
    disturbance: Option<OneOrMore>,
    direct: bool,
    speed: f64,
    budget: usize,
    out: Option<PathBuf>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let region = match (error_box, initial_error) {
        (Some(_), Some(_)) => {
            return Err(pyo3::exceptions::PyTypeError::new_err("error_box or initial_error, not both"));
        }
        (Some(largest), None) => Region::Errors(largest.list()),
        (None, Some(start)) => Region::Start(start.list()),
        (None, None) => Region::Chosen,
    };
    let loaded = scenario.loaded.clone();
    let direct = direct.then_some(Direct { speed, budget });
    let question = Question { region, rate, disturbance: disturbance.map(OneOrMore::list), direct }
        .fitting(&loaded)
        .map_err(|problem| refused(py, &problem))?;
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
        write_certificate(out, certificate)
            .map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))?;
    }
    let text = certificate.map(serde_json::to_string_pretty).transpose();
    found.set_item(
        "certificate",
        text.map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?,
    )?;
    Ok(found)
}

/// Checks the claims of a certificate, its text or the path of its file, without what made it, as `flexure verify`: a dict. With `against`,
/// what it has differently from that scenario. Raises FlexureError for a claim that does not hold, and for what is no certificate.
#[pyfunction]
#[pyo3(signature = (certificate, *, against = None))]
pub fn verify<'py>(
    py: Python<'py>,
    certificate: PathBuf,
    against: Option<&Scenario>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = certificate.to_string_lossy().into_owned();
    let text = if given.trim_start().starts_with('{') {
        given
    } else {
        read_text(&certificate, flexure::verify::LARGEST).map_err(|problem| refused(py, &problem))?
    };
    let report = py.detach(|| flexure::verify::verify(&text)).map_err(|rejected| {
        crate::failure::FlexureError::new_err(match rejected {
            Rejected::False { claim, reason } => format!("{claim} does not hold: {reason}"),
            Rejected::Malformed { place, reason, .. } => format!("no certificate: {place}: {reason}"),
        })
    })?;
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

/// How much delay, torque gain, stiffness error and noise the loop bears, as `flexure margins`: a dict.
#[pyfunction]
#[pyo3(signature = (scenario, *, progress = None))]
pub fn margins<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let loaded = scenario.loaded.clone();
    let found = watched(py, progress, |progress| flexure::margins::margins(&loaded, progress))?
        .map_err(|problems| raised(py, &problems))?;
    if found.broken_off { Err(PyKeyboardInterrupt::new_err(())) } else { document(py, &found) }
}

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
    let inputs: Vec<&Path> =
        std::iter::once(Path::new(&*scenario.source.path_or_name)).chain(spec.as_deref()).collect();
    let prepared = || {
        let spec = spec.as_deref().map_or_else(|| Ok(SpecFile::usual()), SpecFile::load)?;
        let changes = scenario.source.parsed()?;
        let reading = Reading { outside: outside(scenario.source.allow_outside), changes: &changes };
        let specified = Specified::load(&scenario.source.path_or_name, reading, &spec)?;
        if let Some(out) = &out {
            flexure::design::spare_out(out, &inputs)?;
            specified.belongs(out, reading.outside)?;
        }
        Ok((spec, specified))
    };
    let (spec, specified) = prepared().map_err(|problems: Problems| raised(py, &problems))?;
    let found =
        watched(py, progress, |progress| flexure::design::design(&specified, &spec, budget, seed, progress))?
            .map_err(|problems| raised(py, &problems))?;
    if found.broken_off {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    let text = found.feasible.then(|| specified.with(&found.controller, &found.comment()));
    if let (Some(out), Some(text)) = (&out, &text) {
        write_atomic(out, |file| file.write_all(text.as_bytes()))
            .map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))?;
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
        let parts = flexure::progress::Parts::new(pairs);
        flexure::compare::compare(&tasks, &entrants, search, &|pair, fraction| {
            progress(parts.with(pair, fraction))
        })
    })?
    .map_err(|problems| raised(py, &problems))?;
    document(py, &found)
}

/// Stiffness, motor inertia, damping and friction of a robot's joints from logs, with error bars, as `flexure identify`: a dict with the
/// keys of its `--json`, and `toml`, the robot file with the numbers that the logs know, or None if they know none.
#[pyfunction]
#[pyo3(signature = (robot, logs, *, columns = None, motor_only = false, hold_out = 0.2, accuracy = 0.2, out = None, allow_outside = false,
                    progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub fn identify<'py>(
    py: Python<'py>,
    robot: PathBuf,
    logs: Vec<PathBuf>,
    columns: Option<String>,
    motor_only: bool,
    hold_out: f64,
    accuracy: f64,
    out: Option<PathBuf>,
    allow_outside: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut warnings = Vec::new();
    let mut prepared = || {
        let file = RobotFile::load(&robot.to_string_lossy(), outside(allow_outside))?;
        let columns = match &columns {
            None => Columns::default(),
            Some(said) => {
                let (columns, said) = Columns::read(said, &file.robot)?;
                warnings.extend(said);
                columns
            }
        };
        let mut read = Vec::new();
        for path in &logs {
            let (mut log, said) = read_log(path, &columns, &file.robot)?;
            warnings.extend(said);
            if motor_only {
                (log.q_l, log.dq_l) = (None, None);
            }
            read.push(log);
        }
        if let Some(out) = &out {
            file.fits(out, outside(allow_outside))?;
        }
        Ok((file, read))
    };
    let (file, read) = prepared().map_err(|problems: Problems| raised(py, &problems))?;
    warn(py, &file.robot.warnings)?;
    warn(py, &warnings)?;
    let settings = Settings { hold_out, accuracy, gaps: file.gaps.clone() };
    let found = watched(py, progress, |progress| {
        flexure::identify::identify(&file.robot, &read, &settings, progress)
    })?
    .map_err(|problems| raised(py, &problems))?;
    let names: Vec<_> = logs
        .iter()
        .map(|path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned())
        .collect();
    let place = out.clone().unwrap_or_else(|| robot.clone());
    let text = if found.knows_something() {
        let text = file.completed(&found, &names, &place, outside(allow_outside));
        Some(text.map_err(|problems| raised(py, &problems))?)
    } else {
        None
    };
    if let (Some(out), Some(text)) = (&out, &text) {
        write_atomic(out, |file| file.write_all(text.as_bytes()))
            .map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))?;
    }
    let answer = document(py, &found)?;
    answer.set_item("toml", text)?;
    Ok(answer)
}
