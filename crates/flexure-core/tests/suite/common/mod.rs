//! Robots, gains and numbers that the tests share.

pub mod laws;
pub mod plant;

use flexure_core::control::{CoupledTanh, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{Body, JointKind, PlanarTwoLink, Tree};
use flexure_core::scalar::{Dual, Jet, Over, Scalar};
use flexure_core::virtual_system::ErrorState;

/// Deterministic numbers in [−1, 1) (a linear congruential generator).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn vector<const N: usize>(&mut self, scale: f64) -> Vector<f64, N> {
        Vector::from_fn(|_| scale * self.next())
    }

    /// Entries in [low, high).
    pub fn between<const N: usize>(&mut self, low: f64, high: f64) -> Vector<f64, N> {
        self.vector::<N>(1.0).map(|x| low + 0.5 * (high - low) * (x + 1.0))
    }

    pub fn motion<const N: usize>(&mut self, scale: f64) -> Motion<f64, N> {
        let [q_l, q_m, v_l, v_m] = core::array::from_fn(|_| self.vector(scale));
        Motion { q_l, q_m, v_l, v_m }
    }

    /// Taylor series of sines with random phases.
    pub fn series<const K: usize, const N: usize>(&mut self, amplitude: f64) -> Vector<Jet<f64, K>, N> {
        Vector::from_fn(|_| Jet::variable(3.0 * self.next()).sin().scale(amplitude))
    }
}

/// The paper's arm.
pub const PLANAR: PlanarData =
    PlanarData { mass: [1.510, 0.873], length: 0.343, com: [0.159, 0.055], inertia: [0.0392, 0.00808] };

pub struct PlanarData {
    pub mass: [f64; 2],
    pub length: f64,
    pub com: [f64; 2],
    pub inertia: [f64; 2],
}

pub const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub fn rotation(roll: f64, pitch: f64, yaw: f64) -> [[f64; 3]; 3] {
    let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
}

/// A branched tree with revolute and prismatic joints about arbitrary axes.
pub fn branched<const N: usize>(seed: u64) -> Tree<f64, N> {
    Tree::new(&branched_bodies(seed), GRAVITY).expect("parents come first")
}

/// Down, on a base that stands askew.
pub const GRAVITY: [f64; 3] = [0.3, -0.2, -9.81];

/// The bodies of [`branched`].
pub fn branched_bodies<const N: usize>(seed: u64) -> [Body; N] {
    let mut r = Numbers(seed);
    core::array::from_fn(|i| {
        let axis: Vector<f64, 3> = r.vector(1.0);
        let norm = axis.dot(&axis).sqrt();
        let axis =
            if i % 3 == 1 { [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]][i % 2] } else { axis.map(|x| x / norm).0 };
        let principal: Vector<f64, 3> = r.vector(1.0).map(|x| 0.02 + 0.01 * x);
        let turn = Matrix(rotation(r.next(), r.next(), r.next()));
        Body {
            parent: if i == 0 {
                None
            } else if i % 3 == 0 {
                Some(i / 2)
            } else {
                Some(i - 1)
            },
            kind: if i % 4 == 2 { JointKind::Prismatic } else { JointKind::Revolute },
            axis,
            rotation: rotation(3.0 * r.next(), r.next(), 3.0 * r.next()),
            translation: r.vector::<3>(0.4).0,
            mass: 1.0 + 0.5 * r.next(),
            com: r.vector::<3>(0.1).0,
            inertia: (turn * Matrix::diagonal(&principal) * turn.transpose()).0,
        }
    })
}

/// A serial arm of revolute joints with the proportions of a seven-joint arm: neighbouring axes at right angles.
pub fn serial<const N: usize>() -> Tree<f64, N> {
    let bodies = core::array::from_fn(|i| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: rotation(if i % 2 == 0 { -1.0 } else { 1.0 } * core::f64::consts::FRAC_PI_2, 0.0, 0.0),
        translation: if i % 2 == 0 { [0.08, 0.0, 0.0] } else { [0.0, -0.32, 0.0] },
        mass: 3.0,
        com: [0.01, -0.03, 0.06],
        inertia: [[0.03, 0.001, 0.002], [0.001, 0.02, 0.003], [0.002, 0.003, 0.01]],
    });
    Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("parents come first")
}

pub fn close<const N: usize>(a: &Vector<f64, N>, b: &Vector<f64, N>, tolerance: f64) {
    let scale = b.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    for (x, y) in a.iter().zip(b.iter()) {
        assert!((x - y).abs() <= tolerance * scale, "{a:?} against {b:?}");
    }
}

