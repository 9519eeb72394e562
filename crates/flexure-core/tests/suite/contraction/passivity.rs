//! Differential passivity of systems and of their feedback interconnections: parts of an electric circuit.

use flexure_core::contraction::{
    Both, ControlSystem, Interconnection, MatrixField, differential_passivity, measure_2, passivity_matrices,
    storage,
};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Over, Piecewise, Scalar};

use crate::common::Numbers;

/// A coil of inductance L in a row with a resistor of which the voltage is R i + i³: λ̇ = −R i − i³ + u, y = i = λ/L.
struct Coil {
    inductance: f64,
    resistance: f64,
}

/// A capacitor beside a leak that saturates: q̇ = −G v − tanh v + u, y = v = q/C.
struct Capacitor {
    capacitance: f64,
    leak: f64,
}

/// A coil whose iron saturates: λ̇ = −R i + u, y = i = λ + λ³/3.
struct Iron {
    resistance: f64,
}

macro_rules! one_port {
    ($system:ty, |$own:ident, $x:ident| $drift:expr, $output:expr) => {
        impl<C: Scalar> ControlSystem<C, 1, 1> for $system {
            fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Vector<T, 1> {
                let ($own, $x) = (self, x[0]);
                Vector([$drift])
            }
            fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, 1>, _: T) -> Matrix<T, 1, 1> {
                Matrix::identity()
            }
            fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Vector<T, 1> {
                let ($own, $x) = (self, x[0]);
                Vector([$output])
            }
        }
    };
}

one_port!(Coil, |coil, flux| -coil.drop(coil.current(flux)), coil.current(flux));
one_port!(Capacitor, |c, charge| -c.leaking(c.voltage(charge)), c.voltage(charge));
one_port!(Iron, |iron, flux| -iron.current(flux) * T::from_f64(iron.resistance), iron.current(flux));

impl Coil {
    fn current<T: Scalar>(&self, flux: T) -> T {
        flux / T::from_f64(self.inductance)
    }
    fn drop<T: Scalar>(&self, current: T) -> T {
        current * T::from_f64(self.resistance) + current.square() * current
    }
    fn metric(&self) -> Matrix<f64, 1, 1> {
        Matrix([[1.0 / self.inductance]])
    }
}

impl Capacitor {
    fn voltage<T: Scalar>(&self, charge: T) -> T {
        charge / T::from_f64(self.capacitance)
    }
    fn leaking<T: Scalar>(&self, voltage: T) -> T {
        voltage * T::from_f64(self.leak) + voltage.tanh()
    }
    fn metric(&self) -> Matrix<f64, 1, 1> {
        Matrix([[1.0 / self.capacitance]])
    }
}

impl Iron {
    fn current<T: Scalar>(&self, flux: T) -> T {
        flux + flux.square() * flux * T::from_ratio(1, 3)
    }
}

/// The slope of the current: the only metric that fits the port of an iron coil.
impl MatrixField<f64, 1> for Iron {
    fn at<T: Over<f64> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Matrix<T, 1, 1> {
        Matrix([[T::ONE + x[0].square()]])
    }
}

const COIL: Coil = Coil { inductance: 0.4, resistance: 0.3 };
const CAPACITOR: Capacitor = Capacitor { capacitance: 0.2, leak: 0.1 };

fn smallest<const N: usize>(a: &Matrix<f64, N, N>) -> f64 {
    -measure_2(&-*a)
}

/// Ẇ = δyᵀδu − (R + 3 i²) δi²: the closed form, the balance and the matrices agree.
#[test]
fn a_coil_dissipates_in_its_resistor() {
    let mut r = Numbers(1);
    for _ in 0..20 {
        let [x, dx, u, du]: [Vector<f64, 1>; 4] = core::array::from_fn(|_| r.vector(2.0));
        let balance =
            differential_passivity::<f64, f64, 1, 1>(&COIL, &COIL.metric(), &[x, dx], &[u, du], 0.0);
        let (i, di) = (x[0] / 0.4, dx[0] / 0.4);
        let expected = di * du[0] - (0.3 + 3.0 * i * i) * di * di;
        assert!((balance.rate - expected).abs() < 1e-13 * expected.abs().max(1.0));
        assert!((balance.supplied - di * du[0]).abs() < 1e-14);
        assert!((balance.storage - 0.5 * dx[0] * dx[0] / 0.4).abs() < 1e-14);
        assert!(balance.rate <= balance.supplied);

        let matrices = passivity_matrices::<f64, f64, 1, 1>(&COIL, &COIL.metric(), &x, &u, 0.0);
        assert!(matrices.mismatch[(0, 0)].abs() < 1e-15);
        let form = balance.supplied - 0.5 * matrices.dissipation[(0, 0)] * dx[0] * dx[0];
        assert!((balance.rate - form).abs() < 1e-13 * balance.rate.abs().max(1.0));
    }
}

