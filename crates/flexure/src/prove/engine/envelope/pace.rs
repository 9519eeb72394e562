//! How long the slabs of a funnel are.

use flexure_core::scalar::Interval;

/// A slab is halved so often at most.
const HALVED: i32 = 7;

/// Of what drives the errors, the part that numbers of a slab leave open: slabs are halved above the first, doubled below the second.
const OPEN_PART: [f64; 2] = [0.03, 0.01];

/// Shorter slabs are of use where at an instant that part is so much of what it is over the slab, or less.
const USEFUL: f64 = 0.5;

/// What was of no use is tried again after so many slabs.
const AGAIN: usize = 16;

/// Length of the slabs: as long as what they leave open of the motion counts for little.
pub struct Pace {
    longest: f64,
    step: f64,
    /// Slabs to go before shorter ones are thought of again, and longer ones.
    shorter_in: usize,
    longer_in: usize,
}

impl Pace {
    /// Of `longest` s to begin with.
    pub fn new(longest: f64) -> Self {
        Self { longest, step: longest, shorter_in: 0, longer_in: 0 }
    }

    /// The slab from `time` on in a run of `duration` s.
    pub fn next(&self, time: f64, duration: f64) -> Interval {
        // No slab that is much shorter than others at the end.
        let end = if time + 1.5 * self.step < duration { time + self.step } else { duration };
        Interval::new(time, end).unwrap_or(Interval::ENTIRE)
    }

    /// Halves it, for a while; not below the shortest.
    pub fn shorter(&mut self) -> bool {
        let may = self.step > self.longest * 0.5_f64.powi(HALVED);
        if may {
            self.step *= 0.5;
            self.longer_in = AGAIN;
        }
        may
    }

    /// Takes into account which part of what drives the errors a slab left open, and would leave open if it were an instant: what errors
    /// leave open, and not times, shorter slabs do not help. None if `at_once` is.
    pub fn saw(&mut self, part: f64, at_once: impl FnOnce() -> Option<f64>) -> Option<()> {
        let [most, least] = OPEN_PART;
        self.shorter_in = self.shorter_in.saturating_sub(1);
        self.longer_in = self.longer_in.saturating_sub(1);
        if part < least && self.longer_in == 0 {
            self.step = self.longest.min(2.0 * self.step);
        } else if part > most && self.shorter_in == 0 && !(at_once()? < USEFUL * part && self.shorter()) {
            self.shorter_in = AGAIN;
        }
        Some(())
    }
}
