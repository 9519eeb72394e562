//! Logs: what `excite`, `identify` and `replay` of the command line do.

use std::path::PathBuf;

use flexure::excite::{Settings as Motion, excite as designed, spare_out};
use flexure::files::{Problem, Problems, folder_of, prepare, write_atomic};
use flexure::identify::{RobotFile, Settings};
use flexure::logs::{Columns, Log, read_log};
use flexure::robot::Robot;
use pyo3::prelude::*;

use crate::documents::document;
use crate::failure::{OF_JOBS, documents, raised, refused, unwritten, warn};
use crate::run::arrays;
use crate::scenario::{Scenario, outside};
use crate::watched::watched;

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
    if let Some(out) = &out {
        prepare(folder_of(out)).map_err(unwritten)?;
    }
    let mut warnings = Vec::new();
    let mut prepared = || {
        let file = RobotFile::load(&robot.to_string_lossy(), outside(allow_outside))?;
        let read = read(&logs, columns.as_deref(), motor_only, &file.robot, &mut warnings)?;
        if let Some(out) = &out {
            file.fits(out, outside(allow_outside))?;
        }
        Ok((file, read))
    };
    let (file, read) = prepared().map_err(|problems: Problems| raised(py, &problems))?;
    warn(py, &file.robot.warnings, OF_JOBS)?;
    warn(py, &warnings, OF_JOBS)?;
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
        write_atomic(out, |file| file.write_all(text.as_bytes())).map_err(unwritten)?;
    }
    let answer = document(py, &found)?;
    answer.set_item("toml", text)?;
    Ok(answer)
}

/// Reads logs of `robot`, whose columns are as `said`.
fn read(
    paths: &[PathBuf],
    said: Option<&str>,
    motor_only: bool,
    robot: &Robot,
    warnings: &mut Vec<Problem>,
) -> Result<Vec<Log>, Problems> {
    let columns = match said {
        None => Columns::default(),
        Some(said) => {
            let (columns, doubtful) = Columns::read(said, robot)?;
            warnings.extend(doubtful);
            columns
        }
    };
    let mut logs = Vec::new();
    for path in paths {
        let (mut log, doubtful) = read_log(path, &columns, robot)?;
        warnings.extend(doubtful);
        if motor_only {
            (log.q_l, log.dq_l) = (None, None);
        }
        logs.push(log);
    }
    Ok(logs)
}

/// Designs the motion that tells most about a robot's joints, as `flexure excite`: a dict with the keys of its `--json`, with `toml`, the
/// scenario, which is written to `out`, and `objections`, what speaks against it.
#[pyfunction]
#[pyo3(signature = (robot, out, *, duration = 20.0, control_period = 0.001, posture = None, link_resolution = flexure::excite::RESOLUTION,
                    motor_resolution = flexure::excite::RESOLUTION, motor_only = false, budget = flexure::excite::BUDGET, seed = 0,
                    allow_outside = false, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub fn excite<'py>(
    py: Python<'py>,
    robot: PathBuf,
    out: PathBuf,
    duration: f64,
    control_period: f64,
    posture: Option<Vec<f64>>,
    link_resolution: f64,
    motor_resolution: f64,
    motor_only: bool,
    budget: usize,
    seed: u64,
    allow_outside: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let robot = robot.to_string_lossy().into_owned();
    spare_out(&out, &robot).map_err(|problem| refused(py, &problem))?;
    prepare(folder_of(&out)).map_err(unwritten)?;
    let link_resolution = (!motor_only).then_some(link_resolution);
    let settings =
        Motion { duration, control_period, budget, seed, posture, link_resolution, motor_resolution };
    let found = watched(py, progress, |progress| {
        designed(&robot, &out, outside(allow_outside), &settings, progress)
    })?
    .map_err(|problems| raised(py, &problems))?;
    write_atomic(&out, |file| file.write_all(found.toml.as_bytes())).map_err(unwritten)?;
    let answer = document(py, &found)?;
    answer.set_item("objections", documents(py, found.objections.iter())?)?;
    Ok(answer)
}

/// Lays a log over the simulation of a scenario, as `flexure replay`: a dict with the keys of its `--json`, and `trace` and `units`, log,
/// closed loop, prediction and residuals.
#[pyfunction]
#[pyo3(signature = (scenario, log, *, columns = None, horizon = flexure::replay::HORIZON, progress = None))]
pub fn replay<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    log: PathBuf,
    columns: Option<String>,
    horizon: f64,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let loaded = scenario.loaded.clone();
    let mut warnings = Vec::new();
    let logs = read(&[log], columns.as_deref(), false, &loaded.robot, &mut warnings)
        .map_err(|problems| raised(py, &problems))?;
    warn(py, &warnings, OF_JOBS)?;
    let found =
        watched(py, progress, |progress| flexure::replay::replay(&loaded, &logs[0], horizon, progress))?
            .map_err(|problems| raised(py, &problems))?;
    warn(py, &found.warnings, OF_JOBS)?;
    let answer = document(py, &found)?;
    let (trace, units) = arrays(py, found.trace)?;
    answer.set_item("trace", trace)?;
    answer.set_item("units", units)?;
    Ok(answer)
}
