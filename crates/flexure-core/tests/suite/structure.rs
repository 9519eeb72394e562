//! The variation of the closed loop has the structure Ξ, Υ, Π, Ψ, and its storage balances.

use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links};
use flexure_core::scalar::{Dual, Jet};
use flexure_core::virtual_system::{ErrorState, Structure, closed_loop};

use crate::common::{
    Numbers, branched, close, coupled_tanh, flexible, gains, linear, map, motion_rate, moving, moving_motion,
    parts, planar, random_error, tanh,
};

/// (Ξ − Υ) Π is the Jacobian of the closed loop, Ψ that of its input, and Ξ is skew.
fn structure_is_the_jacobian<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let (x, error) = (r.motion(1.5), random_error(r));
    let structure = Structure::new(robot, law, &error, &x);
    let constant = |v: &Vector<f64, N>| v.map(Dual::<f64, N>::constant);
    let seeded = |v: &Vector<f64, N>| Vector::from_fn(|i| Dual::<f64, N>::variable(v[i], i));
    let jacobian = structure.jacobian();
    for (j, part) in parts(&error).iter().enumerate() {
        let mut dual = map(&error, constant);
        let slots = [&mut dual.e_l, &mut dual.e_m, &mut dual.sigma_l, &mut dual.sigma_m];
        *slots.into_iter().nth(j).expect("four blocks") = seeded(part);
        let rates = closed_loop(robot, law, &dual, &x.map(Dual::constant), &Input::ZERO);
        for (i, rate) in parts(&rates).iter().enumerate() {
            for k in 0..N {
                // Products of three matrices; solving with M loses its condition number, about 1e3.
                close(&jacobian[i][j].row(k), &Vector(rate[k].gradient), 1e-11);
            }
            let transposed = structure.interconnection[j][i].transpose();
            let sum = structure.interconnection[i][j] + transposed;
            assert!(sum.0.as_flattened().iter().all(|x| x.abs() < 1e-13), "Ξ + Ξᵀ = 0");
        }
    }
    for (j, name) in ["link", "motor"].into_iter().enumerate() {
        let one = Vector(core::array::from_fn(|i| Dual::<f64, N>::variable(0.0, i)));
        let mut omega = Input::<Dual<f64, N>, N>::ZERO;
        match name {
            "link" => omega.link = one.map(Jet::value),
            _ => omega.motor = one,
        }
        let rates = closed_loop(robot, law, &map(&error, constant), &x.map(Dual::constant), &omega);
        for (i, rate) in parts(&rates).iter().enumerate() {
            assert_eq!(structure.port[i][j], Matrix(rate.map(|x| x.gradient).0), "Ψ");
        }
    }
}

/// Ẇ along variation, error and robot together: the coupling cancels.
fn storage_balances<L, P, const N: usize>(robot: &Fjr<f64, L, N>, law: &Vcbc<f64, P, P, N>, r: &mut Numbers)
where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let (x, error, delta) = (r.motion(1.5), random_error(r), random_error(r));
    let (delta_omega_l, delta_omega_m) = (r.vector::<N>(2.0), r.vector::<N>(2.0));
    let structure = Structure::new(robot, law, &error, &x);

    let dx = motion_rate(robot, &x, &r.vector(20.0));
    let de = closed_loop(robot, law, &error, &x, &Input::ZERO);
    let [d_e_l, d_e_m, d_sigma_l, d_sigma_m] = structure.jacobian().map(|row| {
        let products = row.iter().zip(parts(&delta)).map(|(block, d)| *block * d);
        products.fold(Vector::ZERO, |sum, x| sum + x)
    });
    let moving_error = |x: &ErrorState<f64, N>, dx: [Vector<f64, N>; 4]| {
        let [e_l, e_m, sigma_l, sigma_m] = dx;
        ErrorState {
            e_l: moving(&x.e_l, &e_l),
            e_m: moving(&x.e_m, &e_m),
            sigma_l: moving(&x.sigma_l, &sigma_l),
            sigma_m: moving(&x.sigma_m, &sigma_m),
        }
    };
    let d_delta = [d_e_l, d_e_m, d_sigma_l + delta_omega_l, d_sigma_m + delta_omega_m];
    let along = Structure::new(robot, law, &moving_error(&error, parts(&de)), &moving_motion(&x, &dx));
    let rate = along.storage(&moving_error(&delta, d_delta)).gradient[0];

    let s_l = structure.metric[2] * delta.sigma_l;
    let s_m = structure.metric[3] * delta.sigma_m;
    let Pi_l_rate = law.link.metric.at(&moving(&error.e_l, &de.e_l)).map(|m| m.gradient[0]);
    let slope_l = structure.metric[0] * law.link.shaping.slope(&error.e_l);
    let slope_m = structure.metric[1] * law.motor.shaping.slope(&error.e_m);
    let supplied = delta_omega_l.dot(&s_l) + delta_omega_m.dot(&s_m);
    let dissipated = delta.e_l.dot(&(slope_l * delta.e_l)) + delta.e_m.dot(&(slope_m * delta.e_m))
        - 0.5 * delta.e_l.dot(&Pi_l_rate.diag_mul(&delta.e_l))
        + s_l.dot(&(robot.link_damping + law.link.damping).diag_mul(&s_l))
        + s_m.dot(&(robot.motor_damping + law.motor.damping).diag_mul(&s_m));
    // δσᵀ Ṁ⁻¹ δσ and the coupling cancel; both are of the order of what is dissipated times the condition of M.
    let expected = supplied - dissipated;
    assert!((rate - expected).abs() < 1e-10 * dissipated.abs().max(1.0), "{rate} against {expected}");
}

/// Five robots around the links, three shaping functions, constant and hardening link metrics.
fn sweep<L: Links<f64, N>, const N: usize>(links: fn() -> L, seed: u64) {
    fn one<L: Links<f64, N>, P: Shaping<f64, N>, const N: usize>(
        robot: &Fjr<f64, L, N>,
        shaping: fn(&mut Numbers) -> P,
        r: &mut Numbers,
    ) {
        for hardening in [false, true] {
            let law = gains(shaping, hardening, r);
            structure_is_the_jacobian(robot, &law, r);
            storage_balances(robot, &law, r);
        }
    }
    let mut r = Numbers(seed);
    for _ in 0..5 {
        let robot = flexible(links(), &mut r);
        one(&robot, tanh, &mut r);
        one(&robot, linear, &mut r);
        one(&robot, coupled_tanh, &mut r);
    }
}

#[test]
fn planar_arm() {
    sweep(planar, 1);
}

#[test]
fn branched_tree_under_gravity() {
    sweep(|| branched::<5>(2), 3);
}
