//! Everything offline about flexible-joint robots: files, simulation, figures and reports.

pub use flexure_core as core;

pub mod io;
pub mod rates;
pub mod reference;
pub mod registry;
pub mod report;
pub mod run;
pub mod sim;
pub mod summary;
pub mod trace;
