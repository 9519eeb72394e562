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

/// A coil whose iron saturates: λ̇ = −R i + u, y = i = λ + b λ³.
struct Iron {
    resistance: f64,
    bend: f64,
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
        flux + flux.square() * flux * T::from_f64(self.bend)
    }
}

/// The slope of the current: the only metric that fits the port of an iron coil.
impl MatrixField<f64, 1> for Iron {
    fn at<T: Over<f64> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Matrix<T, 1, 1> {
        Matrix([[T::ONE + x[0].square() * T::from_f64(3.0 * self.bend)]])
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
        first: Iron { resistance: 0.0, bend: 0.0 },
        second: Iron { resistance: 0.0, bend: 0.0 },
        coupling: Matrix::identity(),
    };
    // Two linear elements, of which the slope of the current is 1.
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
    let iron = Iron { resistance: 0.3, bend: 0.5 };
    for flux in [-2.0, -0.5, 0.3, 1.5] {
        let (x, u) = (Vector([flux]), Vector([40.0 * f64::signum(flux)]));
        // H = ∫ i dλ has Ḣ = i λ̇ = −R i² + i u.
        let (rate, i) = (ControlSystem::<f64, 1, 1>::rate_under(&iron, &x, &u, 0.0)[0], iron.current(flux));
        assert!(i * rate <= i * u[0]);
        let matrices = passivity_matrices::<f64, f64, 1, 1>(&iron, &iron, &x, &u, 0.0);
        // Π = 1 + 3 b λ², and Q = −(Π̇ − 2 R Π²) with Π̇ = 6 b λ λ̇.
        let slope = 1.0 + 1.5 * flux * flux;
        let expected = 0.6 * slope * slope - 3.0 * flux * rate;
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

/// Lemma dPBC for any structure: δx̃̇ = (Ξ − Υ) Π δx̃ + Ψ δu, δỹ = Ψᵀ Π δx̃ with Ξ skew, Π positive and Υ any square matrix.
struct Lemma {
    Xi: Matrix<f64, 3, 3>,
    Upsilon: Matrix<f64, 3, 3>,
    Pi: Matrix<f64, 3, 3>,
    Psi: Matrix<f64, 3, 2>,
}

impl<C: Scalar> ControlSystem<C, 3, 2> for Lemma {
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 3>, _: T) -> Vector<T, 3> {
        ((self.Xi - self.Upsilon) * self.Pi).map(T::from_f64) * *x
    }
    fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, 3>, _: T) -> Matrix<T, 3, 2> {
        self.Psi.map(T::from_f64)
    }
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 3>, _: T) -> Vector<T, 2> {
        (self.Psi.transpose() * self.Pi).map(T::from_f64) * *x
    }
}

/// Its port fits, and Q is Π (Υ + Υᵀ) Π: passive where that is positive semidefinite and not where it is not, whatever Ξ is.
#[test]
fn the_structure_of_the_lemma_is_differentially_passive() {
    let mut r = Numbers(3);
    let random =
        |r: &mut Numbers| -> Matrix<f64, 3, 3> { Matrix(core::array::from_fn(|_| r.vector::<3>(1.0).0)) };
    let (mut passive, mut active) = (0, 0);
    for _ in 0..50 {
        let (a, b) = (random(&mut r), random(&mut r));
        let system = Lemma {
            Xi: a - a.transpose(),
            Upsilon: random(&mut r) + Matrix::identity().scaled(0.8),
            Pi: b.transpose() * b + Matrix::identity(),
            Psi: Matrix(core::array::from_fn(|_| r.vector::<2>(1.0).0)),
        };
        let (x, u): (Vector<f64, 3>, Vector<f64, 2>) = (r.vector(1.0), r.vector(1.0));
        let matrices = passivity_matrices::<f64, f64, 3, 2>(&system, &system.Pi, &x, &u, 0.0);
        let expected = system.Pi * (system.Upsilon + system.Upsilon.transpose()) * system.Pi;
        let difference = matrices.dissipation - expected;
        assert!(difference.0.as_flattened().iter().all(|d| d.abs() < 1e-12));
        assert!(matrices.mismatch.0.as_flattened().iter().all(|m| m.abs() < 1e-13));
        // Congruent matrices have the same signs.
        let damped = smallest(&(system.Upsilon + system.Upsilon.transpose())) > 0.0;
        assert_eq!(damped, smallest(&matrices.dissipation) > 0.0);
        (passive, active) = if damped { (passive + 1, active) } else { (passive, active + 1) };
    }
    assert!(passive > 5 && active > 5, "{passive} and {active}");
}

/// The converse: what is differentially passive in a constant metric is incrementally passive, with ½ (x_1 − x_2)ᵀ Π (x_1 − x_2) as storage, and so
/// passive about each of its rests.
#[test]
fn differentially_passive_is_passive() {
    let mut r = Numbers(4);
    for _ in 0..50 {
        let [x_1, x_2, u_1, u_2]: [Vector<f64, 1>; 4] = core::array::from_fn(|_| r.vector(2.0));
        let rate = |x, u| ControlSystem::<f64, 1, 1>::rate_under(&COIL, x, u, 0.0)[0];
        let output = |x| ControlSystem::<f64, 1, 1>::output(&COIL, x, 0.0)[0];
        let stored = (x_1[0] - x_2[0]) / COIL.inductance * (rate(&x_1, &u_1) - rate(&x_2, &u_2));
        assert!(stored <= (output(&x_1) - output(&x_2)) * (u_1[0] - u_2[0]) + 1e-13);
    }
}
