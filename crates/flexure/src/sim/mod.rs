//! The closed loop in time: a sampled controller on a plant that is integrated between samples.

mod closed_loop;
mod controller;
mod friction;
mod gauss;
pub mod imperfection;
mod ledger;
mod newton;
mod plant;
mod push;
mod scheme;
mod spring;
mod stepper;
mod stepping;
mod stiction;

pub use closed_loop::{Cause, ClosedLoop, Divergence, Hold, Instant, Outcome};
pub use controller::{Action, Compensation, Controller, Guarded};
pub use friction::Friction;
pub use gauss::{Integrator, StepFailure};
pub use ledger::Ledger;
pub use plant::Plant;
pub use push::{Push, Shape};
pub use spring::Hysteresis;
pub use stepper::Stepper;
pub use stepping::Stepping;
