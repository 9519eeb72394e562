//! Control laws: v-CBC, and those it is compared with, behind [`ControlLaw`].

mod backstepping;
mod cascade;
mod dynamic;
mod esp;
mod feedback_linearization;
mod feedforward_pd;
mod gains;
mod gravity_cancellation;
mod integral_manifold;
mod law;
mod motor_pd;
mod passivity;
mod pd;
mod pd_online_gravity;
mod rigid;
mod shaping;
mod signals;
mod singular_perturbation;
mod sliding;
mod torque_feedback;
mod vcbc;

pub use backstepping::Backstepping;
pub use cascade::Cascade;
pub use dynamic::{
    Adaptation, AdaptiveCommandFilteredBackstepping, AdaptiveVcbc, CommandFilteredBackstepping, Seen,
};
pub use dynamic::{Applied, DynamicLaw, MotorPositionPd, MotorPositionPdCapped, PositionFeedback, Running};
pub use esp::Esp;
pub use feedback_linearization::FeedbackLinearization;
pub use feedforward_pd::FeedforwardPd;
pub use gains::{LinkGains, LinkTorque, Metric, MotorGains};
pub use gravity_cancellation::GravityCancellation;
pub use integral_manifold::IntegralManifold;
pub use law::ControlLaw;
pub use motor_pd::MotorPd;
pub use passivity::Passivity;
pub use pd::Pd;
pub use pd_online_gravity::PdOnlineGravity;
pub use rigid::RigidVcbc;
pub use shaping::{CoupledTanh, Linear, OddSeries, Shaping, TERMS, Tanh};
pub use signals::Signals;
pub use singular_perturbation::SingularPerturbation;
pub use torque_feedback::TorqueFeedback;
pub use vcbc::{Command, Input, Vcbc};
