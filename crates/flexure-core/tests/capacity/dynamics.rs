//! Recursions and the model above them.

use flexure_core::linalg::{Ldl, Vector};
use flexure_core::model::{FeedForward, LinkMatrices, Links, MassFactor, RotorCoupling};
use flexure_core::scalar::{Jet, Over, Scalar};

use super::{Constants, Random, fit, fit_motion, random, robot, same, same_joints, tree};
use crate::common::{Numbers, flexible};

/// Every recursion, with phantoms that move. Out of line: all sizes in one function are more than the compiler survives.
#[inline(never)]
fn recursions<C: Scalar + PartialEq, T: Over<C>, const K: usize, const N: usize>(
    constants: Constants<C>,
    number: Random<T>,
) {
    for seed in 1..4 {
        let (exact, roomy) = (tree::<C, K, K>(seed, constants), tree::<C, K, N>(seed, constants));
        let r = &mut Numbers(seed);
        let [q, v, v_r, a] = core::array::from_fn(|_| random::<T, N>(r, number, 1.0));
        let [q_k, v_k, v_rk, a_k] = [&q, &v, &v_r, &a].map(|x| fit::<T, N, K>(x, T::ZERO));
        let none = Vector::ZERO;

        let (small, large) = (exact.mass_matrix(&q_k), roomy.mass_matrix(&q));
        for i in 0..K {
            same_joints(&small.row(i), &large.row(i), &none);
        }
        for i in K..N {
            let unit: Vector<T, N> = Vector::from_fn(|j| if i == j { T::ONE } else { T::ZERO });
            same(&large.row(i), &unit);
            same(&large.column(i), &unit);
        }
        same_joints(
            &exact.inverse_dynamics(&q_k, &v_k, &v_rk, &a_k),
            &roomy.inverse_dynamics(&q, &v, &v_r, &a),
            &a,
        );
        same_joints(
            &exact.inertial_torque(&q_k, &v_k, &v_rk, &a_k),
            &roomy.inertial_torque(&q, &v, &v_r, &a),
            &a,
        );
        same_joints(&exact.mass_mul(&q_k, &a_k), &roomy.mass_mul(&q, &a), &a);
        same_joints(&exact.gravity_torque(&q_k), &roomy.gravity_torque(&q), &none);
        same_joints(&exact.carrier_rates(&q_k, &v_k), &roomy.carrier_rates(&q, &v), &none);
        same_joints(&exact.factor(&q_k).solve(&a_k), &roomy.factor(&q).solve(&a), &a);
        let still = fit::<T, K, N>(&a_k, T::ZERO);
        same_joints(&Ldl::new(&small).solve(&a_k), &Ldl::new(&large).solve(&still), &still);
        same_joints(Ldl::new(&small).pivots(), Ldl::new(&large).pivots(), &Vector([T::ONE; N]));
        same(&exact.potential_energy(&q_k), &roomy.potential_energy(&q));
        let forced = roomy.forward_dynamics(&q, &v, &a);
        same_joints(&exact.forward_dynamics(&q_k, &v_k, &a_k), &fit(&forced, T::ZERO), &a);
    }
}

