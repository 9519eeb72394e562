//! Long jobs: beside the interpreter, with progress, and broken off by Ctrl-C.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use flexure::progress::Progress;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often signals are looked at and progress is told.
const EVERY: Duration = Duration::from_millis(50);

/// Stack of the thread that a job runs in: that of a main thread.
const STACK: usize = 8 << 20;

/// What `job` gives, which runs in a thread of its own while the interpreter is free. `progress` is called with the fraction done; what it
/// raises, and Ctrl-C, break the job off and come out here.
///
/// # Panics
/// As `job`: a panic becomes an exception.
pub fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    job: impl FnOnce(Progress<'_>) -> T + Send,
) -> PyResult<T> {
    let (fraction, broken_off) = (AtomicU64::new(0), AtomicBool::new(false));
    let tell = |done: f64| {
        fraction.store(done.to_bits(), Ordering::Relaxed);
        if broken_off.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let (caller, ended) = (thread::current(), AtomicBool::new(false));
    thread::scope(|scope| {
        let work = || {
            let result = job(&tell);
            ended.store(true, Ordering::Release);
            caller.unpark();
            result
        };
        let worker = thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, work)
            .map_err(|error| PyRuntimeError::new_err(format!("no thread for the work: {error}")))?;
        let mut told = py.check_signals();
        // One that panicked is finished and has not ended.
        while told.is_ok() && !ended.load(Ordering::Acquire) && !worker.is_finished() {
            py.detach(|| thread::park_timeout(EVERY));
            told = py.check_signals().and_then(|()| match progress {
                Some(progress) => {
                    progress.call1((f64::from_bits(fraction.load(Ordering::Relaxed)),)).map(drop)
                }
                None => Ok(()),
            });
        }
        if told.is_err() {
            broken_off.store(true, Ordering::Relaxed);
        }
        let result = py.detach(|| worker.join());
        told?;
        Ok(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

/// Panics in a job: what the tests see of bugs to come.
#[pyfunction]
#[pyo3(name = "_panic")]
pub fn panic(py: Python<'_>) -> PyResult<()> {
    watched(py, None, |_| panic!("asked for"))
}
