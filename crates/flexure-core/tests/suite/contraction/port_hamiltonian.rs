//! Port-Hamiltonian forms: of the virtual system, of its variation, and of the closed loops that keep it; and which maps are passive.

use flexure_core::contraction::{
    ClosedLoop, ControlSystem, Dynamics, ErrorHamiltonian, ErrorLoop, Hessian, MatrixField, PortHamiltonian,
    PortSystem, Refusal, VirtualRobot, incremental_passivity, keeps_hamiltonian_structure,
    keeps_variational_structure, measure_2, passivity_matrices, slope_inequality,
};
use flexure_core::control::{CoupledTanh, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion, State};
use flexure_core::scalar::{Over, Scalar};
use flexure_core::virtual_system::virtual_dynamics;

use super::matrices_are_close;
use crate::common::{Numbers, branched, close, flexible, moving, planar};

/// (J_v − R_v) ∂H_v + g u is the virtual system, J_v is skew, and its variation is (J_v − R_v) ∂²H_v δx_v + g δu, of the form of lemma dPBC with
/// R_v in place of Υ. The balance of H_v: what −½ Ṁ supplies goes into ∂H_v/∂t, so that only the dampers are left, for any u.
fn virtual_form<L: Links<f64, N>, const N: usize, const D: usize>(links: L, r: &mut Numbers) {
    let robot = flexible(links, r);
    let motion = r.motion(1.5);
    let form = VirtualRobot { robot: &robot, motion };
    let (x_v, u): (Vector<f64, D>, Vector<f64, N>) = (r.vector(1.0), r.vector(10.0));
    let system = PortSystem(&form);
    let rate = system.rate_under(&x_v, &u, 0.0);
    let state = State::from_vector(&x_v);
    // The condition of M, 1e3, times rounding.
    close(&rate, &virtual_dynamics(&robot, &state, &motion, &u).to_vector(), 1e-11);

    let J: Matrix<f64, D, D> = PortHamiltonian::<f64, D, N>::interconnection(&form, &x_v, 0.0);
    let R: Matrix<f64, D, D> = PortHamiltonian::<f64, D, N>::dissipation(&form, &x_v, 0.0);
    assert_eq!(J, -J.transpose());
    matrices_are_close(&R, &R.transpose(), 1e-15);
    let hessian = PortHamiltonian::<f64, D, N>::hessian(&form, &x_v, 0.0);
    matrices_are_close(&system.linearised(&x_v, &u, 0.0).state, &((J - R) * hessian), 1e-10);

    let balance = form.energy_balance(&x_v, &u, 0.0);
    let scale =
        balance.rate.abs() + balance.supplied.abs() + balance.dissipated.abs() + balance.explicit.abs();
    let whole = balance.supplied - balance.dissipated + balance.explicit;
    assert!((balance.rate - whole).abs() < 1e-11 * scale, "{balance:?}");
    let dampers: f64 = (0..N)
        .map(|i| robot.link_damping[i] * rate[i].powi(2) + robot.motor_damping[i] * rate[N + i].powi(2))
        .sum();
    assert!((balance.rate - (balance.supplied - dampers)).abs() < 1e-10 * scale, "{balance:?} and {dampers}");

    // Differentially the port fits: Π B = Cᵀ with the Hessian as metric.
    let matrices = passivity_matrices(&system, &Hessian::<_, N>(&form), &x_v, &u, 0.0);
    matrices_are_close(&matrices.mismatch, &Matrix::ZERO, 1e-12);
}

#[test]
fn the_virtual_robot_is_hamiltonian_like() {
    let r = &mut Numbers(1);
    for _ in 0..5 {
        virtual_form::<_, 2, 8>(planar(), r);
        virtual_form::<_, 3, 12>(branched::<3>(2), r);
    }
}

