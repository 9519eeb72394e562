//! A closed loop that Python steps.

use std::sync::{Mutex, PoisonError};
use std::thread::{self, ThreadId};

use numpy::PyArrayDyn;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Numbers, shaped, together, vector, zeros};
use crate::failure::{self, mismatch, said};
use crate::own_law::{Raised, Series, own_law, own_shaping};
use crate::robot::MOTION;
use crate::scenario::{Scenario, given};

/// The closed loop of a scenario, moved from one control instant to the next.
#[pyclass(frozen, module = "flexure")]
pub struct Loop {
    held: Mutex<Box<dyn flexure::Loop>>,
    /// The thread in which a law in Python is asked: it would wait for itself.
    asking: Mutex<Option<ThreadId>>,
    scenario: Py<Scenario>,
    /// What a law in Python raised; none for that of the scenario.
    raised: Option<Raised>,
    /// The shaping function of one's own, if there is one.
    shaping: Option<Series>,
}

impl Loop {
    pub fn open(
        py: Python<'_>,
        scenario: Py<Scenario>,
        law: Option<Py<PyAny>>,
        shaping: Option<Series>,
    ) -> PyResult<Self> {
        let loaded = scenario.get().loaded.clone();
        let series = shaping.clone();
        let shaping = own_shaping(shaping, law.is_some())?;
        let (law, raised) = law.map(own_law).unzip();
        let open = || match (law, shaping) {
            (Some(law), _) => loaded.open_with(law),
            (None, Some(shaping)) => loaded.open_shaped(&shaping),
            (None, None) => loaded.open(),
        };
        let held = py.detach(open).map_err(|problems| failure::raised(py, &problems))?;
        Ok(Self { held: Mutex::new(held), asking: Mutex::new(None), scenario, raised, shaping: series })
    }

    /// What the law in Python raised, else `result`.
    fn unraised<T>(&self, result: PyResult<T>) -> PyResult<T> {
        match &self.raised {
            None => result,
            Some(raised) => raised.first(result),
        }
    }

    /// What `what` makes of the loop; an error if a law uses the very loop that asks it, which would wait for itself.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        what: impl FnOnce(&mut dyn flexure::Loop) -> T + Send,
    ) -> PyResult<T> {
        let asking = || self.asking.lock().unwrap_or_else(PoisonError::into_inner);
        let own = self.raised.as_ref().map(|_| thread::current().id());
        if own.is_some() && *asking() == own {
            return Err(PyRuntimeError::new_err("a law uses the loop that asks it"));
        }
        Ok(py.detach(|| {
            let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
            *asking() = own;
            let found = what(&mut **held);
            *asking() = None;
            found
        }))
    }
}

#[pymethods]
impl Loop {
    #[new]
    #[pyo3(signature = (scenario, *, law = None, shaping = None))]
    fn new(scenario: &Bound<'_, PyAny>, law: Option<Py<PyAny>>, shaping: Option<Series>) -> PyResult<Self> {
        Self::open(scenario.py(), given(scenario)?, law, shaping)
    }

    /// The scenario that it was opened from.
    #[getter]
    fn scenario(&self, py: Python<'_>) -> Py<Scenario> {
        self.scenario.clone_ref(py)
    }

    /// Number of joints n.
    #[getter]
    fn joints(&self, py: Python<'_>) -> PyResult<usize> {
        self.with(py, |held| held.joints())
    }

