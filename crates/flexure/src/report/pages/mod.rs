//! HTML pages, all from one kit.

pub(crate) mod certificates;
pub(crate) mod certify;
pub(crate) mod identify;
pub(crate) mod kit;
pub(crate) mod leaderboard;
pub(crate) mod margins;
pub(crate) mod markdown;
pub(crate) mod practical;
pub(crate) mod run;
pub(crate) mod runs;
pub(crate) mod sweep;
pub(crate) mod tune;
