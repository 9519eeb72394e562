//! The flexible-joint robot under v-CBC as an instance of the general theory: what is said in general of any system gives what is built for it.

use flexure_core::contraction::{
    ControlSystem, ErrorLoop, FlexibleJoints, Together, VirtualSystem, differential_passivity,
    generalised_jacobian, passivity_matrices,
};
use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, State};
use flexure_core::reference::{Reference, Sine};
use flexure_core::robots::Pendulum;
use flexure_core::virtual_system::{ErrorState, Structure, error_coordinates};

use super::{matrices_are_close, norm, solution};
use crate::common::{Numbers, coupled_tanh, flexible, gains, linear, planar, tanh};

type Flexible<L, P, const N: usize> = FlexibleJoints<f64, L, P, P, Sine<f64, N>, N>;

/// Sines of every joint.
fn sines<const N: usize>(r: &mut Numbers) -> Sine<f64, N> {
    Sine {
        offset: r.vector(0.3),
        amplitude: r.between(0.1, 0.5),
        frequency: r.between(0.5, 2.0),
        phase: r.vector(3.0),
    }
}

fn jacobian_of_structure<const N: usize, const D: usize>(s: &Structure<f64, N>) -> Matrix<f64, D, D> {
    let blocks = s.jacobian();
    Matrix::from_fn(|i, j| blocks[i / N][j / N][(i % N, j % N)])
}

/// A state at random, with velocities as wide as positions.
fn state<L: Links<f64, N>, const N: usize, const D: usize>(
    robot: &Fjr<f64, L, N>,
    r: &mut Numbers,
) -> Vector<f64, D> {
    robot.state(&r.motion(1.0)).to_vector()
}

/// The three things that the method asks for, and Θ = ∂x̃/∂x_v: the generalised Jacobian of the virtual closed loop in it is (Ξ − Υ) Π of the
/// error coordinates, although one comes from the law in x_v with Θ̇ and the other from the closed loop in x̃.
fn method<L: Links<f64, N>, P: Shaping<f64, N>, const N: usize, const N2: usize, const D: usize>(
    robot: Fjr<f64, L, N>,
    law: Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) {
    let design: Flexible<L, P, N> = FlexibleJoints { robot, law, reference: sines(r) };
    let (x, x_v): (Vector<f64, D>, Vector<f64, D>) = (state(&design.robot, r), state(&design.robot, r));
    let t = r.next();
    // Rounding of torques of 1e4 N m and more, and the condition of M.
    let torque = design.law(&x, &x, t).iter().fold(1.0, |m: f64, u| m.max(u.abs()));

    let defect = design.actual_defect(&x, &r.vector(20.0), t);
    assert!(norm(&defect.rate) < 1e-10 && norm(&defect.output) < 1e-12, "{defect:?}");
    let defect: Vector<f64, D> = design.reference_defect(&x, t);
    assert!(norm(&defect) < 1e-11 * torque, "{defect:?} with torques of {torque}");

    let along = design.along(x, t);
    let general = generalised_jacobian::<f64, f64, D>(&along, &along, &x_v, 0.0);
    let (motion, virtual_state) = (design.robot.motion(&State::from_vector(&x)), State::from_vector(&x_v));
    let q_ld = design.reference.at(t);
    let error = error_coordinates(&design.robot, &design.law, &virtual_state, &motion, &q_ld, &Input::ZERO);
    let structure = Structure::new(&design.robot, &design.law, &error, &motion);
    // Θ⁻¹ = (ΘᵀΘ)⁻¹ Θᵀ loses the square of the condition of Θ, which has entries of K⁻¹ and M: 4e-9 here.
    matrices_are_close(&general, &jacobian_of_structure(&structure), 1e-7);

    // The same matrix from the error loop, a third way.
    let errors = ErrorLoop { robot: &design.robot, law: &design.law, motion };
    let linearised = errors.linearised(&error.to_vector::<D>(), &Vector::<f64, N2>::ZERO, 0.0);
    matrices_are_close(&linearised.state, &jacobian_of_structure(&structure), 1e-11);
}

