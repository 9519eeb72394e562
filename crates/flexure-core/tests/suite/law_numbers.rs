//! The law is the same function on every number type: values agree to the bit, derivatives with each other.

use flexure_core::control::{Command, Input, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Dual, Jet, Over};

use crate::common::{
    Numbers, branched, close, coupled_tanh, flexible, gains, linear, motion_rate, moving_motion, planar,
    rate, shifting, tanh,
};

fn fields<T: Copy, const N: usize>(c: &Command<T, N>) -> [Vector<T, N>; 7] {
    [c.u_m, c.u_l, c.q_md, c.e_l, c.e_m, c.s_l, c.s_m]
}

fn on<T: Over<f64>, const K: usize, const N: usize>(x: &Vector<Jet<f64, K>, N>) -> Vector<Jet<T, K>, N> {
    x.map(|x| Jet::from_fn(|k| T::constant(x.coefficient(k))))
}

fn law_is_one_function<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let x = r.motion(1.5);
    let (q_ld, omega_l) = (r.series::<6, N>(1.0), r.series::<4, N>(2.0));
    let omega = Input { link: omega_l.map(|x| x.truncate()), motor: r.vector(2.0) };
    let reference = q_ld.map(|x| x.truncate());
    let command = law.command(robot, &x, &reference, &omega);

    // Constants of other types.
    let constant_omega = Input { link: on(&omega.link), motor: omega.motor.lift() };
    let dual = law.command(robot, &x.lift::<Dual<f64, 3>>(), &on(&reference), &constant_omega);
    let constant_omega = Input { link: on(&omega.link), motor: omega.motor.lift() };
    let jet = law.command(robot, &x.lift::<Jet<f64, 3>>(), &on(&reference), &constant_omega);
    for ((value, dual), jet) in fields(&command).iter().zip(fields(&dual)).zip(fields(&jet)) {
        assert_eq!(dual, value.lift());
        assert_eq!(jet, value.lift());
    }

    // The rate along the robot's motion, by duals, by jets and by differences.
    let dx = motion_rate(robot, &x, &r.vector(20.0));
    let moving_omega = Input { link: shifting(&omega_l), motor: omega.motor.lift() };
    let dual = law.command(robot, &moving_motion(&x, &dx), &shifting(&q_ld), &moving_omega);
    let jet_of = |x: Dual<f64, 1>| Jet::new([x.value, x.gradient[0]]);
    let jets = |x: &Vector<Jet<Dual<f64, 1>, 5>, N>| x.map(|x| Jet::from_fn(|k| jet_of(x.coefficient(k))));
    let moving_omega = Input {
        link: moving_omega.link.map(|x| Jet::from_fn(|k| jet_of(x.coefficient(k)))),
        motor: omega.motor.lift(),
    };
    let jet = law.command(robot, &moving_motion(&x, &dx).map(jet_of), &jets(&shifting(&q_ld)), &moving_omega);
    for (dual, jet) in fields(&dual).iter().zip(fields(&jet)) {
        close(&rate(dual), &jet.map(|x| x.coefficient(1)), 1e-11); // another order of the same operations
    }
    gradient_is_the_limit_of_differences(robot, law, &x, &reference, &omega);
}

/// ∂u_m/∂(q_l, q_m, q̇_l, q̇_m), column by column.
fn gradient_is_the_limit_of_differences<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    x: &Motion<f64, N>,
    reference: &Vector<Jet<f64, 5>, N>,
    omega: &Input<f64, N>,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let step = 1e-5;
    for part in 0..4 {
        for i in 0..N {
            let mut direction =
                Motion { q_l: Vector::ZERO, q_m: Vector::ZERO, v_l: Vector::ZERO, v_m: Vector::ZERO };
            let slots = [&mut direction.q_l, &mut direction.q_m, &mut direction.v_l, &mut direction.v_m];
            slots.into_iter().nth(part).expect("four parts")[i] = 1.0;
            let constant_omega = Input { link: on(&omega.link), motor: omega.motor.lift() };
            let exact = law.command(robot, &moving_motion(x, &direction), &on(reference), &constant_omega);
            let beside = |h: f64| {
                let moved = moving_motion(x, &direction).map(|x| x.value + h * x.gradient[0]);
                law.command(robot, &moved, reference, omega).u_m
            };
            let difference = (beside(step) - beside(-step)).scaled(f64::recip(2.0 * step));
            // Truncation h² times third derivatives, rounding ε |u| / h: both about 1e-6 of the gradient.
            close(&rate(&exact.u_m), &difference, 1e-5);
        }
    }
}

fn sweep<L: Links<f64, N>, const N: usize>(links: fn() -> L, seed: u64) {
    let mut r = Numbers(seed);
    for hardening in [false, true] {
        let robot = flexible(links(), &mut r);
        law_is_one_function(&robot, &gains(tanh, hardening, &mut r), &mut r);
        law_is_one_function(&robot, &gains(linear, hardening, &mut r), &mut r);
        law_is_one_function(&robot, &gains(coupled_tanh, hardening, &mut r), &mut r);
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
