//! Every law, at random gains.

use flexure_core::control::{
    CompositePh, ControlByInterconnection, ControlLaw, DisturbanceRejecting, DynamicLaw, IdaPbc,
    ImmersionInvariance, InnerLoop, LinkImpedance, LinkPositionFeedback, LoriaOrtega, MotorObserverPd,
    MotorPd, MotorPositionPd, MotorPositionPdCapped, Pid, PositionFeedback, SeaCascade, SlidingMode,
};
use flexure_core::linalg::Vector;

use crate::common::laws::{self, motor};
use crate::common::{Numbers, gains, linear};

/// What is done with a law.
pub trait Visitor<const N: usize> {
    fn fixed(&mut self, name: &str, law: &impl ControlLaw<f64, N>);
    fn dynamic<const K: usize>(&mut self, name: &str, law: &impl DynamicLaw<f64, N, K>);
}

pub fn immersion<const N: usize>(r: &mut Numbers) -> ImmersionInvariance<f64, N> {
    ImmersionInvariance {
        link: motor(r),
        inner: InnerLoop { position: r.between(20.0, 100.0), velocity: r.between(5.0, 20.0) },
    }
}

pub fn position_feedback<const N: usize>(r: &mut Numbers) -> PositionFeedback<f64, N> {
    PositionFeedback {
        link: motor(r),
        link_cutoff: r.between(20.0, 60.0),
        motor: motor(r),
        motor_cutoff: r.between(10.0, 60.0),
    }
}

pub fn link_position_feedback<const N: usize>(
    r: &mut Numbers,
) -> LinkPositionFeedback<f64, ImmersionInvariance<f64, N>, N> {
    let observer =
        [(40.0, 80.0), (800.0, 3e3), (1e4, 3e4), (1e4, 5e4)].map(|(low, high)| r.between(low, high));
    LinkPositionFeedback { law: immersion(r), observer }
}

/// Shows every law to `visitor`.
pub fn every<const N: usize>(visitor: &mut impl Visitor<N>, r: &mut Numbers) {
    visitor.fixed("vcbc", &gains::<_, N>(linear, false, r));
    visitor.fixed("rigid-vcbc", &laws::rigid::<N>(r));
    visitor.fixed("pd", &laws::pd::<N>(r));
    visitor.fixed("pd-online-gravity", &laws::pd_online_gravity::<N>(r));
    visitor.fixed("torque-feedback", &laws::torque_feedback::<N>(r));
    visitor.fixed("feedforward-pd", &laws::feedforward_pd::<N>(r));
    visitor.fixed("feedback-linearization", &laws::feedback_linearization::<N>(r));
    visitor.fixed("integral-manifold", &laws::integral_manifold::<N>(r));
    visitor.fixed("singular-perturbation", &laws::singular_perturbation::<N>(r));
    visitor.fixed("passivity", &laws::passivity::<N>(r));
    visitor.fixed("backstepping", &laws::backstepping::<N>(r));
    visitor.fixed("cascade", &laws::cascade::<N>(r));
    visitor.fixed("gravity-cancellation", &laws::gravity_cancellation::<N>(r));
    visitor.fixed("esp", &laws::esp::<N>(r));
    visitor.fixed("immersion-invariance", &immersion::<N>(r));
    let inertia: Vector<f64, N> = r.between(0.05, 0.3);
    visitor.fixed("ida-pbc", &IdaPbc { inertia, motor: motor(r), cross: r.between(0.1, 1.0) });
    let soft = MotorPd { stiffness: r.between(5.0, 20.0), damping: r.between(1.0, 10.0) };
    visitor.fixed("link-impedance", &LinkImpedance { inertia, motor: soft });
    visitor.fixed(
        "composite-ph",
        &CompositePh {
            shaping: r.between::<N>(5.0, 20.0),
            metric: r.between(5.0, 20.0),
            damping: r.between(1.0, 5.0),
            fast_stiffness: r.between(20.0, 80.0),
            fast_damping: r.between(1.0, 5.0),
        },
    );
    visitor.fixed(
        "sliding-mode",
        &SlidingMode {
            surface: r.between::<N>(4.0, 10.0),
            reaching: r.between(5.0, 15.0),
            authority: r.between(100.0, 500.0),
            layer: r.between(1.0, 5.0),
        },
    );
    let cutoff: Vector<f64, N> = r.between(10.0, 60.0);
    visitor.dynamic("motor-position-pd", &MotorPositionPd { motor: motor(r), cutoff });
    let [stiffness_cap, damping_cap] = [r.between(2.0, 10.0), r.between(2.0, 10.0)];
    visitor.dynamic(
        "motor-position-pd-capped",
        &MotorPositionPdCapped { motor: motor(r), cutoff, stiffness_cap, damping_cap },
    );
    visitor.dynamic(
        "motor-observer-pd",
        &MotorObserverPd {
            stiffness: r.between::<N>(20.0, 80.0),
            inertia: r.between(0.01, 0.1),
            damping: r.between(1.0, 10.0),
            coupling: r.between(20.0, 200.0),
        },
    );
    visitor.dynamic(
        "control-by-interconnection",
        &ControlByInterconnection {
            stiffness: r.between::<N>(20.0, 80.0),
            elastic: r.between(20.0, 200.0),
            viscous: r.between(1.0, 10.0),
        },
    );
    visitor.dynamic("loria-ortega", &LoriaOrtega { link: motor(r), motor: motor(r), cutoff });
    visitor.dynamic("position-feedback", &position_feedback::<N>(r));
    visitor.dynamic("link-position-feedback", &link_position_feedback::<N>(r));
    let bandwidth: Vector<f64, N> = r.between(5.0, 30.0);
    visitor.dynamic("disturbance-rejecting", &DisturbanceRejecting { law: immersion(r), bandwidth });
    let law = gains::<_, N>(linear, false, r);
    visitor.dynamic("disturbance-rejecting v-CBC", &DisturbanceRejecting { law, bandwidth });
    visitor.dynamic("pid", &Pid { motor: motor(r), integral: r.between::<N>(5.0, 50.0) });
    visitor.dynamic(
        "sea-cascade",
        &SeaCascade {
            link: motor(r),
            torque: r.between::<N>(0.5, 3.0),
            torque_integral: r.between(1.0, 4.0),
            velocity: r.between(3.0, 12.0),
            velocity_integral: r.between(5.0, 20.0),
        },
    );
}