/// Corollaries feedback-interconnection and strucutr-preserving by the general functions: the closed loop is differentially passive from ω to M⁻¹σ
/// in its metric, R = 0 and Q = 2 diag(Π ∂φ, M⁻¹ (D + K_d) M⁻¹), whatever the arm does.
fn port<L: Links<f64, N>, P: Shaping<f64, N>, const N: usize, const N2: usize, const D: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) {
    let error = ErrorLoop { robot, law, motion: r.motion(1.5) };
    let (x, omega): (Vector<f64, D>, Vector<f64, N2>) = (r.vector(1.5), r.vector(5.0));
    let matrices = passivity_matrices(&error, &error, &x, &omega, 0.0);
    matrices_are_close(&matrices.mismatch, &Matrix::ZERO, 1e-12);

    let [dx, d_omega]: [Vector<f64, D>; 2] = [r.vector(1.0), r.vector(1.0)];
    let d_omega: Vector<f64, N2> = Vector::from_fn(|i| d_omega[i]);
    let balance = differential_passivity(&error, &error, &[x, dx], &[omega, d_omega], 0.0);
    let state = ErrorState::from_vector(&x);
    let structure = Structure::new(robot, law, &state, &error.motion);
    let delta = ErrorState::<f64, N>::from_vector(&dx);
    assert!((balance.storage - structure.storage(&delta)).abs() < 1e-11 * balance.storage);
    let (s_l, s_m) = (structure.metric[2] * delta.sigma_l, structure.metric[3] * delta.sigma_m);
    let slope_l = structure.metric[0] * law.link.shaping.slope(&state.e_l);
    let slope_m = structure.metric[1] * law.motor.shaping.slope(&state.e_m);
    let lost = delta.e_l.dot(&(slope_l * delta.e_l))
        + delta.e_m.dot(&(slope_m * delta.e_m))
        + s_l.dot(&(robot.link_damping + law.link.damping).diag_mul(&s_l))
        + s_m.dot(&(robot.motor_damping + law.motor.damping).diag_mul(&s_m));
    // What cancels is the coupling and δσᵀ Ṁ⁻¹ δσ, of the size of what is lost times the condition of M.
    let expected = balance.supplied - lost;
    assert!((balance.rate - expected).abs() < 1e-9 * lost.abs().max(1.0), "{balance:?} against {expected}");
}

fn sweep<L: Links<f64, N>, const N: usize, const N2: usize, const D: usize>(links: fn() -> L, seed: u64) {
    let r = &mut Numbers(seed);
    for hardening in [false, true] {
        let law = gains(tanh, hardening, r);
        method::<_, _, N, N2, D>(flexible(links(), r), law, r);
        let law = gains(linear, hardening, r);
        method::<_, _, N, N2, D>(flexible(links(), r), law, r);
        let law = gains(coupled_tanh, hardening, r);
        method::<_, _, N, N2, D>(flexible(links(), r), law, r);
    }
    for _ in 0..5 {
        port::<_, _, N, N2, D>(&flexible(links(), r), &gains(tanh, false, r), r);
        port::<_, _, N, N2, D>(&flexible(links(), r), &gains(coupled_tanh, false, r), r);
    }
}

#[test]
fn planar_arm() {
    sweep::<_, 2, 4, 8>(planar, 1);
}

#[test]
fn pendulum_under_gravity() {
    sweep::<_, 1, 2, 4>(|| Pendulum { inertia: 0.3, weight_moment: 4.0 }, 2);
}

/// Theorem partialcontraction: the robot under u = ζ(x, x, t) and its virtual system from elsewhere meet, and both meet the reference.
#[test]
fn robot_and_virtual_system_meet_on_the_reference() {
    let r = &mut Numbers(3);
    let design: Flexible<_, _, 2> =
        FlexibleJoints { robot: flexible(planar(), r), law: gains(linear, false, r), reference: sines(r) };
    let x: Vector<f64, 8> = design.reference(&Vector::ZERO, 0.0);
    let (away, elsewhere): (Vector<f64, 8>, Vector<f64, 8>) = (r.vector(0.02), r.vector(0.02));
    let start: Vector<f64, 16> =
        Vector::from_fn(|i| if i < 8 { x[i] + away[i] } else { x[i - 8] + elsewhere[i - 8] });
    let (h, steps) = (2e-4, 10_000);
    let end = solution(&Together::<_, 8, 2>(&design), start, h, steps);
    let (x, x_v) = (Vector::from_fn(|i| end[i]), Vector::from_fn(|i| end[8 + i]));
    let target: Vector<f64, 8> = design.reference(&x, h * steps as f64);
    let (real, copy) = (norm(&(x - target)), norm(&(x_v - target)));
    assert!(real < 1e-5 * norm(&away) && copy < 1e-5 * norm(&elsewhere), "{real:e} and {copy:e}");
}
