//! Tests of the kernel: a module each, the robots and numbers that they share in `common`.
//!
//! `cargo test --release -p flexure-core --test suite models::` runs those of a module. Trees with room for more joints are in `capacity`.

mod allocations;
mod closed_loop;
mod common;
mod contraction;
mod disturbances;
#[cfg(feature = "interval")]
mod enclosed_trees;
mod encoders;
mod filtered_difference;
mod guard;
mod guard_phases;
mod inverse_dynamics;
mod kernels;
#[cfg(all(feature = "interval", feature = "lanes"))]
mod law_bounds_and_batches;
mod law_equilibrium;
mod law_errors;
mod law_numbers;
mod law_storage;
mod memory;
mod models;
mod no_acceleration;
mod numbers;
mod observers;
mod operation_counts;
mod references;
mod rigid_law;
mod rotors;
mod shaping;
mod starts;
mod structure;