/// R_v may have a negative eigenvalue: fast elbows and small dampers make −½ Ṁ_l the larger part. That is why it is pH-like only.
#[test]
fn the_dissipation_of_the_virtual_robot_may_be_negative() {
    let r = &mut Numbers(2);
    let robot = Fjr { link_damping: Vector([1e-3; 2]), ..flexible(planar(), r) };
    let smallest = |v: f64| {
        let motion = Motion { v_l: Vector([0.0, v]), ..Motion::at_rest(Vector([0.3, 1.2])) };
        let form = VirtualRobot { robot: &robot, motion };
        let R = PortHamiltonian::<f64, 8, 2>::dissipation(&form, &Vector([0.0; 8]), 0.0);
        -measure_2(&-R)
    };
    assert!(smallest(0.0) >= 0.0 && smallest(5.0) < -1e-3 && smallest(-5.0) < -1e-3);
}

/// φ = ∫Π of a hardening metric: ∂φ = Π(q̃).
#[derive(Clone, Copy)]
struct OfMetric<const N: usize>(Metric<f64, N>);

impl<C: Scalar, const N: usize> Shaping<C, N> for OfMetric<N> {
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        let Metric::Hardening { base, hardening } = self.0 else { return *error };
        Vector::from_fn(|i| {
            let [b, h] = [base[i], hardening[i]].map(T::from_f64);
            error[i] * b + error[i].square() * error[i] * h * T::from_ratio(1, 3)
        })
    }
}

fn law<Pl, Pm, const N: usize>(
    metric: Metric<f64, N>,
    phi_l: Pl,
    phi_m: Pm,
    r: &mut Numbers,
) -> Vcbc<f64, Pl, Pm, N> {
    Vcbc {
        link: LinkGains { metric, shaping: phi_l, damping: r.between(2.0, 15.0) },
        motor: MotorGains { metric: r.between(20.0, 70.0), shaping: phi_m, damping: r.between(2.0, 10.0) },
    }
}

/// By how much the port-Hamiltonian form misses the closed loop, at a random error.
fn missed<Pl: Shaping<f64, 2>, Pm: Shaping<f64, 2>>(law: &Vcbc<f64, Pl, Pm, 2>, r: &mut Numbers) -> f64 {
    let (robot, motion) = (flexible(planar(), r), r.motion(1.5));
    let (x, omega): (Vector<f64, 8>, Vector<f64, 4>) = (r.vector(1.0), r.vector(5.0));
    let form = PortSystem(ErrorHamiltonian { robot: &robot, law, motion });
    let errors = ErrorLoop { robot: &robot, law, motion };
    // A few hundred operations on rates of 1e4.
    let output = form.output(&x, 0.0) - ControlSystem::<f64, 8, 4>::output(&errors, &x, 0.0);
    assert!(output.iter().all(|y| y.abs() < 1e-11));
    let balance = form.0.energy_balance(&x, &omega, 0.0);
    let scale =
        balance.rate.abs() + balance.supplied.abs() + balance.dissipated.abs() + balance.explicit.abs();
    let whole = balance.supplied - balance.dissipated + balance.explicit;
    assert!((balance.rate - whole).abs() < 1e-10 * scale, "{balance:?}");
    let difference = form.rate_under(&x, &omega, 0.0) - errors.rate_under(&x, &omega, 0.0);
    difference.iter().fold(0.0, |m: f64, d| m.max(d.abs()))
}

