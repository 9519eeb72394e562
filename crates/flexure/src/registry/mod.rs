//! Where names become types: robots, shaping functions and references. One new file plus one line adds a member.

mod shaping;

pub use shaping::{AnyShaping, SHAPING};

/// A registered name and what it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The name in files and on the command line.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
}
