//! Robot files: accepted, with a table of joints, or refused at a place.
#![no_main]

use std::path::Path;

use flexure::robot::{overview, robot_from_text};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match robot_from_text("r.toml", text, Path::new("/nonexistent")) {
        Ok(robot) => drop(overview(&robot)),
        Err(problems) => {
            assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}")
        }
    }
});