/// The closed loop is port-Hamiltonian with H̃ if ∂φ = Π on both sides, for constant and for hardening metrics, and is not if either side has
/// another φ, be it linear with another gain, tanh or coupled: both directions.
#[test]
fn the_closed_loop_has_an_error_hamiltonian_if_the_slope_is_the_metric() {
    let r = &mut Numbers(3);
    for _ in 0..10 {
        let base = r.between(20.0, 60.0);
        let (constant, hard) =
            (Metric::Constant(base), Metric::Hardening { base, hardening: r.between(1.0, 20.0) });
        let mut kept = law(constant, Linear { gain: base }, Linear { gain: base }, r);
        kept.motor.shaping.gain = kept.motor.metric;
        assert!(missed(&kept, r) < 1e-9);
        let mut kept = law(hard, OfMetric(hard), Linear { gain: base }, r);
        kept.motor.shaping.gain = kept.motor.metric;
        assert!(missed(&kept, r) < 1e-9);

        let mut lost = law(constant, Linear { gain: base.scaled(1.01) }, Linear { gain: base }, r);
        lost.motor.shaping.gain = lost.motor.metric;
        assert!(missed(&lost, r) > 1e-3);
        let mut lost = law(constant, Tanh { gain: base }, Linear { gain: base }, r);
        lost.motor.shaping.gain = lost.motor.metric;
        assert!(missed(&lost, r) > 1e-3);
        let lost = law(hard, OfMetric(hard), Tanh { gain: base }, r);
        assert!(missed(&lost, r) > 1e-3);
        let lost = law(constant, CoupledTanh::new(base, &base), Linear { gain: base }, r);
        assert!(missed(&lost, r) > 1e-3);
    }
}

/// The potential is the one of which φ = ∫Π is the gradient, 0 at no error.
#[test]
fn the_potential_is_the_integral_of_the_integral() {
    let r = &mut Numbers(4);
    let metric = Metric::<f64, 3>::Hardening { base: r.between(20.0, 60.0), hardening: r.between(1.0, 20.0) };
    let (e, de): (Vector<f64, 3>, Vector<f64, 3>) = (r.vector(1.0), r.vector(1.0));
    let rate = metric.potential(&moving(&e, &de)).gradient[0];
    assert!((rate - metric.integral(&e).dot(&de)).abs() < 1e-13 * rate.abs().max(1.0));
    assert_eq!(Vector([metric.potential(&Vector([0.0; 3]))]), Vector([0.0]));
}

/// With a metric that softens, H̃ has no lower bound and Π is not positive: the closed loop still loses energy in its dampers, so ω ↦ ỹ is
/// cyclo-passive, but it is no longer differentially passive.
#[test]
fn cyclo_passive_is_less_than_passive() {
    let r = &mut Numbers(5);
    let soft = Metric::Hardening { base: Vector([30.0; 2]), hardening: Vector([-40.0; 2]) };
    let mut law = law(soft, OfMetric(soft), Linear { gain: Vector([1.0; 2]) }, r);
    law.motor.shaping.gain = law.motor.metric;
    assert!(missed(&law, r) < 1e-9);
    let (robot, motion) = (flexible(planar(), r), r.motion(0.5));
    let form = ErrorHamiltonian { robot: &robot, law: &law, motion };
    for far in [0.5, 2.0, 10.0, 100.0] {
        let mut x: Vector<f64, 8> = r.vector(1.0);
        (x[0], x[1]) = (far, -far);
        let balance = form.energy_balance(&x, &Vector([0.0; 4]), 0.0);
        assert!(balance.rate < 0.0, "{balance:?}");
        let energy = PortHamiltonian::<f64, 8, 4>::hamiltonian(&form, &x, 0.0);
        // ½ 30 e² − 40/12 e⁴ each: −6.5e6 J at 10 rad.
        assert!(far < 5.0 || energy < -1e4, "{energy}");
    }
    let errors = ErrorLoop { robot: &robot, law: &law, motion };
    let mut x = Vector([0.0; 8]);
    (x[0], x[1]) = (2.0, 2.0);
    let Pi = MatrixField::<f64, 8>::at(&errors, &x, 0.0);
    assert!(measure_2(&-Pi) > 0.0);
}

/// The map of an error that is passive, z χ(z) ≥ 0, but not incrementally so: its slope is negative between 2.3 and 3.9.
struct Wavy;

impl<C: Scalar> Shaping<C, 1> for Wavy {
    fn eval<T: Over<C>>(&self, error: &Vector<T, 1>) -> Vector<T, 1> {
        error.map(|z| z + z.sin() * T::from_f64(1.5))
    }
}

