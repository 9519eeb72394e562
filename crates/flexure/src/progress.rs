//! Long jobs tell how far they are, and can be broken off.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// What is told the fraction of a job that is done, and breaks it off by [`ControlFlow::Break`].
pub type Progress<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// The same for a job of several parts side by side: the number of the part, and the fraction of it that is done.
pub type PartProgress<'a> = &'a (dyn Fn(usize, f64) -> ControlFlow<()> + Sync);

/// Progress that nobody watches: never breaks a job off.
pub fn unwatched(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Parts of a job that are done side by side and count the same: the fraction done of the whole is their mean.
#[derive(Debug)]
pub struct Parts(Vec<AtomicU64>);

impl Parts {
    /// So many parts, of which nothing is done.
    pub fn new(count: usize) -> Self {
        Self((0..count).map(|_| AtomicU64::new(0.0_f64.to_bits())).collect())
    }

    /// The fraction done of the whole now that `fraction` of `part` is.
    pub fn with(&self, part: usize, fraction: f64) -> f64 {
        self.0[part].store(fraction.to_bits(), Ordering::Relaxed);
        let done = self.0.iter().map(|part| f64::from_bits(part.load(Ordering::Relaxed)));
        done.sum::<f64>() / self.0.len() as f64
    }
}
