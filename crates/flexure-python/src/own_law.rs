//! A law written in Python: slow, for experiments.

use std::sync::{Arc, Mutex, PoisonError};

use flexure::core::control::TERMS;
use flexure::simulate::{OwnLaw, OwnShaping};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{Numbers, shaped, vector};

/// What the law raised: a loop has no place for it, so that it waits here.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// The first of them, if there is one.
    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// The first of them as what went wrong, else `otherwise`.
    pub fn first<T>(&self, otherwise: PyResult<T>) -> PyResult<T> {
        self.take().map_or(otherwise, Err)
    }
}

/// The law of `function`, called with the time in s, the motion that is seen, (4n,), and the reference with its derivatives, (5, n); it returns
/// torques, (n,), N m. Where it raises, the torque is no number and the loop ends.
pub fn own_law(function: Py<PyAny>) -> (OwnLaw, Raised) {
    let raised = Raised::default();
    let keep = raised.clone();
    let law = OwnLaw::new(move |t, motion, series, u_m| {
        let given = Python::attach(|py| torque(py, &function, t, motion, series, u_m));
        if let Err(error) = given {
            u_m.fill(f64::NAN);
            keep.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        }
    });
    (law, raised)
}

fn torque(
    py: Python<'_>,
    function: &Py<PyAny>,
    t: f64,
    motion: &[f64],
    series: &[[f64; 5]],
    u_m: &mut [f64],
) -> PyResult<()> {
    let n = series.len();
    let reference = shaped(py, derivatives(series).collect(), &[], &[5, n])?;
    let given = function.call1(py, (t, vector(py, motion), reference))?;
    let given = Numbers::new("the law's torque", given.bind(py))?;
    if !given.batch(n, "u_m, a number per joint")?.is_empty() {
        return Err(given.unexpected(&[n]));
    }
    u_m.copy_from_slice(given.slice()?);
    Ok(())
}

/// Positions of all joints, then their first derivatives, … from Taylor coefficients.
pub fn derivatives(series: &[[f64; 5]]) -> impl Iterator<Item = f64> {
    let factorials = [1.0, 1.0, 2.0, 6.0, 24.0];
    (0..5).flat_map(move |k| series.iter().map(move |joint| joint[k] * factorials[k]))
}

/// A shaping function as Python fits it: the error at which x = 1/√2, rad, and the coefficients of its series.
#[derive(Clone, FromPyObject)]
pub struct Series {
    scale: f64,
    coefficients: Vec<f64>,
}

impl Series {
    /// What it is made of.
    pub fn parts(self) -> (f64, Vec<f64>) {
        (self.scale, self.coefficients)
    }

    /// From what it is made of.
    pub fn of((scale, coefficients): (f64, Vec<f64>)) -> Self {
        Self { scale, coefficients }
    }
}

/// The shaping function of `series`, which a whole law leaves no place for.
pub fn own_shaping(series: Option<Series>, is_beside_a_law: bool) -> PyResult<Option<OwnShaping>> {
    let Some(Series { scale, coefficients }) = series else { return Ok(None) };
    if is_beside_a_law {
        return Err(PyTypeError::new_err(
            "law and shaping: a law of one's own has no shaping function of the scenario's",
        ));
    }
    let is_finite = coefficients.iter().all(|coefficient| coefficient.is_finite());
    if !(scale > 0.0 && scale.is_finite() && is_finite && coefficients.len() <= TERMS) {
        return Err(PyValueError::new_err(format!(
            "shaping: no series of finite numbers with at most {TERMS} terms"
        )));
    }
    Ok(Some(OwnShaping { scale, coefficients }))
}
