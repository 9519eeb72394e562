//! Tests of the library: a module each, what they share in `common`.
//!
//! `cargo test -p flexure --test suite imperfections::` runs those of a module.

mod along;
mod architecture;
mod at_rest;
mod bad_files;
mod broken_off;
mod built_in;
mod certify;
mod changes;
mod closed_forms;
mod common;
mod compare;
mod controllers;
mod direct;
mod docs;
mod enclosures;
mod errata;
mod examples;
mod experiments;
mod feasible;
mod feed_forward;
mod following;
mod golden_panda;
mod golden_two_link;
mod held;
mod imperfection_files;
mod imperfections;
mod integrator;
mod limits;
mod mangled_files;
mod model_error;
mod plant;
mod plant_files;
mod random_robots;
mod rates;
mod real_loop;
mod registry;
mod report;
mod rough_plant;
mod sampled;
mod samples;
mod suites;
mod urdf;
mod verify;
