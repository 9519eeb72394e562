//! The cited laws and those with memory: golden values, identities, what they read, how memory moves from instant to instant.

mod adaptive;
mod adaptive_runs;
#[path = "../suite/common/mod.rs"]
mod common;
mod golden;
mod identities;
mod parameters;
