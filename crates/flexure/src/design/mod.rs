//! Gains from a specification: what is behind `flexure tune`.
//!
//! Gains follow from a few numbers (`family.rs`): how fast the loop is, and, of v-CBC, the scales of metrics and dampings. Where a rate is
//! to be proved, they are at least the least gains that prove it (`least.rs`, closed form). A search moves these numbers
//! (`search.rs`). Gains are good that keep every constraint (`constraint.rs`): the sampled loop stable, with its delays and with
//! what it shall bear; torque, speed, deflection and error of runs with every imperfection of the scenario inside their limits; no
//! instant at a torque limit; where the SPEC asks for a rate of the sampled loop, a tube with it (`judged.rs`). Of those the ones are best that track best without chatter, or that prove the largest rate.
//!
//! Everything follows from scenario, SPEC, budget and seed, on any number of threads.

mod bench;
mod constraint;
mod family;
mod judged;
mod least;
mod outcome;
mod search;
mod spec;
mod specified;
mod trade;
mod tube;
mod watch;

pub use constraint::{Constraint, Kind};
pub use outcome::{Design, Evidence, Feasible, design};
pub use search::BUDGET;
pub use spec::{AskedMargins, Rate, Spec, SpecFile, Uncertainty};
pub use specified::{Specified, spare_out};
pub use trade::{Effect, Trade};
pub use tube::Tube;
