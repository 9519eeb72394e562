//! What is simulated: the robot of the model with what its joints do beside that, and what pushes it.

mod departures;
mod friction;
#[expect(clippy::module_inception, reason = "the plant itself")]
mod plant;
mod push;
mod spring;
mod together;

pub(crate) use departures::Departures;
pub use friction::Friction;
pub use plant::Plant;
pub(crate) use plant::Sides;
pub use push::{Push, Shape};
pub use spring::Hysteresis;
pub(crate) use spring::deflection;
