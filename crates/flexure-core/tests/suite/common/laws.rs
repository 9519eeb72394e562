//! The laws that v-CBC is compared with, at random gains, and the motion that a torque makes of a state.

use flexure_core::control::{
    Backstepping, Cascade, Esp, FeedbackLinearization, FeedforwardPd, GravityCancellation, InnerLoop,
    IntegralManifold, Linear, LinkGains, Metric, MotorPd, Passivity, Pd, PdOnlineGravity, RigidVcbc,
    SingularPerturbation, TorqueFeedback,
};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use super::{Numbers, motion_rate, moving_motion};

/// Ten times on each of an arm in closed form, a branched tree and a serial arm, the last two under gravity.
#[macro_export]
macro_rules! on_three_robots {
    ($check:ident, $seed:literal) => {{
        let r = &mut $crate::common::Numbers($seed);
        for _ in 0..10 {
            $check($crate::common::planar, r);
            $check(|| $crate::common::branched::<5>(2), r);
            $check($crate::common::serial::<4>, r);
        }
    }};
}

pub fn motor<const N: usize>(r: &mut Numbers) -> MotorPd<f64, N> {
    MotorPd { stiffness: r.between(20.0, 80.0), damping: r.between(1.0, 10.0) }
}

pub fn pd<const N: usize>(r: &mut Numbers) -> Pd<f64, N> {
    Pd { motor: motor(r) }
}

pub fn pd_online_gravity<const N: usize>(r: &mut Numbers) -> PdOnlineGravity<f64, N> {
    PdOnlineGravity { motor: motor(r) }
}

pub fn torque_feedback<const N: usize>(r: &mut Numbers) -> TorqueFeedback<f64, N> {
    TorqueFeedback { inertia: r.between(0.02, 0.1), motor: motor(r) }
}

pub fn feedforward_pd<const N: usize>(r: &mut Numbers) -> FeedforwardPd<f64, N> {
    FeedforwardPd { motor: motor(r) }
}

pub fn feedback_linearization<const N: usize>(r: &mut Numbers) -> FeedbackLinearization<f64, N> {
    FeedbackLinearization {
        gains: [(1e3, 1e4), (1e3, 4e3), (100.0, 600.0), (10.0, 40.0)].map(|(low, high)| r.between(low, high)),
    }
}

pub fn integral_manifold<const N: usize>(r: &mut Numbers) -> IntegralManifold<f64, N> {
    IntegralManifold {
        position: r.between(20.0, 100.0),
        velocity: r.between(5.0, 20.0),
        damping: r.between(1.0, 5.0),
    }
}

pub fn passivity<const N: usize>(r: &mut Numbers) -> Passivity<f64, N> {
    Passivity {
        shaping: r.between(5.0, 20.0),
        link_damping: r.between(2.0, 15.0),
        motor_damping: r.between(2.0, 10.0),
    }
}

pub fn esp<const N: usize>(r: &mut Numbers) -> Esp<f64, N> {
    Esp { link_damping: r.between(2.0, 15.0), motor: motor(r) }
}

pub fn backstepping<const N: usize>(r: &mut Numbers) -> Backstepping<f64, N> {
    Backstepping {
        shaping: r.between(5.0, 20.0),
        link_damping: r.between(2.0, 15.0),
        metric: r.between(20.0, 80.0),
        motor_shaping: r.between(5.0, 20.0),
    }
}

pub fn cascade<const N: usize>(r: &mut Numbers) -> Cascade<f64, N> {
    Cascade {
        shaping: r.between(5.0, 20.0),
        link_damping: r.between(2.0, 15.0),
        inner: InnerLoop { position: r.between(20.0, 100.0), velocity: r.between(5.0, 20.0) },
    }
}

pub fn gravity_cancellation<const N: usize>(r: &mut Numbers) -> GravityCancellation<f64, N> {
    GravityCancellation { motor: motor(r) }
}

pub fn singular_perturbation<const N: usize>(r: &mut Numbers) -> SingularPerturbation<f64, N> {
    SingularPerturbation {
        position: r.between(20.0, 100.0),
        velocity: r.between(5.0, 20.0),
        damping: r.between(1.0, 5.0),
    }
}

pub fn rigid<const N: usize>(r: &mut Numbers) -> RigidVcbc<f64, Linear<f64, N>, N> {
    let link = LinkGains {
        metric: Metric::Constant(r.between(20.0, 60.0)),
        shaping: Linear { gain: r.between(5.0, 20.0) },
        damping: r.between(2.0, 15.0),
    };
    RigidVcbc { link }
}

/// A closed loop from a state on, as exact Taylor series.
pub struct Course<const N: usize> {
    /// Link positions to order 4: one more than the state alone decides.
    pub q_l: Vector<Jet<f64, 5>, N>,
    /// Motor positions to order 2.
    pub q_m: Vector<Jet<f64, 3>, N>,
}

impl<const N: usize> Course<N> {
    /// From `x` on under the motor torque `u_m` at that instant.
    pub fn new<L: Links<f64, N>>(robot: &Fjr<f64, L, N>, x: &Motion<f64, N>, u_m: &Vector<f64, N>) -> Self {
        let dx = motion_rate(robot, x, u_m);
        let moving = moving_motion(x, &dx);
        let links = robot.link_motion(&robot.links.factor(&moving.q_l), &moving);
        let q_l = links.map(|q| {
            Jet::from_fn(|k| if k < 4 { q.coefficient(k).value } else { q.coefficient(3).gradient[0] / 4.0 })
        });
        Self { q_l, q_m: Vector::from_derivatives(&[x.q_m, x.v_m, dx.v_m]) }
    }

    /// The state to order 1.
    pub fn motion(&self) -> Motion<Jet<f64, 2>, N> {
        Motion {
            q_l: self.q_l.map(|q| q.truncate()),
            q_m: self.q_m.map(|q| q.truncate()),
            v_l: self.q_l.map(|q| q.differentiate()),
            v_m: self.q_m.map(|q| q.differentiate()),
        }
    }
}

/// The state of a robot whose links are on `q_ld`, and the torque that keeps them there.
pub fn nominal<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> (Motion<f64, N>, Vector<f64, N>) {
    let feed_forward = robot.inverse_dynamics::<_, 1, 3, 5>(q_ld);
    let [q_l, v_l, ..] = q_ld.derivatives();
    let ([q_m, v_m, _], [u_m]) = (feed_forward.q_m.derivatives(), feed_forward.u_m.derivatives());
    (Motion { q_l, q_m, v_l, v_m }, u_m)
}

/// A reference that rests at `q`.
pub fn resting<const N: usize>(q: &Vector<f64, N>) -> Vector<Jet<f64, 5>, N> {
    q.map(Jet::value)
}
