//! How much of what could be shown is left unclaimed.

/// What a certificate leaves unclaimed so that checkers, which round differently, see it too: in steps, each leaving more
/// than the one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reserve(u8);

impl Reserve {
    /// The last step.
    const LAST: u8 = 4;

    /// The next step, leaving more; none after the last.
    pub fn more(self) -> Option<Self> {
        (self.0 < Self::LAST).then_some(Self(self.0 + 1))
    }

    /// By how much rates and measures stay on the safe side of what was found, relatively: pivots then are as many times
    /// larger than their rounding.
    pub fn relative(self) -> f64 {
        1e-13 * 100_f64.powi(i32::from(self.0))
    }

    /// The part of a pivot that is claimed as a margin.
    pub fn claimed(self) -> f64 {
        0.5 * 0.01_f64.powi(i32::from(self.0))
    }

    /// How many of the closest chains that bound a mass matrix are passed over.
    pub fn skipped(self) -> usize {
        2 * usize::from(self.0)
    }
}
