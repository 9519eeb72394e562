//! The simulated robot of a scenario under torques of the caller.

use std::sync::Arc;

use flexure::progress::{Progress, unwatched};
use flexure::simulate::Driven;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{Numbers, shape, shaped, zeros};
use crate::failure::{mismatch, raised};
use crate::robot::MOTION;
use crate::scenario::{Scenario, given};
use crate::watched::watched;

/// Periods beyond which Ctrl-C is looked at: some ten milliseconds of work.
const MANY: usize = 4096;

/// The robot that a scenario simulates, driven by torques of the caller: friction, coupled rotors, springs that are not linear, torque
/// constants that are off and pushes included; no sensors, no controller, no torque limit.
#[pyclass(frozen, module = "flexure")]
pub struct Plant {
    driven: Box<dyn Driven>,
    scenario: Py<Scenario>,
    period: f64,
}

#[pymethods]
impl Plant {
    #[new]
    fn new(scenario: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (py, scenario) = (scenario.py(), given(scenario)?);
        let loaded = Arc::clone(&scenario.get().loaded);
        let driven = loaded.driven().map_err(|problems| raised(py, &problems))?;
        Ok(Self { driven, scenario, period: loaded.control_period })
    }

    /// Number of joints n.
    #[getter]
    fn joints(&self) -> usize {
        self.driven.joints()
    }

    /// Time that a torque is held unless said otherwise: the control period of the scenario, s.
    #[getter]
    fn period(&self) -> f64 {
        self.period
    }

    /// The scenario.
    #[getter]
    fn scenario(&self, py: Python<'_>) -> Py<Scenario> {
        self.scenario.clone_ref(py)
    }

    /// Motions at the ends of periods in each of which a torque is held: from x, (…, 4n), under u_m, (…, T, n), to (…, T, 4n). `first` counts the
    /// periods since the run began, which pushes go by, one number or (…); NaN from where a motion cannot be integrated on. A batch is done on all cores.
    #[pyo3(signature = (x, u_m, *, first = None, period = None))]
    fn roll<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        u_m: &Bound<'py, PyAny>,
        first: Option<&Bound<'py, PyAny>>,
        period: Option<f64>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.driven.joints();
        let (x, u_m) = (Numbers::new("x", x)?, Numbers::new("u_m", u_m)?);
        let batch = x.batch(4 * n, MOTION)?;
        let mut axes = u_m.batch(n, "u_m, a number per joint")?;
        let Some(periods) = axes.pop().filter(|_| axes == batch) else {
            let expected: Vec<_> = batch.iter().map(|axis| format!("{axis}, ")).collect();
            return Err(PyValueError::new_err(format!(
                "u_m: expected ({}T, {n}), torques for T periods of each motion",
                expected.concat()
            )));
        };
        let period = period.unwrap_or(self.period);
        if !(period > 0.0 && period <= 1.0) {
            return Err(PyValueError::new_err(format!("period is {period} s, must be > 0 and at most 1")));
        }
        let (starts, torques) = (x.slice()?, u_m.slice()?);
        let firsts = Self::firsts(first, &batch)?;
        let mut found = zeros((batch.iter().product::<usize>() * periods).saturating_mul(4 * n))?;
        if !found.is_empty() {
            let many = found.len() > MANY * 4 * n;
            let roll = |progress: Progress<'_>| {
                let rows =
                    starts.par_chunks_exact(4 * n).zip(torques.par_chunks_exact(periods * n)).zip(firsts);
                rows.zip(found.par_chunks_exact_mut(periods * 4 * n)).try_for_each(
                    |(((x, u_m), first), motions)| {
                        // What it breaks off raises a KeyboardInterrupt.
                        if progress(0.0).is_continue() {
                            motions.copy_from_slice(&self.driven.motion(x, first, period, u_m)?);
                        }
                        Ok(())
                    },
                )
            };
            let rolled = if many { watched(py, None, roll)? } else { py.detach(|| roll(&unwatched)) };
            rolled.map_err(mismatch)?;
        }
        shaped(py, found, &batch, &[periods, 4 * n])
    }

    fn __repr__(&self) -> String {
        format!("Plant({}: {} joints)", self.scenario.get().loaded.name, self.driven.joints())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (Py<Scenario>,)) {
        (slf.get_type().into_any(), (slf.get().scenario(slf.py()),))
    }
}

impl Plant {
    /// Periods since the run began, for each of a batch.
    fn firsts(given: Option<&Bound<'_, PyAny>>, batch: &[usize]) -> PyResult<Vec<u64>> {
        let count: usize = batch.iter().product();
        let Some(given) = given else { return Ok(vec![0; count]) };
        let numbers = Numbers::new("first", given)?;
        let whole = |&x: &f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "looked at")]
            if x >= 0.0 && x < 2f64.powi(53) && x.fract() == 0.0 { Ok(x as u64) } else { Err(x) }
        };
        let all: Result<Vec<u64>, f64> = numbers.slice()?.iter().map(whole).collect();
        let all =
            all.map_err(|x| PyValueError::new_err(format!("first is {x}, must be a count of periods")))?;
        match &*all {
            [one] if numbers.axes().is_empty() => Ok(vec![*one; count]),
            _ if numbers.axes() == batch => Ok(all),
            _ => {
                let (own, expected) = (shape(numbers.axes()), shape(batch));
                Err(PyValueError::new_err(format!("first: shape {own}; expected one number, or {expected}")))
            }
        }
    }
}
