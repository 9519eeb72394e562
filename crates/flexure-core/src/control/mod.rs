//! Control laws: v-CBC, and those it is compared with, behind [`ControlLaw`].

mod backstepping;
mod cascade;
mod composite_ph;
mod dynamic;
mod esp;
mod feedback_linearization;
mod feedforward_pd;
mod gains;
mod gravity_cancellation;
mod ida_pbc;
mod immersion_invariance;
mod inner_loop;
mod integral_manifold;
mod law;
mod link_impedance;
mod motor_pd;
mod optimal;
mod passivity;
mod pd;
mod pd_online_gravity;
mod rigid;
mod shaping;
mod signals;
mod singular_perturbation;
mod sliding;
mod sliding_mode;
mod torque_feedback;
mod vcbc;

pub use backstepping::Backstepping;
pub use cascade::Cascade;
pub use composite_ph::CompositePh;
pub use dynamic::{
    Adaptation, AdaptiveCommandFilteredBackstepping, AdaptiveVcbc, Applied, CommandFilteredBackstepping,
    ControlByInterconnection, DisturbanceRejecting, DisturbanceRejectingVcbc, DynamicFeedbackLinearization,
    DynamicLaw, LinkPositionFeedback, LoadedLaw, LoriaOrtega, MotorObserverPd, MotorPositionPd,
    MotorPositionPdCapped, Pid, Planned, PositionFeedback, Running, SeaCascade, Seen, observer_gains,
};
pub use esp::Esp;
pub use feedback_linearization::FeedbackLinearization;
pub use feedforward_pd::FeedforwardPd;
pub use gains::{LinkGains, LinkTorque, Metric, MotorGains};
pub use gravity_cancellation::GravityCancellation;
pub use ida_pbc::IdaPbc;
pub use immersion_invariance::ImmersionInvariance;
pub use inner_loop::InnerLoop;
pub use integral_manifold::IntegralManifold;
pub use law::ControlLaw;
pub use link_impedance::{LinkImpedance, in_series};
pub use motor_pd::MotorPd;
pub use optimal::{HInfinity, LinearModel, Lqr, Mpc, NoRegulator, QuadraticCost, Regulator};
pub use passivity::Passivity;
pub use pd::Pd;
pub use pd_online_gravity::PdOnlineGravity;
pub use rigid::RigidVcbc;
pub use shaping::{CoupledTanh, Linear, OddSeries, Shaping, TERMS, Tanh};
pub use signals::Signals;
pub use singular_perturbation::SingularPerturbation;
pub use sliding_mode::SlidingMode;
pub use torque_feedback::TorqueFeedback;
pub use vcbc::{Command, Input, Vcbc};