/// χ = z³: strictly incrementally passive, with no rate at 0.
struct Cube;

impl<C: Scalar> Shaping<C, 1> for Cube {
    fn eval<T: Over<C>>(&self, error: &Vector<T, 1>) -> Vector<T, 1> {
        error.map(|z| z.square() * z)
    }
}

/// Incremental passivity asks for less than the contraction inequality: the cube is strictly monotone, and no β > 0 holds for all pairs or at 0.
/// With a constant metric the inequality is enough for it (lemma incrementa-static).
#[test]
fn incrementally_passive_maps_need_not_contract() {
    let (r, one) = (&mut Numbers(8), Matrix([[1.0]]));
    for _ in 0..100 {
        let [z_1, z_2]: [Vector<f64, 1>; 2] = [r.vector(2.0), r.vector(2.0)];
        assert!(incremental_passivity(&Cube, &one, 0.0, [&z_1, &z_2]) > 0.0);
    }
    for beta in [1.0, 1e-2, 1e-6] {
        let near = Vector([0.1 * f64::sqrt(beta)]);
        assert!(incremental_passivity(&Cube, &one, beta, [&-near, &near]) < 0.0);
        assert!(slope_inequality(&Cube, &one, beta, &Vector([0.0]))[(0, 0)] < 0.0);
    }
}

/// Proposition iff-conditons-phi with the factor β: the slope inequality at every error of a box is monotonicity with the same β for every pair
/// in it. Members that keep both, and maps that lose both at once.
#[test]
fn slopes_and_chords_have_the_same_rate() {
    fn both<P: Shaping<f64, N>, const N: usize>(
        shaping: &P,
        metric: &Matrix<f64, N, N>,
        beta: f64,
        reach: f64,
        r: &mut Numbers,
    ) -> [bool; 2] {
        let mut holds = [true; 2];
        for _ in 0..2000 {
            let [z_1, z_2]: [Vector<f64, N>; 2] = [r.vector(reach), r.vector(reach)];
            let least = -measure_2(&-slope_inequality(shaping, metric, beta, &z_1));
            // Between equality and rounding of entries of 1e3.
            holds[0] &= least > -1e-9;
            holds[1] &= incremental_passivity(shaping, metric, beta, [&z_1, &z_2]) > -1e-9;
        }
        holds
    }
    let r = &mut Numbers(6);
    let metric = Matrix([[30.0, 4.0], [4.0, 20.0]]);
    let diagonal = Matrix::diagonal(&Vector([55.0, 30.0]));
    let gain = Vector([55.0, 30.0]);
    // tanh on |q̃| ≤ 2: 30 sech² 2 = 2.1195 for a diagonal metric.
    let least = 30.0 / 2.0_f64.cosh().powi(2);
    assert_eq!(both(&Tanh { gain }, &diagonal, least, 2.0, r), [true; 2]);
    assert_eq!(both(&Tanh { gain }, &diagonal, 1.5 * least, 2.0, r), [false, true]);
    assert_eq!(both(&Linear { gain: Vector([7.0; 2]) }, &metric, 7.0, 5.0, r), [true; 2]);
    assert_eq!(both(&Linear { gain: Vector([7.0; 2]) }, &metric, 7.01, 5.0, r), [false; 2]);
    assert_eq!(both(&Wavy, &Matrix([[2.0]]), 0.0, 6.0, r), [false; 2]);
    // Passive all the same: z χ(z) ≥ 0.
    for k in -60..=60 {
        let z = f64::from(k) / 10.0;
        assert!(z * Shaping::<f64, 1>::eval(&Wavy, &Vector([z]))[0] >= 0.0);
    }
}

