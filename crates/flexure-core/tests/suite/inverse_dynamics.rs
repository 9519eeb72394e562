//! Inverse dynamics along trajectories, with derivatives: rigid links and the whole flexible-joint robot.

use flexure_core::linalg::Vector;
use flexure_core::model::{FeedForward, Fjr, Links, Motion};
use flexure_core::robots::Pendulum;
use flexure_core::scalar::{Dual, Jet, Scalar};

use crate::common::{Numbers, branched, close, flexible, planar, serial};

type Series<const K: usize, const N: usize> = Vector<Jet<f64, K>, N>;
/// A number with its derivative along one direction, and that with its derivative along another.
type Second = Dual<Dual<f64, 1>, 1>;

/// Torque, rate and second rate through 10 operations on numbers of 1e2 per joint.
const TOLERANCE: f64 = 1e-12;

/// Random derivatives up to order K − 1.
fn derivatives<const K: usize, const N: usize>(r: &mut Numbers) -> [Vector<f64, N>; K] {
    core::array::from_fn(|_| r.vector(2.0))
}

/// d/dt ∂L/∂q̇ − ∂L/∂q from the mass matrix and the potential energy alone, which know of no recursion over links.
fn lagrange<L: Links<f64, N>, const N: usize>(links: &L, q: &Series<5, N>) -> Series<3, N> {
    let v: Series<4, N> = q.map(|x| x.differentiate());
    let momentum = links.mass_matrix(&q.map(|x| x.truncate::<4>())) * v;
    let varied = Vector::from_fn(|i| Dual::<Jet<f64, 3>, N>::variable(q[i].truncate(), i));
    let v = v.map(|x| Dual::<_, N>::constant(x.truncate::<3>()));
    let twice_kinetic = v.dot(&(links.mass_matrix(&varied) * v));
    let slope = (Dual::from_f64(0.5) * twice_kinetic - links.potential_energy(&varied)).gradient;
    momentum.map(|x| x.differentiate()) - Vector(slope)
}

/// τ, τ̇, τ̈ by the chain rule: ∂τ/∂q q̇ + ∂τ/∂q̇ q̈ + M q⃛, and once more.
fn chain_rule<L: Links<f64, N>, const N: usize>(links: &L, x: &[Vector<f64, N>; 5]) -> [Vector<f64, N>; 3] {
    let moving = |k: usize| -> Vector<Second, N> {
        let first = |k: usize, i: usize| Dual { value: x[k][i], gradient: [x[k + 1][i]] };
        Vector::from_fn(|i| Dual { value: first(k, i), gradient: [first(k + 1, i)] })
    };
    let torque = links.inverse_dynamics(&moving(0), &moving(1), &moving(1), &moving(2));
    [
        torque.map(|x| x.value.value),
        torque.map(|x| x.value.gradient[0]),
        torque.map(|x| x.gradient[0].gradient[0]),
    ]
}

fn torques_of_the_links<L: Links<f64, N>, const N: usize>(links: &L, r: &mut Numbers) {
    for _ in 0..10 {
        let x = derivatives::<5, N>(r);
        let q = Vector::from_derivatives(&x);
        let got = links.torque_along::<_, 3, 5>(&q).derivatives();
        for (k, (by_chain, by_energy)) in
            chain_rule(links, &x).iter().zip(lagrange(links, &q).derivatives()).enumerate()
        {
            close(&got[k], by_chain, TOLERANCE);
            close(&got[k], &by_energy, TOLERANCE);
        }
        // Lower orders know nothing of higher ones.
        let [instant] = links.torque_along::<_, 1, 3>(&q.map(|x| x.truncate())).derivatives();
        assert_eq!(instant, got[0]);
    }
}

/// What moves the links with q̈ moves them with q̈.
fn forward_is_the_inverse<L: Links<f64, N>, const N: usize>(links: &L, r: &mut Numbers) {
    for _ in 0..10 {
        let [q, v, a] = derivatives::<3, N>(r);
        // The mass matrices have a condition of 1e3.
        close(&links.forward_dynamics(&q, &v, &links.inverse_dynamics(&q, &v, &v, &a)), &a, 1e-11);
    }
}