    /// Time between two control instants, s.
    #[getter]
    fn period(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |held| held.period())
    }

    /// Names of what can be read, the columns of a trace.
    #[getter]
    fn signals(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.with(py, |held| held.signals().iter().map(|signal| signal.name.clone()).collect())
    }

    /// Units of the signals, by name; empty for none.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = self.with(py, |held| held.signals().to_vec())?;
        let units = PyDict::new(py);
        all.iter().try_for_each(|signal| units.set_item(&signal.name, signal.unit))?;
        Ok(units)
    }

    /// Moves on by `count` control instants, the first at t = 0. Raises FlexureError if the loop diverges: what can be read is then the
    /// last good instant.
    #[pyo3(signature = (count = 1))]
    fn step(&self, py: Python<'_>, count: u64) -> PyResult<()> {
        // Between two looks at signals.
        const AT_ONCE: u64 = 256;
        let mut left = count;
        while left > 0 {
            let now = left.min(AT_ONCE);
            let stepped = self
                .with(py, |held| (0..now).try_for_each(|_| held.step()))?
                .map_err(|divergence| said(py, "diverged", &divergence.to_string(), ""));
            self.unraised(stepped)?;
            left -= now;
            py.check_signals()?;
        }
        Ok(())
    }

    /// The signals at the last instant, by name; NaN before the first.
    fn read<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (signals, values) = self
            .with(py, |held| {
                let signals = held.signals().to_vec();
                let mut values = vec![0.0; signals.len()];
                held.read(&mut values).map(|()| (signals, values))
            })?
            .map_err(mismatch)?;
        let document = PyDict::new(py);
        for (signal, value) in signals.iter().zip(values) {
            document.set_item(&signal.name, value)?;
        }
        Ok(document)
    }

    /// Time of the last instant, s.
    #[getter]
    fn t(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.observed(py)?.t)
    }

    /// Motion at the last instant, (q_l, q_m, dq_l, dq_m).
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        Ok(vector(py, &self.observed(py)?.motion))
    }

    /// Torque of the motors at the last instant, N m.
    #[getter]
    fn u_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        Ok(vector(py, &self.observed(py)?.applied))
    }

    /// Rate of motions x, (dq_l, dq_m, ddq_l, ddq_m), of the simulated robot at the time t when its motors give u_m, without dry friction and
    /// hysteresis: (…, 4n), (…, n) → (…, 4n).
    fn derivative<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        x: &Bound<'py, PyAny>,
        u_m: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.joints(py)?;
        let arguments = [("x", x, 4 * n, MOTION), ("u_m", u_m, n, "u_m, a number per joint")];
        let (read, batch) = together(py, &arguments)?;
        let [x, u_m] = [&read[0], &read[1]];
        let (motions, torques) = (x.slice()?, u_m.slice()?);
        let mut rates = zeros(motions.len())?;
        self.with(py, |held| {
            let rows = motions.chunks_exact(4 * n).zip(torques.chunks_exact(n));
            rows.zip(rates.chunks_exact_mut(4 * n))
                .try_for_each(|((x, u), rate)| held.derivative(t, x, u, rate))
        })?
        .map_err(mismatch)?;
        shaped(py, rates, &batch, &[4 * n])
    }

    /// Everything that it remembers, as numbers: to come back by `restore`.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        Ok(vector(py, &self.with(py, |held| held.state())?))
    }

    /// Goes on from a state of this loop, or of another one of the same scenario.
    fn restore(&self, py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let numbers = Numbers::new("state", state)?;
        if numbers.axes().len() != 1 {
            return Err(numbers.unexpected(&[self.with(py, |held| held.state().len())?]));
        }
        let state = numbers.slice()?;
        self.with(py, |held| held.restore(state))?.map_err(|unfit| PyValueError::new_err(unfit.to_string()))
    }

    /// Goes back to before the first instant, with other random numbers.
    fn reset(&self, py: Python<'_>, seed: u64) -> PyResult<()> {
        self.with(py, |held| held.reset(seed))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Loop({} at t = {} s)", self.scenario.get().loaded.name, self.observed(py)?.t))
    }

    /// Scenario and state: bit for bit the loop that it was.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        if slf.get().raised.is_some() {
            return Err(PyTypeError::new_err(
                "a loop with a law in Python: pickle its scenario and its state",
            ));
        }
        let shaping = slf.get().shaping.clone().map(Series::parts);
        let arguments = (slf.get().scenario(py), slf.get().state(py)?, shaping);
        PyTuple::new(py, [slf.get_type().getattr("_again")?, arguments.into_pyobject(py)?.into_any()])
    }

    #[staticmethod]
    fn _again(
        py: Python<'_>,
        scenario: Py<Scenario>,
        state: &Bound<'_, PyAny>,
        shaping: Option<(f64, Vec<f64>)>,
    ) -> PyResult<Self> {
        let again = Self::open(py, scenario, None, shaping.map(Series::of))?;
        again.restore(py, state)?;
        Ok(again)
    }
}

impl Loop {
    fn observed(&self, py: Python<'_>) -> PyResult<flexure::simulate::Observed> {
        self.with(py, |held| {
            let mut observed = flexure::simulate::Observed::new(held.joints());
            held.observe(&mut observed).map(|()| observed)
        })?
        .map_err(|mismatch| PyRuntimeError::new_err(mismatch.to_string()))
    }
}
