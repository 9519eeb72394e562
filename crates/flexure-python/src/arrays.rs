//! Numbers of Python as slices, and slices as arrays.
//!
//! The last axis of an array holds the numbers of one robot; axes before it are a batch. Arrays of f64 without gaps are read where
//! they are; anything else that NumPy can make numbers of is copied.

use flexure::robot::Mismatch;
use numpy::{
    IntoPyArray as _, PyArray1, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyMemoryError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::failure::mismatch;

/// Rows of a batch between two looks at Ctrl-C: some ten milliseconds of work.
const PIECE: usize = 1024;

/// Fills `found`, rows of `size` numbers, piece by piece beside the interpreter: `fill` gets the first row of a piece, and the piece.
pub fn in_pieces(
    py: Python<'_>,
    found: &mut [f64],
    size: usize,
    fill: impl Fn(usize, &mut [f64]) -> Result<(), Mismatch> + Sync,
) -> PyResult<()> {
    let count = found.len() / size;
    let (mut first, mut rest) = (0, found);
    while first < count {
        if first > 0 {
            py.check_signals()?;
        }
        // None is left alone: one by itself may be computed otherwise than one of many.
        let here = if count - first == PIECE + 1 { PIECE + 1 } else { PIECE.min(count - first) };
        let (piece, others) = rest.split_at_mut(here * size);
        py.detach(|| fill(first, piece)).map_err(mismatch)?;
        (first, rest) = (first + here, others);
    }
    Ok(())
}

/// An argument that holds arrays.
pub struct Numbers<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    name: &'static str,
}

impl<'py> Numbers<'py> {
    /// `given` as numbers; `name` stands for it in messages.
    pub fn new(name: &'static str, given: &Bound<'py, PyAny>) -> PyResult<Self> {
        // Subclasses may mean something else by their numbers, as masked arrays do.
        if let Ok(array) = given.cast_exact::<PyArrayDyn<f64>>()
            && let Ok(array) = array.try_readonly()
            && array.is_c_contiguous()
            && array.as_slice().is_ok()
        {
            return Ok(Self { array, name });
        }
        let py = given.py();
        let numpy = py.import("numpy")?;
        let refused = |error: PyErr| {
            // Anything else, as memory that is out, is no matter of its type.
            if !(error.is_instance_of::<PyTypeError>(py) || error.is_instance_of::<PyValueError>(py)) {
                return error;
            }
            let what = given.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
            PyTypeError::new_err(format!("{name}: {what} is no array of real numbers: {}", error.value(py)))
        };
        if given.hasattr("mask")? && given.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
            return Err(PyTypeError::new_err(format!("{name}: a masked array; fill what is masked")));
        }
        let any = numpy.call_method1("asarray", (given,)).map_err(refused)?;
        let kind: String = any.getattr("dtype")?.getattr("kind")?.extract()?;
        if !["b", "i", "u", "f"].contains(&&*kind) {
            let dtype = any.getattr("dtype")?;
            return Err(PyTypeError::new_err(format!(
                "{name}: numbers of type {dtype}; expected real numbers, as float64"
            )));
        }
        let copied = numpy.call_method1("require", (any, "float64", ["C", "A"])).map_err(refused)?;
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
        if self.batch(count, meaning)? == batch {
            return Ok(());
        }
        let expected: Vec<_> = batch.iter().copied().chain([count]).collect();
        Err(self.unexpected(&expected))
    }

    /// That its shape is not as `expected`.
    pub fn unexpected(&self, expected: &[usize]) -> PyErr {
        let (own, expected) = (shape(self.axes()), shape(expected));
        PyValueError::new_err(format!("{}: shape {own}; expected {expected}", self.name))
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

/// An argument with its name, how many numbers its last axis has, and what they mean.
pub type Argument<'a, 'py> = (&'static str, &'a Bound<'py, PyAny>, usize, &'a str);

/// Arguments whose axes before the last one are broadcast to the same batch, by NumPy's rules.
pub fn together<'py>(
    py: Python<'py>,
    arguments: &[Argument<'_, 'py>],
) -> PyResult<(Vec<Numbers<'py>>, Vec<usize>)> {
    let mut read: Vec<Numbers<'py>> =
        arguments.iter().map(|(name, given, ..)| Numbers::new(name, given)).collect::<PyResult<_>>()?;
    let batches: Vec<Vec<usize>> = read
        .iter()
        .zip(arguments)
        .map(|(numbers, (_, _, count, meaning))| numbers.batch(*count, meaning))
        .collect::<PyResult<_>>()?;
    if batches.iter().all(|batch| *batch == batches[0]) {
        return Ok((read, batches.into_iter().next().unwrap_or_default()));
    }
    let numpy = py.import("numpy")?;
    let shapes = batches.iter().map(|batch| PyTuple::new(py, batch)).collect::<PyResult<Vec<_>>>()?;
    let common = numpy.call_method1("broadcast_shapes", PyTuple::new(py, shapes)?).map_err(|_| {
        let shapes: Vec<_> =
            read.iter().map(|numbers| format!("{} {}", numbers.name, shape(numbers.axes()))).collect();
        PyValueError::new_err(format!(
            "shapes do not fit: {}; axes before the last are a batch",
            shapes.join(", ")
        ))
    })?;
    let batch: Vec<usize> = common.extract()?;
    for (numbers, (name, _, count, _)) in read.iter_mut().zip(arguments) {
        let axes = PyTuple::new(py, [&*batch, &[*count]].concat())?;
        let wide = numpy.call_method1("broadcast_to", (&*numbers.array, axes))?;
        *numbers = Numbers::new(name, &wide)?;
    }
    Ok((read, batch))
}

/// So many zeros.
///
/// # Errors
/// `MemoryError`.
pub fn zeros(count: usize) -> PyResult<Vec<f64>> {
    let mut zeros = Vec::new();
    zeros
        .try_reserve_exact(count)
        .map_err(|_| PyMemoryError::new_err(format!("no memory for {count} numbers")))?;
    zeros.resize(count, 0.0);
    Ok(zeros)
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

/// `numbers` as an array that is not to be written to.
pub fn constant<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let array = vector(py, numbers);
    array.call_method1("setflags", (false,))?;
    Ok(array)
}
