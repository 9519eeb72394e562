//! Robots.

use std::path::PathBuf;
use std::sync::Arc;

use flexure::files::Bundle;
use flexure::robot::{Arm, PortHamiltonian, Robot as Loaded, overview};
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{Argument, Numbers, constant, in_pieces, shape, shaped, together, zeros};
use crate::documents::document;
use crate::failure::{documents, mismatch, raised, refused, warn};
use crate::scenario::{Scenario, changed, hashed, outside};

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// (q_l, q_m, dq_l, dq_m), the order of the trace.
pub const MOTION: &str = "(q_l, q_m, dq_l, dq_m)";

/// A flexible-joint robot: links, and a motor and a spring for each of its joints.
#[pyclass(frozen, module = "flexure")]
pub struct Robot {
    pub loaded: Arc<Loaded>,
    arm: Box<dyn Arm>,
    source: Source,
}

/// What a robot was read from.
pub enum Source {
    /// A file, with those that it names.
    File(Bundle),
    /// It is that of a scenario.
    Scenario(Py<Scenario>),
}

impl Robot {
    pub fn of(py: Python<'_>, loaded: Loaded, source: Source) -> PyResult<Self> {
        let arm = loaded.arm().map_err(|problems| raised(py, &problems))?;
        Ok(Self { loaded: Arc::new(loaded), arm, source })
    }

    fn read(py: Python<'_>, bundle: Bundle) -> PyResult<Self> {
        let loaded = Loaded::of(&bundle).map_err(|problems| raised(py, &problems))?;
        Self::of(py, loaded, Source::File(bundle))
    }
}

