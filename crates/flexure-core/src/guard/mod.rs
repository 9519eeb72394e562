//! What stands around a law on a real controller: finite torques inside limits whatever comes in, a safe stop where a
//! reading is bad, and a status that says when a certificate does not hold. docs/estimators.md.

mod inputs;
mod limits;
mod settings;
mod status;
mod step;

pub use inputs::{Age, Fault};
pub use settings::Settings;
pub use status::{Certificate, Phase, Status, Suspension};
pub use step::{Decision, Guard};