/// The robot under the torque that inverse dynamics asks for accelerates as assumed, and keeps doing so.
fn flexible_robots<L: Links<f64, N>, const N: usize>(links: L, r: &mut Numbers) {
    let robot = flexible(links, r);
    for _ in 0..10 {
        let q_l: Series<7, N> = Vector::from_derivatives(&derivatives(r));
        let FeedForward { spring, q_m, u_m }: FeedForward<f64, N, 3, 5> = robot.inverse_dynamics(&q_l);
        let x = Motion {
            q_l: q_l.map(|x| x.truncate::<3>()),
            q_m: q_m.map(|x| x.truncate()),
            v_l: q_l.map(|x| x.differentiate()),
            v_m: q_m.map(|x| x.differentiate()),
        };
        same(&robot.spring_torque(&x.q_l, &x.q_m), &spring.map(|x| x.truncate()), 1e-10);
        same(&robot.link_acceleration(&x), &q_l.map(|x| x.differentiate_twice()), 1e-10);
        same(&robot.motor_acceleration(&x, &u_m), &q_m.map(|x| x.differentiate_twice()), 1e-10);
        power_balance(&robot, &q_l, &q_m, &u_m);
    }
}

/// Ḣ = q̇_mᵀ u_m − dissipated, with two derivatives.
fn power_balance<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    q_l: &Series<7, N>,
    q_m: &Series<5, N>,
    u_m: &Series<3, N>,
) {
    let x = Motion {
        q_l: q_l.map(|x| x.truncate::<4>()),
        q_m: q_m.map(|x| x.truncate()),
        v_l: q_l.map(|x| x.differentiate()),
        v_m: q_m.map(|x| x.differentiate()),
    };
    let stored: Jet<f64, 3> = robot.total_energy(&x).differentiate();
    let power = robot.power(&x.map(|x| x.truncate::<3>()), u_m);
    let balance = power.supplied - power.dissipated;
    same(&Vector([stored]), &Vector([balance]), 1e-10);
}

fn same<const K: usize, const N: usize>(a: &Series<K, N>, b: &Series<K, N>, tolerance: f64) {
    for (a, b) in a.derivatives().iter().zip(b.derivatives()) {
        close(a, &b, tolerance);
    }
}

fn sweep<L: Links<f64, N>, const N: usize>(links: L, seed: u64) {
    let mut r = Numbers(seed);
    torques_of_the_links(&links, &mut r);
    forward_is_the_inverse(&links, &mut r);
    flexible_robots(links, &mut r);
}

#[test]
fn planar_arm() {
    sweep(planar(), 1);
}

#[test]
fn branched_tree_with_prismatic_joints() {
    sweep(branched::<6>(2), 3);
}

#[test]
fn serial_arm() {
    sweep(serial::<7>(), 4);
}

/// I q̈ + w sin q and its derivatives; then the motor's, of order 6 in q, with the numbers of one robot written out.
#[test]
fn pendulum_in_closed_form() {
    let mut r = Numbers(5);
    let (inertia, w) = (0.3, 4.0);
    let robot: Fjr<f64, _, 1> = flexible(Pendulum { inertia, weight_moment: w }, &mut r);
    for _ in 0..10 {
        let x = derivatives::<7, 1>(&mut r);
        let [q, v, a, j, s, c, p] = x.map(|x| x[0]);
        let (sin, cos) = q.sin_cos();
        // sin q and its first four derivatives.
        let sines = [
            sin,
            cos * v,
            cos * a - sin * v * v,
            cos * j - 3.0 * sin * v * a - cos * v * v * v,
            cos * s - sin * (4.0 * v * j + 3.0 * a * a) - 6.0 * cos * v * v * a + sin * v.powi(4),
        ];
        let motion = [q, v, a, j, s, c, p];
        let torque: [f64; 5] = core::array::from_fn(|k| inertia * motion[k + 2] + w * sines[k]);
        let q_l: Series<7, 1> = Vector::from_derivatives(&x);
        for (got, expected) in robot.links.torque_along::<_, 5, 7>(&q_l).derivatives().iter().zip(torque) {
            close(got, &Vector([expected]), TOLERANCE);
        }

        let [m, k, d_l, d_m] =
            [robot.motor_inertia, robot.stiffness, robot.link_damping, robot.motor_damping].map(|x| x[0]);
        let spring: [f64; 5] = core::array::from_fn(|k| torque[k] + d_l * motion[k + 1]);
        let q_m: [f64; 5] = core::array::from_fn(|i| motion[i] + spring[i] / k);
        let u_m: [f64; 3] = core::array::from_fn(|i| m * q_m[i + 2] + d_m * q_m[i + 1] + spring[i]);
        let got: FeedForward<f64, 1, 3, 5> = robot.inverse_dynamics(&q_l);
        for (got, expected) in got.q_m.derivatives().iter().zip(q_m) {
            close(got, &Vector([expected]), TOLERANCE);
        }
        for (got, expected) in got.u_m.derivatives().iter().zip(u_m) {
            close(got, &Vector([expected]), TOLERANCE);
        }
    }
}
