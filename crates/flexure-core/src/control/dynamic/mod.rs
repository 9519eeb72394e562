//! Laws with memory: filters, observers, integrators and parameters that they keep from one instant to the next.

mod adaptation;
mod adaptive_backstepping;
mod adaptive_vcbc;
mod command_filtered;
mod dirty_derivative;
mod law;
mod motor_position_pd;
mod position_feedback;
mod step;

pub use adaptation::Adaptation;
pub use adaptive_backstepping::AdaptiveCommandFilteredBackstepping;
pub use adaptive_vcbc::AdaptiveVcbc;
pub use command_filtered::CommandFilteredBackstepping;
pub use law::{Applied, DynamicLaw};
pub use motor_position_pd::{MotorPositionPd, MotorPositionPdCapped};
pub use position_feedback::PositionFeedback;
pub use step::{Running, Seen};
