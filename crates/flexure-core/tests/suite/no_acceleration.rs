//! The law needs no acceleration, no jerk and no torque.
//!
//! The types say so already: [`Vcbc::command`] takes positions, velocities and a reference. Here its ingredients run
//! on longer series in which everything it must not know is NaN, and give the same bits.

use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::common::{Numbers, branched, close, coupled_tanh, flexible, gains, linear, planar, tanh};

type Series<const K: usize, const N: usize> = Vector<Jet<f64, K>, N>;

/// The series with unknown coefficients behind the known ones.
fn poisoned<const K: usize, const KNOWN: usize, const N: usize>(x: &Series<KNOWN, N>) -> Series<K, N> {
    x.map(|x| Jet::from_fn(|k| if k < KNOWN { x.coefficient(k) } else { f64::NAN }))
}

fn two<const N: usize>(x: &Vector<f64, N>, dx: &Vector<f64, N>) -> Series<2, N> {
    Vector::from_fn(|i| Jet::new([x[i], dx[i]]))
}

fn order<const K: usize, const N: usize>(x: &Series<K, N>, k: usize) -> Vector<f64, N> {
    x.map(|x| x.coefficient(k))
}

fn same_bits<const N: usize>(a: &Vector<f64, N>, b: &Vector<f64, N>) {
    assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits), "{a:?} against {b:?}");
}

/// `KNOWN` orders are numbers and the next is not: the poison is there.
fn known_up_to<const KNOWN: usize, const K: usize, const N: usize>(x: &Series<K, N>) {
    for k in 0..KNOWN {
        assert!(order(x, k).iter().all(f64::is_finite), "order {k} of {x:?}");
    }
    assert!(order(x, KNOWN).iter().all(f64::is_nan), "order {KNOWN} of {x:?}");
}

fn law_survives_poison<L, P, const N: usize>(
    robot: &Fjr<f64, L, N>,
    law: &Vcbc<f64, P, P, N>,
    r: &mut Numbers,
) where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let x = r.motion(1.5);
    let (q_ld, omega): (Series<5, N>, _) =
        (r.series(1.0), Input { link: r.series(2.0), motor: r.vector(2.0) });
    let command = law.command(robot, &x, &q_ld, &omega);

    let links = &robot.links;
    let motion: Series<7, N> = poisoned(&robot.link_motion(&links.factor(&x.q_l), &x));
    let (q, v): (Series<6, N>, Series<6, N>) =
        (motion.map(|x| x.truncate()), motion.map(|x| x.differentiate()));
    let link = law.link.torque(&robot.link_damping, &motion, &poisoned::<8, 5, N>(&q_ld), |v_r, a_r| {
        links.inverse_dynamics(&q, &v, v_r, a_r)
    });
    let u_l = link.torque + poisoned(&omega.link);
    known_up_to::<3, 6, N>(&u_l);

    // Of the motors, position and velocity are known and nothing else.
    let q_md = q + robot.stiffness.map(f64::recip).diag_mul(&u_l);
    let e_m = poisoned::<6, 2, N>(&two(&x.q_m, &x.v_m)) - q_md;
    let ratio = Vector::<f64, N>::from_fn(|i| robot.stiffness[i] / law.motor.metric[i]);
    let v_mr = q_md.map(|x| x.differentiate::<5>())
        - law.motor.shaping.eval(&e_m.map(|x| x.truncate::<5>()))
        - ratio.diag_mul(&link.velocity_error.map(|x| x.truncate::<5>()));
    known_up_to::<2, 5, N>(&v_mr);
    let s_m = x.v_m - order(&v_mr, 0);
    let u_m = robot.motor_inertia.diag_mul(&order(&v_mr, 1))
        + robot.spring_torque(&x.q_l, &x.q_m)
        + robot.motor_damping.diag_mul(&order(&v_mr, 0))
        - law.motor.metric.diag_mul(&order(&e_m, 0))
        - law.motor.damping.diag_mul(&s_m)
        + omega.motor;

    same_bits(&command.u_l, &order(&u_l, 0));
    same_bits(&command.e_m, &order(&e_m, 0));
    same_bits(&command.s_l, &order(&link.velocity_error, 0));
    same_bits(&command.s_m, &s_m);
    same_bits(&command.u_m, &u_m);
}

