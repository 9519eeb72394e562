//! The law gives the virtual system the closed loop of the theory: momentum errors, couplings, reference and input
//! derivatives, whatever the robot itself does.

use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, State};
use flexure_core::scalar::Jet;
use flexure_core::virtual_system::{closed_loop, error_coordinates, virtual_dynamics};

use crate::common::{
    Numbers, branched, close, coupled_tanh, flexible, gains, linear, map, motion_rate, moving, moving_motion,
    parts, planar, rate, shifting, tanh,
};

type Series<const K: usize, const N: usize> = Vector<Jet<f64, K>, N>;

fn truncated<const J: usize, const K: usize, const N: usize>(x: &Series<K, N>) -> Series<J, N> {
    x.map(|x| x.truncate::<J>())
}

/// d/dt of the error coordinates along virtual system and robot, exactly, against the closed form.
fn law_gives_the_closed_loop<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let (x, x_v) = (r.motion(1.5), r.motion(1.5));
    // The momenta of the virtual system are M(q) v_v at the real q.
    let x_v_state = State { p_l: robot.links.mass_mul(&x.q_l, &x_v.v_l), ..robot.state(&x_v) };
    let (q_ld, omega_l): (Series<6, N>, Series<4, N>) = (r.series(1.0), r.series(2.0));
    let omega = Input { link: truncated(&omega_l), motor: r.vector(2.0) };
    let command = law.virtual_command(robot, &x_v, &x, &truncated(&q_ld), &omega);

    // The robot itself moves under any torque: contraction is a property of the virtual system along it.
    let dx = motion_rate(robot, &x, &r.vector(20.0));
    let dx_v = virtual_dynamics(robot, &x_v_state, &x, &command.u_m);
    let moving_x_v = State {
        q_l: moving(&x_v_state.q_l, &dx_v.q_l),
        q_m: moving(&x_v_state.q_m, &dx_v.q_m),
        p_l: moving(&x_v_state.p_l, &dx_v.p_l),
        p_m: moving(&x_v_state.p_m, &dx_v.p_m),
    };
    let moving_omega = Input { link: shifting(&omega_l), motor: omega.motor.lift() };
    let error =
        error_coordinates(robot, law, &moving_x_v, &moving_motion(&x, &dx), &shifting(&q_ld), &moving_omega);

    let expected = closed_loop(robot, law, &map(&error, |e| e.map(|e| e.value)), &x, &omega);
    // What cancels is the motor torque, of 1e4 N m and more: a few hundred operations on it leave 1e-13 of it.
    let torque = command.u_m.iter().fold(1.0, |m: f64, u| m.max(u.abs()));
    for (got, expected) in parts(&map(&error, rate)).iter().zip(parts(&expected)) {
        for (g, e) in got.iter().zip(expected.iter()) {
            assert!((g - e).abs() <= 1e-12 * torque, "{got:?} against {expected:?} with torques of {torque}");
        }
    }
}

/// On x_v = x the virtual system is the robot and the virtual law the law.
fn robot_is_a_virtual_system<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let (x, u) = (r.motion(1.5), r.vector(20.0));
    let (q_ld, omega): (Series<5, N>, _) =
        (r.series(1.0), Input { link: r.series(2.0), motor: r.vector(2.0) });
    let state = robot.state(&x);
    let (real, copy) = (robot.hamiltonian_dynamics(&state, &u), virtual_dynamics(robot, &state, &x, &u));
    let (command, same) =
        (law.command(robot, &x, &q_ld, &omega), law.virtual_command(robot, &x, &x, &q_ld, &omega));
    for (a, b) in [
        (real.q_l, copy.q_l),
        (real.q_m, copy.q_m),
        (real.p_l, copy.p_l),
        (real.p_m, copy.p_m),
        (command.u_m, same.u_m),
        (command.u_l, same.u_l),
        (command.q_md, same.q_md),
        (command.e_l, same.e_l),
        (command.e_m, same.e_m),
        (command.s_l, same.s_l),
        (command.s_m, same.s_m),
    ] {
        // A few hundred operations that lose the condition number of M, 1e3, at most.
        close(&a, &b, 1e-11);
    }
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
            law_gives_the_closed_loop(robot, &law, r);
            robot_is_a_virtual_system(robot, &law, r);
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
