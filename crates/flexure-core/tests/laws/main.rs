//! The cited laws and those with memory: golden values, identities, what they read, how memory moves from instant to instant.

mod adaptive;
mod adaptive_runs;
mod all;
#[path = "../suite/common/mod.rs"]
#[expect(dead_code, reason = "shared with the other suites")]
mod common;
mod coupled_rotors;
mod golden;
mod identities;
mod limits;
mod mpc;
mod optimal;
mod parameters;
mod reads;
mod soft_springs;
mod step;
mod unknown_torques;
