//! URDF files: the XML of ROS for rigid robots.
//!
//! What moves and what it weighs is read, and for pictures what it looks like; sensors and plug-ins are passed over. A file of unknown
//! origin is harmless: size, nesting and number of elements are bounded, nothing is recursed into, expanded or opened.

mod drive_table;
mod effort;
mod joint;
mod link;
pub(crate) mod looks;
mod node;
mod sidecar;
mod tree;
mod xml;

pub use sidecar::{Import, ImportOptions, import, import_text};
pub(crate) use tree::{Locks, Urdf};

/// Largest URDF that is read \[bytes\].
pub(crate) const LIMIT: u64 = 2 << 20;

use crate::files::document::Log;

/// Reads the file of `log`.
pub(crate) fn with<T>(log: &Log, then: impl FnOnce(Urdf<'_>) -> Option<T>) -> Option<T> {
    let root = xml::parse(log)?;
    then(tree::read(&root, log)?)
}
