//! The three steps of v-CBC on an electric circuit, a port-Hamiltonian system that is no mechanical one.

use flexure_core::contraction::{
    PortHamiltonian, PortSystem, Together, VirtualSystem, generalised_jacobian, measure_2, measure_2_margins,
    over_pieces,
};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Dual, Interval, Over, Piecewise, Scalar};

use super::{norm, solution};
use crate::common::Numbers;

/// A coil, with a resistor that heats up, that charges a capacitor whose voltage hardens, with a leak: x = (λ, q), u the voltage of the source.
struct Circuit<C> {
    inductance: C,
    capacitance: C,
    hardening: C,
}

impl<C: Scalar> Circuit<C> {
    fn voltage<T: Over<C>>(&self, charge: T) -> T {
        charge.scale(self.capacitance.recip()) + (charge.square() * charge).scale(self.hardening)
    }
    /// Resistance of the coil at its current, 0.5 + i².
    fn resistance<T: Over<C>>(&self, flux: T) -> T {
        T::from_f64(0.5) + flux.scale(self.inductance.recip()).square()
    }
    /// Conductance of the leak at its voltage, 0.1 + v²/10.
    fn leak<T: Over<C>>(&self, charge: T) -> T {
        (T::ONE + self.voltage(charge).square()) * T::from_ratio(1, 10)
    }
}

impl<C: Scalar> PortHamiltonian<C, 2, 1> for Circuit<C> {
    fn hamiltonian<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> T {
        let magnetic = x[0].square().scale(self.inductance.recip());
        let electric = x[1].square().scale(self.capacitance.recip());
        let hard = x[1].square().square().scale(self.hardening);
        (magnetic + electric) * T::from_f64(0.5) + hard * T::from_f64(0.25)
    }
    fn interconnection<T: Over<C> + Piecewise>(&self, _: &Vector<T, 2>, _: T) -> Matrix<T, 2, 2> {
        Matrix([[T::ZERO, -T::ONE], [T::ONE, T::ZERO]])
    }
    fn dissipation<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Matrix<T, 2, 2> {
        Matrix::diagonal(&Vector([self.resistance(x[0]), self.leak(x[1])]))
    }
    fn input<T: Over<C> + Piecewise>(&self, _: &Vector<T, 2>, _: T) -> Matrix<T, 2, 1> {
        Matrix([[T::ONE], [T::ZERO]])
    }
}

/// The charge shall follow q_d(t) = 0.3 sin 2t. The virtual circuit keeps resistance and leak of the real one.
struct Charger<C> {
    circuit: PortSystem<Circuit<C>>,
    /// α [1/s], what the charge is pulled back with.
    pull: C,
    /// Π [V/C].
    metric: C,
    /// K [Ω], what is added to the resistance.
    damping: C,
}

impl<C: Scalar> Charger<C> {
    fn target<T: Scalar>(t: T) -> T {
        (t + t).sin() * T::from_f64(0.3)
    }
    /// i_r = q̇_d + G(x) v(q_v) − α (q_v − q_d), the current that lets the charge error decay.
    fn current<T: Over<C>>(&self, q_v: T, q: T, t: T) -> T {
        let circuit = &self.circuit.0;
        let q_d = Self::target(Dual::<T, 1>::variable(t, 0));
        q_d.gradient[0] + circuit.leak(q) * circuit.voltage(q_v) - (q_v - q_d.value).scale(self.pull)
    }
    /// (q̃, σ) = (q_v − q_d, λ_v − L i_r).
    fn errors<T: Over<C>>(&self, x_v: &Vector<T, 2>, x: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        let reference = self.current(x_v[1], x[1], t).scale(self.circuit.0.inductance);
        Vector([x_v[1] - Self::target(t), x_v[0] - reference])
    }
}

