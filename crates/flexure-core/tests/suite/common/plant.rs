//! A robot that moves: Runge–Kutta in steps far below the control period.

use flexure_core::control::{Linear, LinkGains, Metric, MotorGains, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::PlanarTwoLink;

use super::{motion_rate, planar};

/// Control period in s.
pub const PERIOD: f64 = 1e-3;

pub type Arm = Fjr<f64, PlanarTwoLink<f64>, 2>;

/// The paper's arm with the drives that its table prints: motor damping over inertia is 9000 1/s.
pub fn paper_arm() -> Arm {
    Fjr {
        links: planar(),
        motor_inertia: Vector([0.23, 0.01]),
        stiffness: Vector([9.0, 4.0]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([0.2, 90.0]),
    }
}

/// The same links with the drives of the maker's sister plant.
pub fn plausible_arm() -> Arm {
    Fjr {
        links: planar(),
        motor_inertia: Vector([0.0635, 0.00302]),
        stiffness: Vector([39.96, 6.86]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([4.0, 1.5]),
    }
}

/// No friction anywhere: nothing helps an estimate but the estimator.
pub fn undamped(arm: Arm) -> Arm {
    Fjr { link_damping: Vector([0.0; 2]), motor_damping: Vector([0.0; 2]), ..arm }
}

/// Torques from outside, on links and motors [N m].
#[derive(Clone, Copy)]
pub struct Push<const N: usize> {
    pub link: Vector<f64, N>,
    pub motor: Vector<f64, N>,
}

impl<const N: usize> Push<N> {
    pub const NONE: Self = Self { link: Vector::ZERO, motor: Vector::ZERO };
}

fn plus<const N: usize>(x: &Motion<f64, N>, rate: &Motion<f64, N>, dt: f64) -> Motion<f64, N> {
    Motion {
        q_l: x.q_l + rate.q_l.scaled(dt),
        q_m: x.q_m + rate.q_m.scaled(dt),
        v_l: x.v_l + rate.v_l.scaled(dt),
        v_m: x.v_m + rate.v_m.scaled(dt),
    }
}

/// `x` after the time `span` in s under constant torques, in `steps` steps of order 4.
pub fn advance<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    u_m: &Vector<f64, N>,
    push: &Push<N>,
    span: f64,
    steps: u32,
) -> Motion<f64, N> {
    let dt = span / f64::from(steps);
    let rate = |x: &Motion<f64, N>| Motion {
        v_l: robot.links.forward_dynamics(&x.q_l, &x.v_l, &(robot.link_torque(x) + push.link)),
        ..motion_rate(robot, x, &(*u_m + push.motor))
    };
    (0..steps).fold(*x, |x, _| {
        let k_1 = rate(&x);
        let k_2 = rate(&plus(&x, &k_1, dt / 2.0));
        let k_3 = rate(&plus(&x, &k_2, dt / 2.0));
        let k_4 = rate(&plus(&x, &k_3, dt));
        let ends = plus(&plus(&x, &k_1, dt / 6.0), &k_4, dt / 6.0);
        plus(&plus(&ends, &k_2, dt / 3.0), &k_3, dt / 3.0)
    })
}

/// Largest difference of two motions: positions in rad, velocities over `per` [1/s]; infinite if one is not a number.
pub fn distance<const N: usize>(a: &Motion<f64, N>, b: &Motion<f64, N>, per: f64) -> f64 {
    let largest = |a: &Vector<f64, N>, b: &Vector<f64, N>| {
        (*a - *b).iter().fold(0.0, |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
    };
    [
        largest(&a.q_l, &b.q_l),
        largest(&a.q_m, &b.q_m),
        largest(&a.v_l, &b.v_l) / per,
        largest(&a.v_m, &b.v_m) / per,
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

/// Gentle gains that hold and move the arms above.
pub fn gentle() -> Vcbc<f64, Linear<f64, 2>, Linear<f64, 2>, 2> {
    let shaping = Linear { gain: Vector([4.0, 4.0]) };
    Vcbc {
        link: LinkGains {
            metric: Metric::Constant(Vector([4.0, 1.0])),
            shaping,
            damping: Vector([1.0, 0.3]),
        },
        motor: MotorGains { metric: Vector([30.0, 6.0]), shaping, damping: Vector([0.5, 0.1]) },
    }
}

/// A torque that keeps a robot moving, over one control period [N m].
pub fn stirring<const N: usize>(size: f64, t: f64) -> Vector<f64, N> {
    Vector::from_fn(|i| size * (1.0 + 0.5 * i as f64) * ((3.0 + i as f64) * t).cos())
}

/// What the robot does from `x` on, stirred by torques of the size `torque`: motion and torque per period.
pub fn course<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    torque: f64,
    periods: u32,
) -> Vec<(Motion<f64, N>, Vector<f64, N>)> {
    let mut x = *x;
    (0..periods)
        .map(|k| {
            let u = stirring(torque, f64::from(k) * PERIOD);
            x = advance(robot, &x, &u, &Push::NONE, PERIOD, 20);
            (x, u)
        })
        .collect()
}
