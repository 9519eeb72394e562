//! Tables for the terminal.

pub(crate) mod columns;
pub(crate) mod design;
pub(crate) mod excitation;
pub(crate) mod funnel;
pub(crate) mod grid;
pub(crate) mod identified;
pub(crate) mod leaderboard;
pub(crate) mod margins;
pub(crate) mod practical;
pub(crate) mod proof;
pub(crate) mod summary;
pub(crate) mod sweep;
pub(crate) mod tube;
