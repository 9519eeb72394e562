//! Logs: what was measured on a robot, from CSV files with whatever names, units and signs they have.
//!
//! Flexure's own traces are read as they are; other files with a [`Columns`] that says which column is what. A log that is
//! read is evenly spaced, finite and within what the robot could do: what is not is refused, with file, line and column.

mod channel;
mod clock;
mod columns;
mod lines;
mod log;
mod plausible;
mod read;
pub(crate) mod smooth;
mod speeds;

pub use columns::Columns;
pub use log::Log;
pub use read::{FEWEST, read_log};
