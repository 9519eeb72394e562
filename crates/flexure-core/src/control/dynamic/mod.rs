//! Laws with memory: filters, observers, integrators and parameters that they keep from one instant to the next.

mod command_filtered;
mod dirty_derivative;
mod law;
mod motor_position_pd;
mod position_feedback;
mod step;

pub use command_filtered::CommandFilteredBackstepping;
pub use law::{Applied, DynamicLaw};
pub use motor_position_pd::{MotorPositionPd, MotorPositionPdCapped};
pub use position_feedback::PositionFeedback;
pub use step::Running;
