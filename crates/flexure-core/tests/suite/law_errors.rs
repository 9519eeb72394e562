//! Laws that promise an error dynamics give it, exactly, along the closed loop.

use flexure_core::control::{ControlLaw, IntegralManifold};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::common::laws::{self, Course, nominal};
use crate::common::{Numbers, close, flexible};
use crate::on_three_robots;

/// Links in general position, motors wherever they are: e⁗ + k_3 e⃛ + k_2 ë + k_1 ė + k_0 e = 0.
fn four_integrators<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::feedback_linearization(r), r.series(1.0));
    let x = r.motion(1.0);
    let course = Course::new(&robot, &x, &law.torque(&robot, &x, &q_ld));
    let [e @ .., snap] = (course.q_l - q_ld).derivatives();
    let mut wanted = Vector::ZERO;
    for (gain, e) in law.gains.iter().zip(&e) {
        wanted -= gain.diag_mul(e);
    }
    close(&snap, &wanted, 1e-9);
}

/// The reference that starts at (q, q̇) of `x` and is where ë + k_v ė + k_p e = 0 leads.
fn slow<const N: usize>(
    law: &IntegralManifold<f64, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Vector<Jet<f64, 5>, N> {
    Vector::from_fn(|i| {
        let d: [f64; 5] = core::array::from_fn(|k| q_ld[i].derivative(k));
        let mut e = [x.q_l[i] - d[0], x.v_l[i] - d[1], 0.0, 0.0, 0.0];
        for k in 2..5 {
            e[k] = -law.velocity[i] * e[k - 1] - law.position[i] * e[k - 2];
        }
        Jet::from_derivatives(core::array::from_fn(|k| d[k] + e[k]))
    })
}

/// Springs on the manifold stay on it, and there the links obey the rigid error dynamics, for any stiffness.
fn manifold<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::integral_manifold(r), r.series(1.0));
    let start = r.motion(1.0);
    let path = slow(&law, &start, &q_ld);
    let (x, u_m) = nominal(&robot, &path);
    let u = law.torque(&robot, &x, &q_ld);
    close(&u, &u_m, 1e-11);
    let course = Course::new(&robot, &x, &u);
    for (got, wanted) in course.q_l.derivatives().iter().zip(&path.derivatives()) {
        close(got, wanted, 1e-9);
    }
    // The composite law: rigid computed torque and a correction in proportion to the compliance.
    let rigid = {
        let [q, v, a, ..] = path.derivatives();
        robot.links.inverse_dynamics(&q, &v, &v, &a)
            + robot.motor_inertia.diag_mul(&a)
            + (robot.link_damping + robot.motor_damping).diag_mul(&v)
    };
    let softer = Fjr { links: links(), stiffness: robot.stiffness.scaled(0.1), ..robot };
    let on = |robot: &Fjr<f64, L, N>| law.torque(robot, &nominal(robot, &path).0, &q_ld) - rigid;
    close(&on(&softer), &on(&robot).scaled(10.0), 1e-9);
    // Off it, what differs is the damping of the springs.
    let (off, rate) = (r.vector(1.0), r.vector(1.0));
    let beside = Motion { q_m: x.q_m + off, v_m: x.v_m + rate, ..x };
    close(&law.torque(&robot, &beside, &q_ld), &(u - law.damping.diag_mul(&rate)), 1e-11);
}

/// With springs that do not bend and the motors part of the links, the law for rigid robots gives
/// (M + B) ṡ + (C + D_l + D_m + K_d) s + Π e = 0.
fn locked<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, q_ld) = (flexible(links(), r), laws::rigid(r), r.series::<5, N>(1.0));
    let (q, v) = (r.vector(1.0), r.vector(1.0));
    let x = Motion { q_l: q, q_m: q, v_l: v, v_m: v };
    let damping = robot.link_damping + robot.motor_damping;
    let u = law.torque(&robot, &x, &q_ld);
    let mut mass = robot.links.mass_matrix(&q);
    for i in 0..N {
        mass[(i, i)] += robot.motor_inertia[i];
    }
    let bias = robot.links.inverse_dynamics(&q, &v, &v, &Vector::ZERO) + damping.diag_mul(&v);
    let a = mass.ldl().solve(&(u - bias));
    let [q_d, v_d, a_d, ..] = q_ld.derivatives();
    let gain = law.link.shaping.gain;
    let s = v - v_d + gain.diag_mul(&(q - q_d));
    let ds = a - a_d + gain.diag_mul(&(v - v_d));
    let zero = mass * ds
        + robot.links.inertial_torque(&q, &v, &s, &Vector::ZERO)
        + (damping + law.link.damping).diag_mul(&s)
        + law.link.metric.integral(&(q - q_d));
    let size = u.iter().fold(1.0, |m: f64, u| m.max(u.abs()));
    close(&zero.scaled(size.recip()), &Vector::ZERO, 1e-12);
}

#[test]
fn feedback_linearization_leaves_four_integrators() {
    on_three_robots!(four_integrators, 21);
}

#[test]
fn the_manifold_is_invariant_and_rigid_on_it() {
    on_three_robots!(manifold, 22);
}

#[test]
fn the_rigid_law_is_right_with_rigid_springs() {
    on_three_robots!(locked, 23);
}
