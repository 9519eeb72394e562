//! Numbers of Python as slices, and slices as arrays.
//!
//! The last axis of an array holds the numbers of one robot; axes before it are a batch. Arrays of f64 without gaps are read where
//! they are; anything else that NumPy can make numbers of is copied.

use numpy::{
    IntoPyArray as _, PyArray1, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An argument that holds arrays.
pub struct Numbers<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    name: &'static str,
}

impl<'py> Numbers<'py> {
    /// `given` as numbers; `name` stands for it in messages.
    pub fn new(name: &'static str, given: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(array) = given.extract::<PyReadonlyArrayDyn<'py, f64>>()
            && array.is_c_contiguous()
        {
            return Ok(Self { array, name });
        }
        let py = given.py();
        let numpy = py.import("numpy")?;
        let refused = |error: PyErr| {
            let what = given.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
            PyTypeError::new_err(format!("{name}: {what} is no array of real numbers: {}", error.value(py)))
        };
        let any = numpy.call_method1("asarray", (given,)).map_err(refused)?;
        let kind: String = any.getattr("dtype")?.getattr("kind")?.extract()?;
        if !["b", "i", "u", "f"].contains(&&*kind) {
            let dtype = any.getattr("dtype")?;
            return Err(PyTypeError::new_err(format!(
                "{name}: numbers of type {dtype}; expected real numbers, as float64"
            )));
        }
        let options = PyDict::new(py);
        options.set_item("dtype", "float64")?;
        options.set_item("order", "C")?;
        let copied = numpy.call_method("asarray", (any,), Some(&options)).map_err(refused)?;
        Ok(Self { array: copied.extract()?, name })
    }

    /// The axes before the last one, of arrays whose last axis has `count` numbers, called `meaning`.
    pub fn batch(&self, count: usize, meaning: &str) -> PyResult<Vec<usize>> {
        match self.array.shape().split_last() {
            Some((last, batch)) if *last == count => Ok(batch.to_vec()),
            _ => Err(PyValueError::new_err(format!(
                "{}: shape {}; expected (…, {count}) = {meaning}",
                self.name,
                shape(self.array.shape())
            ))),
        }
    }

    /// As [`Self::batch`], if it is as `batch`.
    pub fn beside(&self, batch: &[usize], count: usize, meaning: &str) -> PyResult<()> {
        let own = self.batch(count, meaning)?;
        if own == batch {
            return Ok(());
        }
        let expected: Vec<_> = batch.iter().copied().chain([count]).collect();
        Err(PyValueError::new_err(format!(
            "{}: shape {}; expected {} as the arrays before it, = {meaning}",
            self.name,
            shape(self.array.shape()),
            shape(&expected)
        )))
    }

    /// All axes.
    pub fn axes(&self) -> &[usize] {
        self.array.shape()
    }

    /// All numbers, one after the other.
    pub fn slice(&self) -> PyResult<&[f64]> {
        Ok(self.array.as_slice()?)
    }
}

/// Times in s: one for all, or one for each of a batch.
pub enum Times<'py> {
    /// One.
    All(f64),
    /// One for each.
    Each(Numbers<'py>),
}

impl<'py> Times<'py> {
    /// What `given` is, as the argument t.
    pub fn new(given: &Bound<'py, PyAny>) -> PyResult<Self> {
        match given.extract() {
            Ok(t) => Ok(Self::All(t)),
            Err(_) => Ok(Self::Each(Numbers::new("t", given)?)),
        }
    }

    /// Its own axes.
    pub fn axes(&self) -> &[usize] {
        match self {
            Self::All(_) => &[],
            Self::Each(numbers) => numbers.axes(),
        }
    }
}

/// A shape as Python writes it.
pub fn shape(axes: &[usize]) -> String {
    let numbers: Vec<_> = axes.iter().map(ToString::to_string).collect();
    if let [one] = &*numbers { format!("({one},)") } else { format!("({})", numbers.join(", ")) }
}

/// `numbers` as an array with the axes of `batch` and then `last`.
pub fn shaped<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    batch: &[usize],
    last: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    if let ([], [_]) = (batch, last) {
        return Ok(vector(py, &numbers));
    }
    let axes: Vec<usize> = batch.iter().chain(last).copied().collect();
    numbers.into_pyarray(py).reshape(axes)
}

/// `numbers` as an array with one axis.
pub fn vector<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyArrayDyn<f64>> {
    PyArray1::from_slice(py, numbers).to_dyn().clone()
}
