//! Laws that every robot obeys: tree against closed form, recursions against the mass matrix, energy balance.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Links, MassFactor, Motion, State};
use flexure_core::robots::{Body, JointKind, Pendulum, Tree};
use flexure_core::scalar::{Dual, Jet, Scalar};

use crate::common::{IDENTITY, Numbers, PLANAR, branched, close, planar};

/// A robot that hides its recursions: only mass matrix and potential energy, so that every torque comes from the
/// derived (dual-number) defaults. The oracle for the recursions.
struct Derived<'a, L>(&'a L);

impl<C: Scalar, L: Links<C, N>, const N: usize> Links<C, N> for Derived<'_, L> {
    type Factor<'a, T: flexure_core::scalar::Over<C>>
        = flexure_core::linalg::Ldl<T, N>
    where
        Self: 'a;
    fn mass_matrix<T: flexure_core::scalar::Over<C>>(&self, q: &Vector<T, N>) -> Matrix<T, N, N> {
        self.0.mass_matrix(q)
    }
    fn potential_energy<T: flexure_core::scalar::Over<C>>(&self, q: &Vector<T, N>) -> T {
        self.0.potential_energy(q)
    }
    fn carrier_rates<T: flexure_core::scalar::Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.0.carrier_rates(q, v)
    }
    fn factor<T: flexure_core::scalar::Over<C>>(&self, q: &Vector<T, N>) -> flexure_core::linalg::Ldl<T, N> {
        self.0.mass_matrix(q).ldl()
    }
}

fn planar_tree() -> Tree<f64, 2> {
    let body = |i: usize, translation| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: IDENTITY,
        translation,
        mass: PLANAR.mass[i],
        com: [PLANAR.com[i], 0.0, 0.0],
        inertia: [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, PLANAR.inertia[i]]],
    };
    Tree::new(&[body(0, [0.0; 3]), body(1, [PLANAR.length, 0.0, 0.0])], [0.0; 3]).expect("ordered")
}

#[test]
fn the_tree_is_the_closed_form() {
    let closed = planar();
    let tree = planar_tree();
    let mut r = Numbers(1);
    for _ in 0..200 {
        let [q, v, v_r, a_r] = core::array::from_fn(|_| r.vector::<2>(3.0));
        // Two ways through about 50 operations each: 1e-12 of the largest entry leaves a factor of 100.
        for (a, b) in [
            (closed.inverse_dynamics(&q, &v, &v_r, &a_r), tree.inverse_dynamics(&q, &v, &v_r, &a_r)),
            (closed.factor(&q).solve(&a_r), tree.factor(&q).solve(&a_r)),
            (closed.mass_mul(&q, &a_r), tree.mass_mul(&q, &a_r)),
            (closed.mass_matrix(&q).row(0), tree.mass_matrix(&q).row(0)),
            (closed.mass_matrix(&q).row(1), tree.mass_matrix(&q).row(1)),
        ] {
            close(&a, &b, 1e-12);
        }
    }
}

/// The O(n) passes against mass matrix, Christoffel symbols and gradient by dual numbers.
fn recursions_agree<const N: usize>(seed: u64) {
    let tree = branched::<N>(seed);
    let derived = Derived(&tree);
    let mut r = Numbers(seed + 100);
    for _ in 0..20 {
        let [q, v, v_r, a_r] = core::array::from_fn(|_| r.vector::<N>(2.0));
        close(&tree.mass_mul(&q, &a_r), &derived.mass_mul(&q, &a_r), 1e-12);
        close(&tree.gravity_torque(&q), &derived.gravity_torque(&q), 1e-12);
        close(&tree.inertial_torque(&q, &v, &v_r, &a_r), &derived.inertial_torque(&q, &v, &v_r, &a_r), 1e-12);
        close(
            &tree.inverse_dynamics(&q, &v, &v_r, &a_r),
            &derived.inverse_dynamics(&q, &v, &v_r, &a_r),
            1e-12,
        );
        // Solving loses the condition number of the mass matrix, about 1e3 here.
        close(&tree.factor(&q).solve(&a_r), &derived.factor(&q).solve(&a_r), 1e-10);
        close(&tree.articulated(&q).solve(&a_r), &derived.factor(&q).solve(&a_r), 1e-10);
        close(&tree.mass_mul(&q, &tree.factor(&q).solve(&a_r)), &a_r, 1e-11);
        // The derived Coriolis product is the Christoffel matrix of the theory.
        let matrices = LinkMatrices::new(&tree, &q, &v);
        close(&(matrices.coriolis() * v_r), &tree.inertial_torque(&q, &v, &v_r, &Vector::ZERO), 1e-12);
    }
}

