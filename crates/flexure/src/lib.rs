//! Everything offline about flexible-joint robots: files, simulation, figures and reports.

pub use flexure_core as core;

pub mod rates;
pub mod reference;
pub mod report;
pub mod sim;
pub mod io;
pub mod summary;
pub mod trace;
