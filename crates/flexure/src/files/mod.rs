//! Text on disk: documents whose every value knows its place, problems that point at it, and files that appear whole.
//!
//! Text becomes plain, validated data or a list of [`Problems`], each with the number, its unit, the allowed range, the line
//! and a hint. What the keys mean is the business of the rooms above: robots, laws, references, imperfections, scenarios.
//!
//! Angles rad, torques N m, inertias kg m², time s, everything on the link side of the gear.

mod atomic;
pub(crate) mod base;
pub(crate) mod bounds;
pub(crate) mod builtin;
mod bundle;
pub(crate) mod change;
pub(crate) mod decimals;
pub(crate) mod diagnostic;
pub(crate) mod document;
mod entry;
pub(crate) mod field;
pub(crate) mod kept;
mod leftover;
pub(crate) mod normal;
pub mod number;
pub(crate) mod provenance;
pub(crate) mod quantity;
pub(crate) mod site;
pub(crate) mod source;
mod spare;
mod states;
pub(crate) mod suggest;
pub(crate) mod table;
pub(crate) mod traced;
mod unfinished;

pub use atomic::{
    Pending, WriteError, create_folder, folder_of, prepare, prepare_for, write_atomic, write_together,
};
pub use base::{Outside, Reading};
pub use builtin::{ROBOTS, SCENARIOS, TASKS};
pub use bundle::Bundle;
pub use change::Change;
pub(crate) use diagnostic::INTERRUPTED;
pub use diagnostic::{Problem, Problems};
pub use document::Places;
pub use entry::Entry;
pub use leftover::remove_unfinished;
pub use provenance::Assumption;
pub use source::read_text;
pub use spare::spare;
pub use states::{StateFile, StateRow, States, load_states};
pub use unfinished::Unfinished;
