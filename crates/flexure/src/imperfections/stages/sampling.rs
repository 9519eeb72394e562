//! Sensors that are slower than the law.

use crate::imperfections::stages::held::Held;
use crate::imperfections::stages::{Measured, PerSide, Sensing, Tick};

/// Delivers readings every so many control periods and holds them in between.
#[derive(Clone, Debug)]
pub struct Sampling<const N: usize> {
    periods: PerSide<u32>,
    held: PerSide<Held<N>>,
}

impl<const N: usize> Sampling<N> {
    /// Control periods from one delivery to the next per side, ≥ 1; the first one is at k = 0.
    pub fn new(periods: PerSide<u32>) -> Self {
        Self { periods, held: [Held::NOTHING; 2] }
    }
}

impl<const N: usize> Sensing<N> for Sampling<N> {
    fn sense(&mut self, instant: &Tick, measured: &mut Measured<N>) {
        for (side, (held, periods)) in self.held.iter_mut().zip(self.periods).enumerate() {
            if instant.k.is_multiple_of(u64::from(periods)) {
                held.keep(measured, side);
            } else {
                held.give(measured, side);
            }
        }
    }
}