/// q̈_l and q⃛_l of the law against Taylor integration of the robot.
fn jerk_follows_from_the_state<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, r: &mut Numbers) {
    let x = r.motion(1.5);
    let expected = robot.link_motion(&robot.links.factor(&x.q_l), &x);

    // The links alone, the motors' future unknown: orders up to 3 exist and order 4 does not.
    let q_m: Series<6, N> = poisoned(&two(&x.q_m, &x.v_m));
    let links_alone = taylor(robot, &x, |_, _| q_m);
    known_up_to::<4, 6, N>(&links_alone);

    // The whole robot under two torques: they show from order 4 on.
    let [first, second] = core::array::from_fn(|_| {
        let u: Series<6, N> = r.series(20.0);
        taylor(robot, &x, |q_l, q_m| motor_step(robot, q_l, q_m, &u))
    });
    for k in 0..4 {
        same_bits(&order(&first, k), &order(&second, k));
        same_bits(&order(&first, k), &order(&links_alone, k));
        // The same quantity through other operations, solving with a matrix of condition 1e3.
        close(&order(&first, k), &order(&expected, k), 1e-11);
    }
    assert_ne!(order(&first, 4), order(&second, 4));
}

/// Taylor integration: each pass through the dynamics makes one more coefficient of q_l right. `motors` gives the
/// motor positions from the links' and its own last answer.
fn taylor<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    mut motors: impl FnMut(&Series<6, N>, &Series<6, N>) -> Series<6, N>,
) -> Series<6, N> {
    let mut q_l: Series<6, N> = poisoned(&two(&x.q_l, &x.v_l));
    let mut q_m: Series<6, N> = poisoned(&two(&x.q_m, &x.v_m));
    for _ in 0..4 {
        q_m = motors(&q_l, &q_m);
        q_l = twice_integrated(&q_l, &robot.link_acceleration(&moving(&q_l, &q_m)));
    }
    q_l
}

fn motor_step<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    q_l: &Series<6, N>,
    q_m: &Series<6, N>,
    u: &Series<6, N>,
) -> Series<6, N> {
    twice_integrated(q_m, &robot.motor_acceleration(&moving(q_l, q_m), u))
}

fn moving<const N: usize>(q_l: &Series<6, N>, q_m: &Series<6, N>) -> Motion<Jet<f64, 6>, N> {
    let velocity = |q: &Series<6, N>| poisoned(&q.map(|x| x.differentiate::<5>()));
    Motion { q_l: *q_l, q_m: *q_m, v_l: velocity(q_l), v_m: velocity(q_m) }
}

fn twice_integrated<const N: usize>(q: &Series<6, N>, a: &Series<6, N>) -> Series<6, N> {
    Vector::from_fn(|i| {
        Jet::from_fn(|k| match k {
            0 | 1 => q[i].coefficient(k),
            _ => a[i].coefficient(k - 2) / (k * (k - 1)) as f64,
        })
    })
}

fn sweep<L: Links<f64, N>, const N: usize>(links: fn() -> L, seed: u64) {
    let mut r = Numbers(seed);
    for hardening in [false, true] {
        let robot = flexible(links(), &mut r);
        law_survives_poison(&robot, &gains(tanh, hardening, &mut r), &mut r);
        law_survives_poison(&robot, &gains(linear, hardening, &mut r), &mut r);
        law_survives_poison(&robot, &gains(coupled_tanh, hardening, &mut r), &mut r);
        jerk_follows_from_the_state(&robot, &mut r);
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
