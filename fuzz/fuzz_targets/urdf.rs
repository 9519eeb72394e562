//! URDF files: a draft of a robot file, or refused at a place.
#![no_main]

use flexure::robot::import_text;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(problems) = import_text("r.urdf", text, &[]) {
        assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}");
    }
});
