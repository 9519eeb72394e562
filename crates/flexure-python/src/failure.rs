//! Problems as exceptions.

use flexure::files::{Problem, Problems, Unfinished};
use flexure::robot::Mismatch;
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt, PyOSError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

create_exception!(
    flexure,
    FlexureError,
    PyException,
    "What the command line says with exit code 1 or 2: the text is the message, with file, line and hint; `problems` has a dict with \
     the keys code, message, hint, file, line and column for each."
);

/// An exception of `problems`, or KeyboardInterrupt if they say that a job was broken off.
pub fn raised(py: Python<'_>, problems: &Problems) -> PyErr {
    if problems.is_interrupted() {
        PyKeyboardInterrupt::new_err(())
    } else {
        of(py, &problems.iter().collect::<Vec<_>>())
    }
}

create_exception!(flexure, FlexureWarning, PyUserWarning, "What is suspicious in a file, a log or a run.");

/// An exception of what no problem of the library says, with its code, message and hint.
pub fn said(py: Python<'_>, code: &str, message: &str, hint: &str) -> PyErr {
    let error = FlexureError::new_err(hinted(message, hint));
    let document = || {
        let document = PyDict::new(py);
        document.set_item("code", code)?;
        document.set_item("message", message)?;
        document.set_item("hint", hint)?;
        ["file", "line", "column"].into_iter().try_for_each(|key| document.set_item(key, py.None()))?;
        error.value(py).setattr("problems", PyList::new(py, [document])?)
    };
    // Where memory is out the text has to do.
    let _ = document();
    error
}

/// A message and its hint.
fn hinted(message: &str, hint: &str) -> String {
    if hint.is_empty() { message.to_owned() } else { format!("{message}\n  help: {hint}") }
}

/// An exception of one problem.
pub fn refused(py: Python<'_>, problem: &Problem) -> PyErr {
    of(py, &[problem])
}

/// That a file could not be written.
pub fn unwritten(error: impl std::error::Error) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// Why a job that writes as it goes has no outcome.
pub fn unfinished(py: Python<'_>, unfinished: Unfinished) -> PyErr {
    match unfinished {
        Unfinished::Problems(problems) => raised(py, &problems),
        Unfinished::Unwritten(error) => unwritten(error),
    }
}

/// An exception of several problems, at least one.
fn of(py: Python<'_>, problems: &[&Problem]) -> PyErr {
    let text: Vec<_> = problems.iter().map(|problem| words(problem)).collect();
    let error = FlexureError::new_err(text.join("\n"));
    // Where memory is out the text has to do.
    let _ = documents(py, problems.iter().copied())
        .and_then(|documents| error.value(py).setattr("problems", documents));
    error
}

/// Problems as a list of dicts, as `--json` has them.
pub fn documents<'a, 'py>(
    py: Python<'py>,
    problems: impl Iterator<Item = &'a Problem>,
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for problem in problems {
        let (line, column) = problem.line_column().unzip();
        let document = PyDict::new(py);
        document.set_item("code", problem.code_word())?;
        document.set_item("message", problem.to_string())?;
        document.set_item("hint", problem.hint())?;
        document.set_item("file", problem.file())?;
        document.set_item("line", line)?;
        document.set_item("column", column)?;
        list.append(document)?;
    }
    Ok(list)
}

/// A problem in words: place, message, hint.
fn words(problem: &Problem) -> String {
    let place = match (problem.file(), problem.line_column()) {
        (Some(file), Some((line, column))) => format!("{file}:{line}:{column}: "),
        _ => String::new(),
    };
    format!("{place}{}", hinted(&problem.to_string(), problem.hint()))
}

/// Warnings by Python's own way to warn, at the place that is `level` frames up.
pub fn warn(py: Python<'_>, warnings: &[Problem], level: i32) -> PyResult<()> {
    let category = py.get_type::<FlexureWarning>();
    for warning in warnings {
        let text = std::ffi::CString::new(words(warning).replace('\0', "\u{fffd}")).unwrap_or_default();
        PyErr::warn(py, &category, &text, level)?;
    }
    Ok(())
}

/// Frames from the function of the module to who called the one around it: `_jobs.py` has two between.
pub const OF_JOBS: i32 = 4;

/// Slices of a wrong length, where shapes were looked at before: never.
pub fn mismatch(mismatch: Mismatch) -> PyErr {
    PyValueError::new_err(mismatch.to_string())
}
