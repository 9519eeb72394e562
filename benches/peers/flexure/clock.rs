//! Time of short passes.

use std::time::{Duration, Instant};

/// The least time of a `pass` in ns, of as many as fit into `milliseconds`. A pass is shorter than what a scheduler gives, so
/// the least one was not interrupted: it is the time of one core, whatever else the machine does.
pub fn least(milliseconds: u64, pass: &mut dyn FnMut()) -> f64 {
    pass();
    let end = Instant::now() + Duration::from_millis(milliseconds);
    let mut least = Duration::MAX;
    while Instant::now() < end {
        let start = Instant::now();
        pass();
        least = least.min(start.elapsed());
    }
    least.as_secs_f64() * 1e9
}