/// The conditions of the structures, refused with the reason. tanh with a diagonal gain keeps the variational structure; a metric that is full
/// does not commute with it; coupled joints have no symmetric slope.
#[test]
fn structures_are_refused_with_the_reason() {
    let (gain, error) = (Vector([55.0, 30.0]), Vector([0.4, -0.2]));
    let (diagonal, full) = (Matrix::diagonal(&gain), Matrix([[55.0, 5.0], [5.0, 30.0]]));
    let (tanh, linear) = (Tanh { gain }, Linear { gain });
    assert_eq!(keeps_variational_structure(&tanh, &diagonal, &error, 1e-12), Ok(()));
    assert_eq!(keeps_hamiltonian_structure(&linear, &diagonal, &error, 1e-12), Ok(()));
    let refused = keeps_variational_structure(&tanh, &full, &error, 1e-12);
    assert!(matches!(refused, Err(Refusal::DoesNotCommute { difference }) if difference > 1.0));
    let coupled = CoupledTanh::new(Vector([10.0, 8.0]), &gain);
    let refused = keeps_variational_structure(&coupled, &diagonal, &error, 1e-12);
    assert!(matches!(refused, Err(Refusal::SlopeNotSymmetric { difference }) if difference > 0.1));
    let refused = keeps_hamiltonian_structure(&tanh, &diagonal, &error, 1e-12);
    assert!(matches!(refused, Err(Refusal::SlopeIsNotTheMetric { difference }) if difference > 1.0));
    // What is not a number keeps nothing.
    let (linear, nothing) = (Linear { gain }, Matrix::diagonal(&Vector([f64::NAN, 30.0])));
    assert!(keeps_variational_structure(&linear, &nothing, &error, 1e-12).is_err());
    assert!(keeps_hamiltonian_structure(&linear, &nothing, &error, 1e-12).is_err());
    assert!(keeps_hamiltonian_structure(&tanh, &diagonal, &error, f64::NAN).is_err());
    // Where the slope commutes, Υ is symmetric; where it does not, it is not.
    let skew = |shaping: &Tanh<f64, 2>, metric: &Matrix<f64, 2, 2>| {
        let inverse = Matrix([[1.0, 0.0], [0.0, 1.0]].map(|e| metric.ldl().solve(&Vector(e)).0));
        let dissipation = shaping.slope(&error) * inverse;
        (dissipation[(0, 1)] - dissipation[(1, 0)]).abs()
    };
    assert!(skew(&tanh, &diagonal) == 0.0 && skew(&tanh, &full) > 1e-3);
}

/// Strictly passive from ω to ỹ where ∂φ = Π, and so differentially: the variation of the closed loop keeps the form of the variation of the
/// virtual system, Ξ = J̃, Υ = R̃ and Π = ∂²H̃ (corollary preserving-variational-pH-structure).
#[test]
fn the_variation_of_the_error_is_variational_hamiltonian_like() {
    let r = &mut Numbers(7);
    let base = r.between(20.0, 60.0);
    let hard = Metric::Hardening { base, hardening: r.between(1.0, 20.0) };
    let mut law = law(hard, OfMetric(hard), Linear { gain: base }, r);
    law.motor.shaping.gain = law.motor.metric;
    let (robot, motion) = (flexible(planar(), r), r.motion(1.0));
    let form = ErrorHamiltonian { robot: &robot, law: &law, motion };
    let errors = ErrorLoop { robot: &robot, law: &law, motion };
    let x: Vector<f64, 8> = r.vector(1.0);
    let hessian = PortHamiltonian::<f64, 8, 4>::hessian(&form, &x, 0.0);
    matrices_are_close(&hessian, &MatrixField::<f64, 8>::at(&errors, &x, 0.0), 1e-12);
    let J = PortHamiltonian::<f64, 8, 4>::interconnection(&form, &x, 0.0);
    let R = PortHamiltonian::<f64, 8, 4>::dissipation(&form, &x, 0.0);
    let closed: ClosedLoop<_, _, 4> = ClosedLoop { system: errors, feedback: Vector([0.0; 4]) };
    let jacobian = Dynamics::<f64, 8>::jacobian(&closed, &x, 0.0);
    matrices_are_close(&jacobian, &((J - R) * hessian), 1e-11);
    assert_eq!(J, -J.transpose());
}
