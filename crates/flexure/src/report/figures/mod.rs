//! Pictures, one a file.

pub(crate) mod certificate;
pub(crate) mod comparison;
pub(crate) mod constraints;
pub(crate) mod cost;
pub(crate) mod error_path;
pub(crate) mod identified;
pub(crate) mod joint_panels;
pub(crate) mod margins;
pub(crate) mod response;
pub(crate) mod run;
pub(crate) mod score_map;
pub(crate) mod spread;
