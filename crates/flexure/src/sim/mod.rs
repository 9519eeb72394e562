//! The closed loop in time: a sampled controller on a plant that is integrated between samples.

mod closed_loop;
mod gauss;
pub mod imperfection;
mod ledger;
mod newton;
mod plant;
mod scheme;

pub use closed_loop::{Cause, ClosedLoop, Divergence, Hold, Instant, Outcome};
pub use gauss::{Integrator, StepFailure};
pub use ledger::Ledger;
pub use plant::Plant;
