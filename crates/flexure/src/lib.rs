//! Everything offline about flexible-joint robots: files, simulation, figures and reports.

pub use flexure_core as core;

pub mod along;
pub mod certify;
pub mod compare;
pub mod confirmation;
pub mod evaluate;
pub mod experiment;
pub mod feasible;
pub mod io;
pub mod linalg;
pub mod margins;
pub mod overview;
pub mod paper;
pub mod proof;
pub mod proof_summary;
pub mod rates;
pub mod reference;
pub mod registry;
pub mod report;
pub mod run;
pub mod sampling;
pub mod sim;
pub mod summary;
pub mod trace;
pub mod tune;
pub mod units;
pub mod verify;

/// The program of the README, compiled and run with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;
