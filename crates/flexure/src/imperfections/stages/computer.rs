//! When the computer runs, and whether its commands get out in time.

use flexure_core::memory::{Memory, Port};

use crate::imperfections::stages::Tick;

/// Commands that do not get out in time.
pub trait Missing: Memory<f64> + Send + Sync {
    /// Whether that of this instant does not. Asked once an instant at which the computer runs.
    fn misses(&mut self, instant: &Tick) -> bool;
}

/// A computer; by default one that is always in time.
#[derive(Default)]
pub struct Computer {
    /// It stands still at instants in [from, until) \[s\].
    stalls: Vec<[f64; 2]>,
    /// Each with the kind that it is of.
    missing: Vec<(&'static str, Box<dyn Missing>)>,
}

impl Computer {
    /// Stands still at instants in [from, until) of `stalls` \[s\]; `missing` of named kinds keep commands back.
    pub fn new(stalls: Vec<[f64; 2]>, missing: Vec<(&'static str, Box<dyn Missing>)>) -> Self {
        Self { stalls, missing }
    }

    /// Whether a command comes at every instant.
    pub fn is_in_time(&self) -> bool {
        self.stalls.is_empty() && self.missing.is_empty()
    }

    /// Whether it does nothing at this instant: it reads nothing, decides nothing, commands nothing.
    pub fn is_still(&self, instant: &Tick) -> bool {
        self.stalls.iter().any(|&[from, until]| instant.is_within(from, until))
    }

    /// Whether the command of this instant does not get out in time.
    pub fn misses(&mut self, instant: &Tick) -> bool {
        // Each is asked: random numbers are drawn whether they matter or not.
        self.missing.iter_mut().fold(false, |missed, (_, missing)| missing.misses(instant) | missed)
    }
}

/// What keeps commands back, in order, under the name of its kind.
impl Memory<f64> for Computer {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (kind, missing) in &mut self.missing {
            port.part(kind, missing.as_mut());
        }
    }
}
