//! Changes of a scenario from Python values.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// Deeper than this no file goes.
const DEEPEST: usize = 16;

/// Changes from `set`: a dict of dotted keys, or texts "key=value" as the command line takes them.
pub fn changes(set: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
    let Some(set) = set else { return Ok(Vec::new()) };
    if let Ok(keys) = set.cast::<PyDict>() {
        return keys
            .iter()
            .map(|(key, value)| Ok(format!("{}={}", text("set", &key)?, toml("set", &value)?)))
            .collect();
    }
    if set.is_instance_of::<PyString>() {
        return Ok(vec![text("set", set)?]);
    }
    set.try_iter()?.map(|change| text("set", &change?)).collect()
}

/// A key or a change as it is.
fn text(name: &str, given: &Bound<'_, PyAny>) -> PyResult<String> {
    given.extract().map_err(|_| {
        let kind = kind(given);
        PyTypeError::new_err(format!(
            "{name}: {kind} is no text; expected a dict of dotted keys, or texts \"key=value\""
        ))
    })
}

fn kind(given: &Bound<'_, PyAny>) -> String {
    given.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string())
}

/// The value of the argument `name` as TOML has it.
pub fn toml(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    inside(name, value, 0)
}

/// A value inside of `depth` others.
fn inside(name: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<String> {
    if depth > DEEPEST {
        return Err(PyValueError::new_err(format!(
            "{name}: lists or dicts inside of more than {DEEPEST} others"
        )));
    }
    let join = |entries: PyResult<Vec<String>>| entries.map(|entries| entries.join(", "));
    if let Ok(table) = value.cast::<PyDict>() {
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok(format!("{} = {}", quoted(&text(name, &key)?), inside(name, &value, depth + 1)?))
        };
        return Ok(format!("{{{}}}", join(table.iter().map(entry).collect())?));
    }
    if value.is_instance_of::<PyString>() || value.hasattr("__fspath__")? {
        let path: std::path::PathBuf = value.extract()?;
        return Ok(quoted(&path.to_string_lossy()));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let entries = value.try_iter()?.map(|value| inside(name, &value?, depth + 1)).collect();
        return Ok(format!("[{}]", join(entries)?));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(value.is_truthy()?.to_string());
    }
    if value.is_instance_of::<PyFloat>() {
        // The fewest digits that restore it.
        return Ok(format!("{:?}", value.extract::<f64>()?).to_lowercase());
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.str()?.to_string());
    }
    // Arrays and numbers of NumPy.
    if value.hasattr("tolist")? {
        let plain = value.call_method0("tolist")?;
        if !plain.get_type().is(value.get_type()) && !plain.hasattr("tolist")? {
            return inside(name, &plain, depth + 1);
        }
    }
    Err(PyTypeError::new_err(format!(
        "{name}: a value of type {} is none of a file; expected text, numbers, bools, lists, dicts, arrays",
        kind(value)
    )))
}

fn quoted(text: &str) -> String {
    serde_json::to_string(text).unwrap_or_default()
}