#[test]
fn recursions_are_the_derived_torques() {
    recursions_agree::<1>(3);
    recursions_agree::<2>(4);
    recursions_agree::<5>(5);
    recursions_agree::<8>(6);
}

#[test]
fn skew_is_skew_and_christoffel_splits_the_mass_rate() {
    let tree = branched::<6>(9);
    let mut r = Numbers(10);
    for _ in 0..20 {
        let (q, v) = (r.vector::<6>(2.0), r.vector::<6>(2.0));
        let m = LinkMatrices::new(&tree, &q, &v);
        let (c, rate) = (m.coriolis(), m.mass_rate);
        // Ṁ as the time derivative of the mass matrix along the motion: another number type.
        let along = tree.mass_matrix(&Vector::from_fn(|i| Jet::<f64, 2>::new([q[i], v[i]])));
        for i in 0..6 {
            for j in 0..6 {
                assert!((m.skew[(i, j)] + m.skew[(j, i)]).abs() < 1e-13, "S is skew");
                assert!((c[(i, j)] + c[(j, i)] - rate[(i, j)]).abs() < 1e-12, "C + Cᵀ = Ṁ");
                assert!((along[(i, j)].coefficient(1) - rate[(i, j)]).abs() < 1e-12, "Ṁ by jets");
            }
        }
    }
}

fn robot<L>(links: L) -> Fjr<f64, L, 5> {
    Fjr {
        links,
        motor_inertia: Vector([0.5, 0.4, 0.3, 0.2, 0.1]),
        stiffness: Vector([1000.0, 800.0, 600.0, 400.0, 200.0]),
        link_damping: Vector([0.1, 0.2, 0.3, 0.4, 0.5]),
        motor_damping: Vector([0.6, 0.7, 0.8, 0.9, 1.0]),
    }
}

#[test]
fn both_forms_of_the_dynamics_agree_and_balance_power() {
    let robot = robot(branched::<5>(20));
    let mut r = Numbers(21);
    for _ in 0..20 {
        let x = Motion { q_l: r.vector(2.0), q_m: r.vector(2.0), v_l: r.vector(2.0), v_m: r.vector(2.0) };
        let u = r.vector::<5>(10.0);
        let state = robot.state(&x);
        let (hamiltonian, workless) =
            (robot.hamiltonian_dynamics(&state, &u), robot.workless_dynamics(&state, &u));
        close(&hamiltonian.p_l, &workless.p_l, 1e-11);
        close(&hamiltonian.p_m, &workless.p_m, 1e-12);
        close(&hamiltonian.q_l, &x.v_l, 1e-12);

        // Second-order form: ṗ_l = M a + Ṁ v.
        let a = robot.link_acceleration(&x);
        let matrices = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l);
        close(&(matrices.mass * a + matrices.mass_rate * x.v_l), &hamiltonian.p_l, 1e-11);
        close(&robot.motor_inertia.diag_mul(&robot.motor_acceleration(&x, &u)), &hamiltonian.p_m, 1e-12);

        // Ḣ along the flow, by a directional derivative of H: supplied minus dissipated.
        let along = |x: &Vector<f64, 5>, dx: &Vector<f64, 5>| {
            Vector::<_, 5>::from_fn(|i| Dual::<f64, 1> { value: x[i], gradient: [dx[i]] })
        };
        let moving = State {
            q_l: along(&state.q_l, &hamiltonian.q_l),
            q_m: along(&state.q_m, &hamiltonian.q_m),
            p_l: along(&state.p_l, &hamiltonian.p_l),
            p_m: along(&state.p_m, &hamiltonian.p_m),
        };
        let power = robot.power(&x, &u);
        let rate = robot.hamiltonian(&moving).gradient[0];
        // Powers of 1e3 W cancel: 1e-12 of them.
        assert!((rate - (power.supplied - power.dissipated)).abs() < 1e-9, "{rate} against {power:?}");
        let energy = robot.total_energy(&x);
        assert!((energy - robot.hamiltonian(&state)).abs() < 1e-12 * energy.abs());
    }
}

#[test]
fn the_pendulum_swings() {
    let pendulum = Pendulum { inertia: 0.0059, weight_moment: 0.403 * 9.81 * 0.06 };
    for q in [-3.0, -0.5, 0.0, 1.0, 2.5_f64] {
        let torque = pendulum.gravity_torque(&Vector([q]))[0];
        assert!((torque - pendulum.weight_moment * q.sin()).abs() < 1e-15);
    }
}

#[test]
fn a_child_before_its_parent_is_refused() {
    let body = Body {
        parent: Some(0),
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: IDENTITY,
        translation: [0.0; 3],
        mass: 1.0,
        com: [0.0; 3],
        inertia: IDENTITY,
    };
    assert!(Tree::new(&[body], [0.0; 3]).is_none());
}