/// Without resistance and leak nothing is lost: differentially lossless.
#[test]
fn without_resistors_the_balance_is_an_equality() {
    let circuit: Interconnection<_, _, f64, 1, 1, 1> = Interconnection {
        first: Iron { resistance: 0.0 },
        second: Iron { resistance: 0.0 },
        coupling: Matrix::identity(),
    };
    // Two linear elements: at zero flux the slope of the current is 1.
    let metric = Matrix::<f64, 2, 2>::identity();
    let zero = Vector([0.0; 2]);
    let matrices = passivity_matrices::<f64, f64, 2, 2>(&circuit, &metric, &zero, &zero, 0.0);
    assert_eq!(matrices.dissipation.0, [[0.0; 2]; 2]);
    assert_eq!(matrices.mismatch.0, [[0.0; 2]; 2]);
}

/// An iron coil is passive, with the stored energy, but not differentially passive: under enough voltage the slope of its metric grows faster
/// than its resistor dissipates.
#[test]
fn passive_is_less_than_differentially_passive() {
    let iron = Iron { resistance: 0.3 };
    for flux in [-2.0, -0.5, 0.3, 1.5] {
        let (x, u) = (Vector([flux]), Vector([40.0 * f64::signum(flux)]));
        // H = ∫ i dλ has Ḣ = i λ̇ = −R i² + i u.
        let (rate, i) = (ControlSystem::<f64, 1, 1>::rate_under(&iron, &x, &u, 0.0)[0], iron.current(flux));
        assert!(i * rate <= i * u[0]);
        let matrices = passivity_matrices::<f64, f64, 1, 1>(&iron, &iron, &x, &u, 0.0);
        // Q = −(2 λ λ̇ − 2 R (1 + λ²)²).
        let slope = 1.0 + flux * flux;
        let expected = 2.0 * (0.3 * slope * slope - flux * rate);
        assert!((matrices.dissipation[(0, 0)] - expected).abs() < 1e-12 * expected.abs().max(1.0));
        assert!(matrices.mismatch[(0, 0)].abs() < 1e-15);
        assert!(matrices.dissipation[(0, 0)] < 0.0, "{flux}: {matrices:?}");
    }
}

/// The coil and the capacitor in feedback, through a transformer of any ratio: an RLC circuit. Its storage is the sum of theirs, its supply
/// that of the outer ports, its dissipation theirs.
#[test]
fn feedback_adds_storages() {
    let mut r = Numbers(2);
    for ratio in [1.0, -0.6, 3.0] {
        let circuit: Interconnection<_, _, f64, 1, 1, 1> =
            Interconnection { first: COIL, second: CAPACITOR, coupling: Matrix([[ratio]]) };
        let metric: Both<_, _, 1, 1> = Both(COIL.metric(), CAPACITOR.metric());
        for _ in 0..20 {
            let [x, dx, e, de]: [Vector<f64, 2>; 4] = core::array::from_fn(|_| r.vector(2.0));
            let whole = differential_passivity::<f64, f64, 2, 2>(&circuit, &metric, &[x, dx], &[e, de], 0.0);
            let one = |x: &Vector<f64, 2>, i: usize| Vector([x[i]]);
            let stored = storage::<f64, f64, 1>(&COIL.metric(), &one(&x, 0), &one(&dx, 0), 0.0)
                + storage::<f64, f64, 1>(&CAPACITOR.metric(), &one(&x, 1), &one(&dx, 1), 0.0);
            assert!((whole.storage - stored).abs() < 1e-13 * stored.max(1.0));

            let (i, di, v, dv) = (x[0] / 0.4, dx[0] / 0.4, x[1] / 0.2, dx[1] / 0.2);
            assert!((whole.supplied - (di * de[0] + dv * de[1])).abs() < 1e-12);
            let lost = (0.3 + 3.0 * i * i) * di * di + (0.1 + 1.0 / v.cosh().powi(2)) * dv * dv;
            let expected = whole.supplied - lost;
            // The coupling cancels: what is left of it is rounding of ratio δi δv.
            assert!((whole.rate - expected).abs() < 1e-13 * (lost + (ratio * di * dv).abs() + 1.0));

            let matrices = passivity_matrices::<f64, f64, 2, 2>(&circuit, &metric, &x, &e, 0.0);
            assert!(smallest(&matrices.dissipation) > 0.0);
            assert!(matrices.mismatch.0.as_flattened().iter().all(|m| m.abs() < 1e-15));
        }
    }
}

/// Its equations are those of the circuit: L di/dt = −R i − i³ − v + e_1, C dv/dt = −G v − tanh v + i + e_2.
#[test]
fn the_standard_feedback_has_the_papers_signs() {
    let circuit: Interconnection<_, _, f64, 1, 1, 1> =
        Interconnection { first: COIL, second: CAPACITOR, coupling: Matrix::identity() };
    let (i, v, e) = (0.7, -0.4, Vector([0.2, 0.5]));
    let found = ControlSystem::<f64, 2, 2>::rate_under(&circuit, &Vector([0.4 * i, 0.2 * v]), &e, 0.0);
    let expected = [-0.3 * i - i * i * i - v + e[0], -0.1 * v - f64::tanh(v) + i + e[1]];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15);
    }
}