/// The flexible-joint robot, with phantoms at rest.
#[inline(never)]
fn model<C: Scalar + PartialEq, T: Over<C>, const K: usize, const N: usize>(
    constants: Constants<C>,
    number: Random<T>,
) {
    let r = &mut Numbers(5);
    let data = flexible(tree::<f64, K, K>(2, crate::FLOAT), r);
    let (exact, roomy) = (robot::<C, K, K>(2, &data, constants), robot::<C, K, N>(2, &data, constants));
    let x = flexure_core::model::Motion {
        q_l: random::<T, K>(r, number, 1.0),
        q_m: random(r, number, 1.0),
        v_l: random(r, number, 1.0),
        v_m: random(r, number, 1.0),
    };
    let u = random::<T, K>(r, number, 1.0);
    let (x_n, u_n) = (fit_motion::<T, K, N>(&x), fit(&u, T::ZERO));
    let none = Vector::ZERO;

    let (p, p_n) = (exact.state(&x), roomy.state(&x_n));
    same(&exact.hamiltonian(&p), &roomy.hamiltonian(&p_n));
    same(&exact.total_energy(&x), &roomy.total_energy(&x_n));
    same(&exact.power(&x, &u), &roomy.power(&x_n, &u_n));
    same_joints(&exact.link_acceleration(&x), &roomy.link_acceleration(&x_n), &none);
    same_joints(&exact.motor_acceleration(&x, &u), &roomy.motor_acceleration(&x_n, &u_n), &none);
    same_joints(&exact.motors_at_rest(&x.q_l), &roomy.motors_at_rest(&x_n.q_l), &none);
    same_joints(&exact.links_at_rest(&x.q_m), &roomy.links_at_rest(&x_n.q_m), &none);
    for (a, b) in [
        (exact.hamiltonian_dynamics(&p, &u), roomy.hamiltonian_dynamics(&p_n, &u_n)),
        (exact.workless_dynamics(&p, &u), roomy.workless_dynamics(&p_n, &u_n)),
    ] {
        same_joints(&a.q_l, &b.q_l, &none);
        same_joints(&a.q_m, &b.q_m, &none);
        same_joints(&a.p_l, &b.p_l.map(|x| x + T::ZERO), &none);
        same_joints(&a.p_m, &b.p_m.map(|x| x + T::ZERO), &none);
    }
    let (m, m_n) = (
        LinkMatrices::new(&exact.links, &x.q_l, &x.v_l),
        LinkMatrices::new(&roomy.links, &x_n.q_l, &x_n.v_l),
    );
    for i in 0..K {
        same_joints(&m.skew.row(i), &m_n.skew.row(i), &none);
        same_joints(&m.mass_rate.row(i), &m_n.mass_rate.row(i), &none);
    }

    let series = x.q_l.map(|q| Jet::<T, 7>::variable(q).sin());
    let (along, along_n): (FeedForward<T, K, 3, 5>, FeedForward<T, N, 3, 5>) =
        (exact.inverse_dynamics(&series), roomy.inverse_dynamics(&fit(&series, Jet::ZERO)));
    same_joints(&along.u_m, &along_n.u_m, &Vector::ZERO);
    same_joints(&along.q_m, &along_n.q_m, &Vector::ZERO);

    let ratio: Vector<C, K> = Vector([(constants.0)(80.0); K]);
    let rotors = RotorCoupling::new(&exact.motor_inertia, &ratio);
    let rotors_n = RotorCoupling::new(&roomy.motor_inertia, &fit(&ratio, C::ONE));
    same(&rotors.energy(&exact.links, &x), &rotors_n.energy(&roomy.links, &x_n));
    let links = rotors_n.link_torque(&roomy.links, &x_n, &u_n).map(|x| x + T::ZERO);
    same_joints(&rotors.link_torque(&exact.links, &x, &u), &links, &none);
    let motors = rotors_n.motor_torque(&roomy.links, &x_n, &u_n);
    same_joints(&rotors.motor_torque(&exact.links, &x, &u), &motors, &none);
}

#[test]
fn recursions_on_every_number() {
    on_numbers!(recursions::<3, 4>);
}

#[test]
fn recursions_at_many_sizes() {
    fn at<const K: usize, const N: usize>() {
        recursions::<f64, f64, K, N>(crate::FLOAT, crate::number_f64);
    }
    at::<1, 1>();
    at::<2, 4>();
    at::<4, 4>();
    at::<4, 8>();
    at::<5, 8>();
    at::<6, 8>();
    at::<7, 8>();
    at::<2, 16>();
    at::<7, 16>();
}

#[test]
fn models() {
    on_numbers!(model::<3, 4>);
    model::<f64, f64, 5, 8>(crate::FLOAT, crate::number_f64);
    model::<f64, f64, 7, 16>(crate::FLOAT, crate::number_f64);
}
