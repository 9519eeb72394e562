//! Imperfections: what sensors, computers, drives and joints do that the ideal loop does not.

mod actuation;
pub(crate) mod document;
mod mechanics;
mod model_error;
mod registry;
mod sensing;
pub mod stages;

pub use actuation::{Deadline, Delay};
pub use document::{Imperfection, Side, Sides};
pub use mechanics::{Friction, Push, PushShape, Spring, Stribeck};
pub use model_error::{Factors, ModelError, Payload};
pub use registry::{IMPERFECTIONS, actuator, sensors};
pub use sensing::{Dropout, DropoutMode, Encoder, Noise, Outage, Sampling, VelocityFilter};
