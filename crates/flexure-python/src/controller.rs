//! The law of a scenario by itself.

use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Numbers, Times, in_pieces, shape, shaped, vector, zeros};
use crate::failure::{mismatch, raised};
use crate::own_law::derivatives;
use crate::robot::MOTION;
use crate::scenario::{Scenario, given};

/// The law of a scenario: what it asks of the motors of a robot that moves as x, (q_l, q_m, dq_l, dq_m), at the time t. It sees the
/// motion as it is; nothing is remembered.
#[pyclass(frozen, module = "flexure")]
pub struct Controller {
    held: Box<dyn flexure::Loop>,
    linear: flexure::sampled::Linearised,
    scenario: Py<Scenario>,
}

impl Controller {
    pub fn open(py: Python<'_>, scenario: Py<Scenario>) -> PyResult<Self> {
        let loaded = scenario.get().loaded.clone();
        let open = || Ok((loaded.open()?, flexure::sampled::Linearised::of(&loaded)?));
        let (held, linear) = py.detach(open).map_err(|problems: flexure::Problems| raised(py, &problems))?;
        Ok(Self { held, linear, scenario })
    }
}

#[pymethods]
impl Controller {
    #[new]
    fn new(scenario: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::open(scenario.py(), given(scenario)?)
    }

    /// The scenario whose law it is.
    #[getter]
    fn scenario(&self, py: Python<'_>) -> Py<Scenario> {
        self.scenario.clone_ref(py)
    }

    /// Number of joints n.
    #[getter]
    fn joints(&self) -> usize {
        self.held.joints()
    }

    /// Motor torque, N m, at motions x and times t in s, one or one for each motion: (…, 4n) → (…, n).
    fn torque<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        t: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.held.joints();
        let numbers = Numbers::new("x", x)?;
        let batch = numbers.batch(4 * n, MOTION)?;
        let motions = numbers.slice()?;
        let mut u_m = zeros(motions.len() / 4)?;
        match Times::new(t)? {
            Times::All(t) if batch.is_empty() => {
                self.held.torque(t, motions, &mut u_m).map_err(mismatch)?;
            }
            Times::All(t) => in_pieces(py, &mut u_m, n, |first, u_m| {
                self.held.torque(t, &motions[4 * n * first..][..4 * u_m.len()], u_m)
            })?,
            Times::Each(times) if times.axes() == batch => {
                let times = times.slice()?;
                in_pieces(py, &mut u_m, n, |first, u_m| {
                    let rows = motions[4 * n * first..].chunks_exact(4 * n).zip(&times[first..]);
                    u_m.chunks_exact_mut(n)
                        .zip(rows)
                        .try_for_each(|(u_m, (x, t))| self.held.torque(*t, x, u_m))
                })?;
            }
            Times::Each(times) => {
                let (own, expected) = (shape(times.axes()), shape(&batch));
                return Err(PyValueError::new_err(format!(
                    "t: shape {own}; expected one time, or {expected}, one for each motion"
                )));
            }
        }
        shaped(py, u_m, &batch, &[n])
    }

    /// What it computes on the way at one motion: a dict of arrays u_m, e_l, and of v-CBC u_l, q_md, e_m, s_l, s_m, sigma_l, sigma_m;
    /// energy in J.
    fn command<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>, t: f64) -> PyResult<Bound<'py, PyDict>> {
        let numbers = Numbers::new("x", x)?;
        let n = self.held.joints();
        one(&numbers.batch(4 * n, MOTION)?)?;
        let found = self.held.command(t, numbers.slice()?).map_err(mismatch)?;
        let document = PyDict::new(py);
        let put = |key: &str, numbers: Vec<f64>| document.set_item(key, vector(py, &numbers));
        put("u_m", found.u_m)?;
        put("e_l", found.e_l)?;
        if let Some(errors) = found.errors {
            for (key, numbers) in [
                ("u_l", errors.u_l),
                ("q_md", errors.q_md),
                ("e_m", errors.e_m),
                ("s_l", errors.s_l),
                ("s_m", errors.s_m),
                ("sigma_l", errors.sigma_l),
                ("sigma_m", errors.sigma_m),
            ] {
                put(key, numbers)?;
            }
        }
        document.set_item("energy", found.energy)?;
        Ok(document)
    }

    /// The reference at times t in s, positions and their first four derivatives: (…) → (…, 5, n).
    fn reference<'py>(
        &self,
        py: Python<'py>,
        t: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.held.joints();
        let times = Times::new(t)?;
        let all = match &times {
            Times::All(t) => std::slice::from_ref(t),
            Times::Each(numbers) => numbers.slice()?,
        };
        let (mut series, mut found) = (vec![[0.0; 5]; n], Vec::with_capacity(all.len() * 5 * n));
        for &t in all {
            self.held.reference(t, &mut series).map_err(mismatch)?;
            found.extend(derivatives(&series));
        }
        shaped(py, found, times.axes(), &[5, n])
    }

    /// Slopes of the torque over the motion, by dual numbers, exact: du_m/dx at one motion, (4n,) → (n, 4n).
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        t: f64,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let numbers = Numbers::new("x", x)?;
        let n = self.held.joints();
        one(&numbers.batch(4 * n, MOTION)?)?;
        let slopes = self.linear.law(t, numbers.slice()?).map_err(mismatch)?;
        shaped(py, slopes, &[], &[n, 4 * n])
    }

    /// The simulated robot about one motion x and motor torques u_m: (A, B) of d(dx/dt) = A dx + B du_m, (4n, 4n) and (4n, n), exact.
    fn linearise<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        u_m: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let (x, u_m) = (Numbers::new("x", x)?, Numbers::new("u_m", u_m)?);
        let n = self.held.joints();
        one(&x.batch(4 * n, MOTION)?)?;
        u_m.beside(&[], n, "u_m, a number per joint")?;
        let [a, b] = self.linear.plant(x.slice()?, u_m.slice()?).map_err(mismatch)?;
        PyTuple::new(py, [shaped(py, a, &[], &[4 * n, 4 * n])?, shaped(py, b, &[], &[4 * n, n])?])
    }

    fn __repr__(&self) -> String {
        format!("Controller({}: {} joints)", self.scenario.get().loaded.name, self.held.joints())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (Py<Scenario>,)) {
        (slf.get_type().into_any(), (slf.get().scenario(slf.py()),))
    }
}

/// Refuses a batch where one motion is meant.
fn one(batch: &[usize]) -> PyResult<()> {
    if batch.is_empty() {
        return Ok(());
    }
    Err(PyValueError::new_err("x: one motion is meant here, of shape (4n,), not a batch"))
}
