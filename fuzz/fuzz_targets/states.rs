//! States for two joints, JSON Lines of any bytes: finite numbers, or refused at a place.
#![no_main]

use flexure::files::StateFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match StateFile::read(bytes, 2, "s.jsonl") {
    Ok(states) => {
        assert!(!states.rows.is_empty());
        for row in states.rows {
            let vectors = [&row.q_l, &row.q_m, &row.dq_l, &row.dq_m].into_iter();
            let optional = [&row.u_m, &row.ddq_l, &row.d3q_l, &row.d4q_l].into_iter().flatten();
            assert!(vectors.chain(optional).all(|x| x.len() == 2 && x.iter().all(|x| x.is_finite())));
        }
    }
    Err(problem) => assert!(problem.line_column().is_some(), "{problem}"),
});
