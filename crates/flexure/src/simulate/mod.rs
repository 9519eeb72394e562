//! The closed loop in time: a sampled controller on a plant that is integrated between samples; runs with trace and summary.

mod assembly;
mod closed_loop;
mod controller;
mod figures;
mod gauss;
mod ledger;
mod limits;
mod newton;
mod preload;
mod recorder;
mod run;
mod scheme;
mod stepper;
mod stepping;
mod stiction;
mod summary;
mod trace;
mod write_trace;

pub use assembly::TOLERANCE;
pub use closed_loop::{Cause, ClosedLoop, Divergence, Hold, Instant, Outcome};
pub use controller::{Action, Compensation, Controller, Guarded};
pub use figures::SETTLED;
pub use gauss::{Integrator, StepFailure};
pub use ledger::Ledger;
pub use limits::exceeded;
pub use preload::preload;
pub use run::{Run, measure, run};
pub use stepper::Stepper;
pub use stepping::Stepping;
pub use summary::Summary;
pub use trace::{Column, Trace};
pub use write_trace::write_trace;