pub fn planar() -> PlanarTwoLink<f64> {
    PlanarTwoLink::new(PLANAR.mass, PLANAR.length, PLANAR.com, PLANAR.inertia)
}

/// Springs, motors and dampers at random around the links.
pub fn flexible<L: Links<f64, N>, const N: usize>(links: L, r: &mut Numbers) -> Fjr<f64, L, N> {
    Fjr {
        links,
        motor_inertia: r.between(0.1, 0.5),
        stiffness: r.between(50.0, 200.0),
        link_damping: r.between(0.1, 1.0),
        motor_damping: r.between(0.1, 2.0),
    }
}

/// Random gains; the link metric hardens with the error if asked to.
pub fn gains<P: Shaping<f64, N>, const N: usize>(
    shaping: fn(&mut Numbers) -> P,
    hardening: bool,
    r: &mut Numbers,
) -> Vcbc<f64, P, P, N> {
    let base = r.between(20.0, 60.0);
    let metric = if hardening {
        Metric::Hardening { base, hardening: r.between(1.0, 20.0) }
    } else {
        Metric::Constant(base)
    };
    let link = LinkGains { metric, shaping: shaping(r), damping: r.between(2.0, 15.0) };
    let motor =
        MotorGains { metric: r.between(20.0, 70.0), shaping: shaping(r), damping: r.between(2.0, 10.0) };
    Vcbc { link, motor }
}

pub fn tanh<const N: usize>(r: &mut Numbers) -> Tanh<f64, N> {
    Tanh { gain: r.between(5.0, 20.0) }
}

pub fn linear<const N: usize>(r: &mut Numbers) -> Linear<f64, N> {
    Linear { gain: r.between(5.0, 20.0) }
}

pub fn coupled_tanh<const N: usize>(r: &mut Numbers) -> CoupledTanh<f64, N> {
    CoupledTanh::new(r.between(4.0, 10.0), &r.between(20.0, 60.0))
}

/// `x` moving at the rate `dx`: the gradient of what is computed from it is a rate.
pub fn moving<const N: usize>(x: &Vector<f64, N>, dx: &Vector<f64, N>) -> Vector<Dual<f64, 1>, N> {
    Vector::from_fn(|i| Dual { value: x[i], gradient: [dx[i]] })
}

/// The motion `x` with its rate, which is of the same shape.
pub fn moving_motion<const N: usize>(x: &Motion<f64, N>, dx: &Motion<f64, N>) -> Motion<Dual<f64, 1>, N> {
    Motion {
        q_l: moving(&x.q_l, &dx.q_l),
        q_m: moving(&x.q_m, &dx.q_m),
        v_l: moving(&x.v_l, &dx.v_l),
        v_m: moving(&x.v_m, &dx.v_m),
    }
}

/// The rate of the robot's motion under the motor torque `u_m`.
pub fn motion_rate<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    u_m: &Vector<f64, N>,
) -> Motion<f64, N> {
    Motion { q_l: x.v_l, q_m: x.v_m, v_l: robot.link_acceleration(x), v_m: robot.motor_acceleration(x, u_m) }
}

/// A time series as it moves with time: coefficient k + 1 gives the rate of coefficient k.
pub fn shifting<const K: usize, const K1: usize, const N: usize>(
    series: &Vector<Jet<f64, K1>, N>,
) -> Vector<Jet<Dual<f64, 1>, K>, N> {
    series.map(|x| {
        Jet::from_fn(|k| Dual { value: x.coefficient(k), gradient: [x.coefficient(k + 1) * (k + 1) as f64] })
    })
}

/// The rate of numbers that move.
pub fn rate<const N: usize>(x: &Vector<Dual<f64, 1>, N>) -> Vector<f64, N> {
    x.map(|x| x.gradient[0])
}

pub fn random_error<const N: usize>(r: &mut Numbers) -> ErrorState<f64, N> {
    let [e_l, e_m, sigma_l, sigma_m] = core::array::from_fn(|_| r.vector(1.5));
    ErrorState { e_l, e_m, sigma_l, sigma_m }
}

/// Every part of an error through `f`.
pub fn map<A, B, const N: usize>(
    x: &ErrorState<A, N>,
    f: impl Fn(&Vector<A, N>) -> Vector<B, N>,
) -> ErrorState<B, N> {
    ErrorState { e_l: f(&x.e_l), e_m: f(&x.e_m), sigma_l: f(&x.sigma_l), sigma_m: f(&x.sigma_m) }
}

/// The parts of an error in the order of x̃.
pub fn parts<T: Copy, const N: usize>(x: &ErrorState<T, N>) -> [Vector<T, N>; 4] {
    [x.e_l, x.e_m, x.sigma_l, x.sigma_m]
}
