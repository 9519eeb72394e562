//! Laws with memory: filters, observers, integrators and parameters that they keep from one instant to the next.

mod adaptation;
mod adaptive_backstepping;
mod adaptive_vcbc;
mod command_filtered;
mod control_by_interconnection;
mod dirty_derivative;
mod disturbance_rejecting;
mod dynamic_feedback_linearization;
mod law;
mod link_position_feedback;
mod loria_ortega;
mod motor_observer_pd;
mod motor_position_pd;
mod pid;
mod position_feedback;
mod sea_cascade;
mod step;

pub use adaptation::Adaptation;
pub use adaptive_backstepping::AdaptiveCommandFilteredBackstepping;
pub use adaptive_vcbc::AdaptiveVcbc;
pub use command_filtered::CommandFilteredBackstepping;
pub use control_by_interconnection::ControlByInterconnection;
pub use disturbance_rejecting::{DisturbanceRejecting, DisturbanceRejectingVcbc, LoadedLaw};
pub use dynamic_feedback_linearization::{DynamicFeedbackLinearization, Planned};
pub use law::{Applied, DynamicLaw};
pub use link_position_feedback::{LinkPositionFeedback, observer_gains};
pub use loria_ortega::LoriaOrtega;
pub use motor_observer_pd::MotorObserverPd;
pub(in crate::control) use motor_position_pd::motor_error;
pub use motor_position_pd::{MotorPositionPd, MotorPositionPdCapped};
pub use pid::Pid;
pub use position_feedback::PositionFeedback;
pub use sea_cascade::SeaCascade;
pub use step::{Running, Seen};