/// Arguments of n numbers each, with a batch before, and what `each` makes of one after the other: `last` axes of each.
fn each<'py>(
    py: Python<'py>,
    arguments: &[Argument<'_, 'py>],
    last: &[usize],
    each: impl Fn(&[&[f64]], &mut [f64]) -> Result<(), flexure::robot::Mismatch> + Sync,
) -> PyResult<Array<'py>> {
    let (read, batch) = together(py, arguments)?;
    let slices: Vec<&[f64]> = read.iter().map(Numbers::slice).collect::<PyResult<_>>()?;
    let counts: Vec<usize> = arguments.iter().map(|(_, _, count, _)| *count).collect();
    let size: usize = last.iter().product();
    let many: usize = batch.iter().product();
    let mut found = zeros(many.saturating_mul(size))?;
    in_pieces(py, &mut found, size, |first, found| {
        let mut row: Vec<&[f64]> = Vec::with_capacity(slices.len());
        for (k, found) in (first..).zip(found.chunks_exact_mut(size)) {
            row.clear();
            row.extend(slices.iter().zip(&counts).map(|(all, count)| &all[k * count..(k + 1) * count]));
            each(&row, found)?;
        }
        Ok(())
    })?;
    shaped(py, found, &batch, last)
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (path_or_name, *, allow_outside = false))]
    fn new(py: Python<'_>, path_or_name: PathBuf, allow_outside: bool) -> PyResult<Self> {
        let read = Loaded::bundled(&path_or_name.to_string_lossy(), outside(allow_outside));
        let (loaded, bundle) = read.map_err(|problems| raised(py, &problems))?;
        warn(py, &loaded.warnings, 1)?;
        Self::of(py, loaded, Source::File(bundle))
    }

    /// Its name, as in its file.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.name
    }

    /// Names of its moving joints, in the order of everything that is given per joint.
    #[getter]
    fn joints(&self) -> Vec<&str> {
        self.loaded.joints.iter().map(|joint| &*joint.name).collect()
    }

    /// How many joints move.
    fn __len__(&self) -> usize {
        self.loaded.joint_count()
    }

    /// Joint stiffness K, N m/rad.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant(py, &self.loaded.stiffness)
    }

    /// Motor inertia M_m on the link side of the gear, kg m².
    #[getter]
    fn motor_inertia<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant(py, &self.loaded.motor_inertia)
    }

    /// Link damping D_l, N m s/rad.
    #[getter]
    fn link_damping<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant(py, &self.loaded.link_damping)
    }

    /// Motor damping D_m, N m s/rad.
    #[getter]
    fn motor_damping<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant(py, &self.loaded.motor_damping)
    }

    /// What its joints must not exceed: arrays torque (N m), velocity (rad/s), lower and upper (rad); infinite for no limit.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        let limits = &self.loaded.limits;
        for (key, numbers) in [
            ("torque", &limits.torque),
            ("velocity", &limits.velocity),
            ("lower", &limits.lower),
            ("upper", &limits.upper),
        ] {
            found.set_item(key, constant(py, numbers)?)?;
        }
        Ok(found)
    }

    /// What is suspicious in its file.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        documents(py, self.loaded.warnings.iter())
    }

    /// A dict for each joint: stiffness, inertias, resonance in Hz, limits, as `robot` of `flexure check --json`.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &overview(&self.loaded).map_err(|problems| raised(py, &problems))?)
    }

    /// Mass matrix of the links M_l(q_l), kg m²: (…, n) → (…, n, n).
    fn mass_matrix<'py>(&self, py: Python<'py>, q_l: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let n = self.arm.joints();
        each(py, &[("q_l", q_l, n, "q_l, a number per joint")], &[n, n], |x, mass| {
            self.arm.mass_matrix(x[0], mass)
        })
    }

    /// What the links ask of their springs, M_l ddq_l + C dq_l + g, N m: three arrays (…, n) → (…, n).
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q_l: &Bound<'py, PyAny>,
        dq_l: &Bound<'py, PyAny>,
        ddq_l: &Bound<'py, PyAny>,
    ) -> PyResult<Array<'py>> {
        let n = self.arm.joints();
        let arguments = [
            ("q_l", q_l, n, "q_l, a number per joint"),
            ("dq_l", dq_l, n, "dq_l, a number per joint"),
            ("ddq_l", ddq_l, n, "ddq_l, a number per joint"),
        ];
        each(py, &arguments, &[n], |x, torque| self.arm.inverse_dynamics(x[0], x[1], x[2], torque))
    }

    /// Accelerations of links and motors, rad/s², of a robot that moves as x under motor torques u_m: (…, 4n), (…, n) → (…, 2n).
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        u_m: &Bound<'py, PyAny>,
    ) -> PyResult<Array<'py>> {
        let n = self.arm.joints();
        let arguments = [("x", x, 4 * n, MOTION), ("u_m", u_m, n, "u_m, a number per joint")];
        each(py, &arguments, &[2 * n], |x, a| self.arm.forward_dynamics(x[0], x[1], a))
    }

    /// Total energy, J: links and motors in motion, gravity and springs: (…, 4n) → (…).
    fn energy<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let n = self.arm.joints();
        let found = each(py, &[("x", x, 4 * n, MOTION)], &[1], |x, energy| {
            energy[0] = self.arm.energy(x[0])?;
            Ok(())
        })?;
        // A number of one motion, an array of a batch.
        found.get_item((pyo3::types::PyEllipsis::get(py), 0))?.get_item(PyTuple::empty(py))
    }

    /// Matrices of the port-Hamiltonian form, each (…, n, n): a dict with S (skew), E = S − ½ dM/dt and dM, N m s/rad and kg m²/s.
    fn matrices<'py>(
        &self,
        py: Python<'py>,
        q_l: &Bound<'py, PyAny>,
        dq_l: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let n = self.arm.joints();
        let arguments =
            [("q_l", q_l, n, "q_l, a number per joint"), ("dq_l", dq_l, n, "dq_l, a number per joint")];
        let all = each(py, &arguments, &[3, n, n], |x, found| {
            let (skew, rest) = found.split_at_mut(n * n);
            let (workless, mass_rate) = rest.split_at_mut(n * n);
            self.arm.matrices(x[0], x[1], PortHamiltonian { skew, workless, mass_rate })
        })?;
        let matrices = PyDict::new(py);
        let (rest, whole) = (pyo3::types::PyEllipsis::get(py), pyo3::types::PySlice::full(py));
        for (k, key) in ["S", "E", "dM"].into_iter().enumerate() {
            matrices.set_item(key, all.get_item((rest, k, &whole, &whole))?)?;
        }
        Ok(matrices)
    }

    /// Torque of the links along a trajectory and its first two derivatives in time, exactly: from positions and their first four
    /// derivatives, (…, 5, n), torques in N m, N m/s, N m/s², (…, 3, n).
    fn torque_derivatives<'py>(&self, py: Python<'py>, q_l: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let n = self.arm.joints();
        let numbers = Numbers::new("q_l", q_l)?;
        let mut batch = numbers.axes().to_vec();
        if batch.pop() != Some(n) || batch.pop() != Some(5) {
            return Err(PyValueError::new_err(format!(
                "q_l: shape {}; expected (…, 5, {n}) = (q_l, dq_l, ddq_l, …) up to the fourth derivative",
                shape(numbers.axes())
            )));
        }
        let (all, many) = (numbers.slice()?, batch.iter().product::<usize>());
        let mut found = zeros(many.saturating_mul(3 * n))?;
        for (q_l, torque) in all.chunks_exact(5 * n).zip(found.chunks_exact_mut(3 * n)) {
            // Coefficients are derivatives over factorials.
            let series: Vec<[f64; 5]> = (0..n)
                .map(|i| {
                    let over = [1.0, 1.0, 2.0, 6.0, 24.0];
                    std::array::from_fn(|k| q_l[k * n + i] / over[k])
                })
                .collect();
            let mut coefficients = vec![[0.0; 3]; n];
            self.arm.torque_along(&series, &mut coefficients).map_err(mismatch)?;
            for (i, [value, rate, half]) in coefficients.into_iter().enumerate() {
                (torque[i], torque[n + i], torque[2 * n + i]) = (value, rate, 2.0 * half);
            }
        }
        shaped(py, found, &batch, &[3, n])
    }

    fn __repr__(&self) -> String {
        format!("Robot({}: {})", self.loaded.name, self.joints().join(", "))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Whether files say the same.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().loaded.digest() == self.loaded.digest())
    }

    fn __hash__(&self) -> u64 {
        hashed(self.loaded.digest())
    }

    /// It goes with what stands in its files.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, robot) = (slf.py(), slf.get());
        match &robot.source {
            Source::File(bundle) => {
                let arguments = (bundle.document(), robot.loaded.digest());
                Ok((slf.get_type().getattr("_again")?, arguments.into_pyobject(py)?))
            }
            Source::Scenario(scenario) => {
                let getattr = py.import("builtins")?.getattr("getattr")?;
                Ok((getattr, (scenario.clone_ref(py), "robot").into_pyobject(py)?))
            }
        }
    }

    #[staticmethod]
    fn _again(py: Python<'_>, document: &str, digest: &str) -> PyResult<Self> {
        let bundle = Bundle::from_document(document).map_err(|problem| refused(py, &problem))?;
        let again = Self::read(py, bundle)?;
        if again.loaded.digest() == digest { Ok(again) } else { Err(changed(py, &again.loaded.name)) }
    }
}
