//! Scenario files: accepted or refused at a place.
#![no_main]

use std::path::Path;

use flexure::scenario::scenario_from_text;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(problems) = scenario_from_text("s.toml", text, Path::new("/nonexistent")) {
        assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}");
    }
});
