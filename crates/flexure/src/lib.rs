//! Everything offline about flexible-joint robots: files, simulation, figures and reports.

pub use flexure_core as core;

pub mod check;
pub mod compare;
pub mod design;
pub mod estimators;
pub mod eval;
pub mod excite;
pub mod feasible;
pub mod files;
pub mod identify;
pub mod imperfections;
mod lanes;
pub mod laws;
pub mod linalg;
pub mod logs;
pub mod margins;
pub mod plant;
pub mod processor;
pub mod progress;
pub mod prove;
pub mod references;
pub mod registered;
pub mod replay;
pub mod report;
pub mod reproduce;
pub mod robot;
pub mod sampled;
pub mod scenario;
pub mod simulate;
pub mod sweep;
pub mod tune;
pub mod units;
pub mod verify;

pub use files::Problems;
pub use robot::{Arm, Robot};
pub use scenario::Scenario;
pub use simulate::Loop;

/// The program of the README, compiled and run with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;
