//! What stands around a law on a real controller: finite torques inside limits whatever comes in, a safe stop where a
//! reading is bad, and a status that says when a certificate does not hold. docs/estimators.md.
//!
//! [`Guard`] decides; [`Coasting`] bridges readings that are lost for a short while, before the estimator; [`Watchdog`] runs in the
//! drive.

mod clock;
mod coasting;
mod collision;
mod faults;
mod handover;
mod limits;
mod log;
mod phases;
mod plausibility;
mod settings;
mod status;
mod step;
mod watchdog;

pub use coasting::Coasting;
pub use collision::{Collision, Reaction};
pub use faults::{Age, Fault, Place};
pub use log::{Entry, Log, Step};
pub use phases::Phase;
pub use plausibility::{Frozen, Plausible};
pub use settings::{Latch, Rejoin, Settings};
pub use status::{Certificate, Status, Suspension};
pub use step::{Decision, Guard, Seen, Torques};
pub use watchdog::Watchdog;
