//! What a list of names shows.

/// A registered name and what it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The name in files and on the command line.
    pub name: &'static str,
    /// What it is, in one line, for `flexure list`.
    pub summary: &'static str,
}
