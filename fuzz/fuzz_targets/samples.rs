//! Samples of a reference for two joints: finite numbers in order, or refused at a place.
#![no_main]

use flexure::references::samples_from_text;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| match samples_from_text("q.csv", text, 2) {
    Ok((t, q)) => {
        assert!(t.len() >= 8 && t.len() == q.len() && t.is_sorted_by(|a, b| a < b));
        assert!(q.iter().all(|q| q.len() == 2 && q.iter().all(|x| x.is_finite())));
    }
    Err(problems) => assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}"),
});
