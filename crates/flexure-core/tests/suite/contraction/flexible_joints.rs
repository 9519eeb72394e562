//! The flexible-joint robot under v-CBC as an instance of the general theory: what is said in general of any system gives what is built for it.

use flexure_core::contraction::{
    ControlSystem, ErrorLoop, FlexibleJoints, Together, VirtualSystem, differential_passivity,
    generalised_jacobian, passivity_matrices,
};
use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, State};
use flexure_core::reference::{Reference, Sine};
use flexure_core::virtual_system::{Structure, error_coordinates};

use super::{norm, solution};
use crate::common::{Numbers, branched, coupled_tanh, flexible, gains, linear, planar, tanh};

type Flexible<L, P, const N: usize> = FlexibleJoints<f64, L, P, P, Sine<f64, N>, N>;

/// sin-like references of every joint.
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

fn matrices_are_close<const R: usize, const K: usize>(
    a: &Matrix<f64, R, K>,
    b: &Matrix<f64, R, K>,
    tolerance: f64,
) {
    let scale = b.0.as_flattened().iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    for (x, y) in a.0.as_flattened().iter().zip(b.0.as_flattened()) {
        assert!((x - y).abs() <= tolerance * scale, "{x} against {y} of {scale}");
    }
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
    matrices_are_close(&general, &jacobian_of_structure(&structure), 1e-6);

    // The same matrix from the error loop, a third way.
    let errors = ErrorLoop { robot: &design.robot, law: &design.law, motion };
    let linearised = errors.linearised(&error.to_vector::<D>(), &Vector::<f64, N2>::ZERO, 0.0);
    matrices_are_close(&linearised.state, &jacobian_of_structure(&structure), 1e-11);
}

#[test]
fn planar_arm() {
    let r = &mut Numbers(1);
    for hardening in [false, true] {
        let law = gains(tanh, hardening, r);
        method::<_, _, 2, 4, 8>(flexible(planar(), r), law, r);
        let law = gains(linear, hardening, r);
        method::<_, _, 2, 4, 8>(flexible(planar(), r), law, r);
        let law = gains(coupled_tanh, hardening, r);
        method::<_, _, 2, 4, 8>(flexible(planar(), r), law, r);
    }
}