impl<C: Scalar> VirtualSystem<C, 2, 1> for Charger<C> {
    type Actual = PortSystem<Circuit<C>>;
    fn actual(&self) -> &PortSystem<Circuit<C>> {
        &self.circuit
    }
    fn virtual_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, 2>,
        x: &Vector<T, 2>,
        u_v: &Vector<T, 1>,
        t: T,
    ) -> Vector<T, 2> {
        let circuit = &self.circuit.0;
        let structure = circuit.interconnection(x, t) - circuit.dissipation(x, t);
        structure * circuit.gradient(x_v, t) + circuit.input(x, t) * *u_v
    }
    fn virtual_output<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, 2>,
        _: &Vector<T, 2>,
        _: T,
    ) -> Vector<T, 1> {
        Vector([x_v[0].scale(self.circuit.0.inductance.recip())])
    }
    fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 2>, x: &Vector<T, 2>, t: T) -> Vector<T, 1> {
        let circuit = &self.circuit.0;
        let moving = |x_v: &Vector<T, 2>| {
            let charging = self.virtual_rate(x_v, x, &Vector::ZERO, t)[1];
            Dual { value: x_v[1], gradient: [charging] }
        };
        let reference = self.current(moving(x_v), moving(x), Dual::<T, 1>::variable(t, 0));
        let [e, sigma] = self.errors(x_v, x, t).0;
        let own =
            reference.gradient[0].scale(circuit.inductance) + circuit.resistance(x[0]) * reference.value;
        let back = sigma.scale(self.damping / circuit.inductance) + e.scale(self.metric);
        Vector([own + circuit.voltage(x_v[1]) - back])
    }
    fn reference<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        let q_d = Self::target(t);
        Vector([self.current(q_d, x[1], t).scale(self.circuit.0.inductance), q_d])
    }
    /// √diag(Π, 1/L) ∂(q̃, σ)/∂x_v.
    fn weight<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 2>, x: &Vector<T, 2>, t: T) -> Matrix<T, 2, 2> {
        let variables = Vector::from_fn(|j| Dual::<T, 2>::variable(x_v[j], j));
        let errors = self.errors(&variables, &x.map(Dual::constant), Dual::<T, 2>::constant(t));
        let roots = [self.metric, self.circuit.0.inductance.recip()].map(C::sqrt);
        Matrix::from_fn(|i, j| errors[i].gradient[j].scale(roots[i]))
    }
}

fn charger<C: Scalar>(f: fn(f64) -> C) -> Charger<C> {
    let circuit = Circuit { inductance: f(0.5), capacitance: f(0.8), hardening: f(2.0) };
    Charger { circuit: PortSystem(circuit), pull: f(4.0), metric: f(3.0), damping: f(2.0) }
}

/// A port-Hamiltonian system that is no mechanical one: the same three steps, the same checks. The rate is the smaller of α = 4 and
/// (R + K)/L ≥ 5.
#[test]
fn a_circuit_is_an_instance() {
    let (mut r, design) = (Numbers(2), charger(|x| x));
    for _ in 0..20 {
        let (x, x_v, t): (Vector<f64, 2>, Vector<f64, 2>, f64) =
            (r.vector(1.0), r.vector(1.0), 3.0 * r.next());
        let defect = design.actual_defect(&x, &r.vector(5.0), t);
        assert!(norm(&defect.rate) < 1e-14 && norm(&defect.output) < 1e-15);
        assert!(norm(&design.reference_defect(&x, t)) < 1e-13);
        let now = design.along(x, t);
        let mu = measure_2(&generalised_jacobian::<f64, f64, 2>(&now, &now, &x_v, 0.0));
        assert!((mu + 4.0).abs() < 1e-12, "{mu}");
    }
    let start = Vector([0.5, -0.6, -0.5, 0.4]);
    let end = solution(&Together::<_, 2, 1>(&design), start, 1e-3, 4000);
    let (x, x_v) = (Vector([end[0], end[1]]), Vector([end[2], end[3]]));
    let target = design.reference(&x, 4.0);
    // e^−16 of errors of the size 1, in weights that differ by a factor of 3.
    assert!(norm(&(x - target)) < 1e-6 && norm(&(x_v - target)) < 1e-6, "{x:?} {x_v:?} {target:?}");
}

/// For all states, real and virtual, of a box, and all times of a quarter of a second.
#[test]
fn the_circuit_is_certified_over_a_box() {
    let design = charger(Interval::point);
    let side = |low: f64, high: f64| Interval::new(low, high).expect("an interval");
    let region = Vector([side(-0.1, 0.1), side(-0.1, 0.1), side(-0.1, 0.1), side(0.0, 0.25)]);
    let least = over_pieces(&region, 8, &|piece| {
        let [flux, charge, virtual_charge, t] = piece.0;
        let x_v = Vector([side(-0.2, 0.2), virtual_charge]);
        let now = design.along(Vector([flux, charge]), t);
        let jacobian = generalised_jacobian::<Interval, Interval, 2>(&now, &now, &x_v, Interval::ZERO);
        let margins = measure_2_margins(&jacobian, Interval::point(-3.0));
        margins.iter().reduce(Interval::min).expect("two pivots")
    });
    assert!(least.lo() > 0.0, "{least:?}");
}

/// A law with a wrong sign is told from a right one.
#[test]
fn a_wrong_design_is_seen() {
    let x = Vector([0.3, -0.2]);
    let slow = Charger { pull: -1.0, ..charger(|x| x) };
    let now = slow.along(x, 0.4);
    assert!(measure_2(&generalised_jacobian::<f64, f64, 2>(&now, &now, &x, 0.0)) > 0.99);
}
