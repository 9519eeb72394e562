//! Scenarios.

use std::path::PathBuf;
use std::sync::Arc;

use flexure::files::{Bundle, Change, Outside, Problems, Reading};
use flexure::scenario::Scenario as Loaded;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::vector;
use crate::changes::changes;
use crate::controller::Controller;
use crate::documents::document;
use crate::failure::{documents, raised, refused, said, warn};
use crate::held::Loop;
use crate::own_law::Series;
use crate::robot::{Robot, Source};

/// A robot, what it shall do, a law, and everything between law and robot.
#[pyclass(frozen, module = "flexure")]
pub struct Scenario {
    pub loaded: Arc<Loaded>,
    pub source: Origin,
}

/// What a scenario was read from.
#[derive(Clone)]
pub struct Origin {
    /// Its path, or its name.
    pub name: String,
    pub allow_outside: bool,
    /// What stands in its files.
    pub bundle: Bundle,
}

/// What samples of a path are called in messages.
const PATH: &str = "the path in Python.csv";

/// A function and its arguments, by which pickle makes a scenario again.
type Again<'py> = (Bound<'py, PyAny>, (String, bool, String, String));

/// Whether files may name files outside of their folders.
pub fn outside(allowed: bool) -> Outside {
    if allowed { Outside::Allowed } else { Outside::Refused }
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (path_or_name, *, set = None, allow_outside = false))]
    fn new(
        py: Python<'_>,
        path_or_name: PathBuf,
        set: Option<&Bound<'_, PyAny>>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        let changes: Vec<Change> = changes(set)?
            .iter()
            .map(|change| Change::parse(change))
            .collect::<Result<_, _>>()
            .map_err(|problem| refused(py, &problem))?;
        let name = path_or_name.to_string_lossy().into_owned();
        let reading = Reading { outside: outside(allow_outside), changes: &changes };
        let (loaded, bundle) = Loaded::bundled(&name, reading).map_err(|problems| raised(py, &problems))?;
        warn(py, &loaded.warnings, 1)?;
        Ok(Self { loaded: Arc::new(loaded), source: Origin { name, allow_outside, bundle } })
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Whether files and changes say the same.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().loaded.digest() == self.loaded.digest())
    }

    fn __hash__(&self) -> u64 {
        hashed(&self.loaded.digest())
    }

    /// Its name: that of its file.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.name
    }

    /// The robot that its law knows.
    #[getter]
    fn robot(slf: PyRef<'_, Self>) -> PyResult<Robot> {
        let py = slf.py();
        Robot::of(py, slf.loaded.robot.clone(), Source::Scenario(slf.into()))
    }

    /// How long its runs are, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.loaded.duration
    }

    /// Time between two control instants, s.
    #[getter]
    fn control_period(&self) -> f64 {
        self.loaded.control_period
    }

    /// Seed of everything that is random in it.
    #[getter]
    fn seed(&self) -> u64 {
        self.loaded.seed
    }

    /// Numbers that no source vouches for: dicts with key, value and note.
    #[getter]
    fn assumptions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for assumed in &self.loaded.assumptions {
            let entry = PyDict::new(py);
            entry.set_item("file", &assumed.file)?;
            entry.set_item("key", &assumed.key)?;
            entry.set_item("value", &assumed.value)?;
            entry.set_item("note", &assumed.note)?;
            list.append(entry)?;
        }
        Ok(list)
    }

    /// What is suspicious in its files.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        documents(py, self.loaded.warnings.iter())
    }

    /// Where it starts: q_l, q_m in rad, dq_l, dq_m in rad/s, 4n numbers.
    #[getter]
    fn initial<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        let initial = &self.loaded.initial;
        let parts = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m];
        let numbers: Vec<f64> = parts.into_iter().flatten().copied().collect();
        vector(py, &numbers)
    }

    /// The gains of its law, a number per joint each, by their keys below `[controller]`: those of the file, or of the starting rule.
    #[getter]
    fn gains<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for (key, values) in self.loaded.controller.gains() {
            found.set_item(key, vector(py, values))?;
        }
        Ok(found)
    }

    /// Its law alone.
    fn controller(slf: PyRef<'_, Self>) -> PyResult<Controller> {
        let py = slf.py();
        Controller::open(py, slf.into())
    }

    /// Its closed loop, to be stepped; with `law`, a function of t (s), x (4n,) and the reference with four derivatives (5, n) that returns torques
    /// (n,), in the place of its own; with `shaping`, a `flexure.Shaping` in the place of that of its v-CBC law.
    #[pyo3(signature = (*, law = None, shaping = None))]
    fn open(slf: PyRef<'_, Self>, law: Option<Py<PyAny>>, shaping: Option<Series>) -> PyResult<Loop> {
        let py = slf.py();
        Loop::open(py, slf.into(), law, shaping)
    }

    /// The same with a path through samples, "t,q1,…" in lines of text, in the place of its reference.
    fn _along(&self, py: Python<'_>, samples: &str, smooth_start: Option<f64>) -> PyResult<Self> {
        let smooth_start = smooth_start
            .map_or_else(String::new, |seconds| format!(", smooth_start = {{duration = {seconds:?}}}"));
        let change = format!("reference = {{kind = \"samples\", file = \"{PATH}\"{smooth_start}}}");
        let change = Change::parse(&change).map_err(|problem| refused(py, &problem))?;
        let Origin { name, allow_outside, bundle } = &self.source;
        let bundle = bundle.with_file(PATH, samples).with(&[change]);
        let loaded = Loaded::of(&bundle).map_err(|problems| raised(py, &problems))?;
        let source = Origin { name: name.clone(), allow_outside: *allow_outside, bundle };
        Ok(Self { loaded: Arc::new(loaded), source })
    }

    /// Is the loop stable that holds its torque for a control period? A dict, as `sampled` of `flexure run --json`; None for a law in
    /// continuous time.
    fn sampled<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = py.detach(|| flexure::sampled::probe(&self.loaded));
        document(py, &found.map_err(|problems| raised(py, &problems))?)
    }

    /// What its reference uses of each limit of the robot: dicts, as `usage` of `flexure check --json`.
    fn usage<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = py.detach(|| flexure::feasible::usage(&self.loaded));
        document(py, &found.map_err(|problems| raised(py, &problems))?)
    }

    fn __repr__(&self) -> String {
        let Loaded { name, robot, duration, control_period, controller, .. } = &*self.loaded;
        format!(
            "Scenario({name}: {} with {} joints, {}, {duration} s at {control_period} s)",
            robot.name,
            robot.joint_count(),
            controller.kind()
        )
    }

    /// It goes with what stands in its files.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Again<'py>> {
        let again = slf.get_type().getattr("_again")?;
        let Origin { name, allow_outside, bundle } = &slf.get().source;
        Ok((again, (name.clone(), *allow_outside, bundle.document(), slf.get().loaded.digest())))
    }

    #[staticmethod]
    fn _again(
        py: Python<'_>,
        name: String,
        allow_outside: bool,
        document: &str,
        digest: &str,
    ) -> PyResult<Self> {
        let read = || {
            let bundle = Bundle::from_document(document)?;
            Ok((Loaded::of(&bundle)?, bundle))
        };
        let (loaded, bundle) = read().map_err(|problems: Problems| raised(py, &problems))?;
        if loaded.digest() == digest {
            Ok(Self { loaded: Arc::new(loaded), source: Origin { name, allow_outside, bundle } })
        } else {
            Err(changed(py, &loaded.name))
        }
    }
}

impl Scenario {
    /// A scenario that stands in no file of its own.
    pub fn of(bundle: Bundle) -> Result<Self, Problems> {
        let loaded = Arc::new(Loaded::of(&bundle)?);
        Ok(Self { loaded, source: Origin { name: String::new(), allow_outside: false, bundle } })
    }
}

/// Why something is not unpickled.
pub fn changed(py: Python<'_>, name: &str) -> PyErr {
    let message = format!("{name} was pickled when built-in files said something else");
    said(py, "changed", &message, "pickle it again with this version of Flexure")
}

/// A hash of a digest.
pub fn hashed(digest: &str) -> u64 {
    digest.get(..16).and_then(|first| u64::from_str_radix(first, 16).ok()).unwrap_or_default()
}

/// A scenario, or the one at a path or of a name.
pub fn given(given: &Bound<'_, PyAny>) -> PyResult<Py<Scenario>> {
    if let Ok(scenario) = given.cast::<Scenario>() {
        return Ok(scenario.clone().unbind());
    }
    Ok(given.py().get_type::<Scenario>().call1((given,))?.cast_into::<Scenario>()?.unbind())
}
