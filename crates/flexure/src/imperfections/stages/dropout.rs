//! Sensors that fall silent for a while.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::held::Held;
use crate::imperfections::stages::{Measured, PerSide, Random, Sensing, Tick};

/// Withholds readings during outages; all that drops out here drops out together.
#[derive(Clone, Debug)]
pub struct Dropout<const N: usize> {
    sides: PerSide<bool>,
    holds: bool,
    outage: Outage,
    is_out: bool,
    held: PerSide<Held<N>>,
}

/// When nothing comes.
#[derive(Clone, Debug)]
pub enum Outage {
    /// At control instants in [`from`, `until`).
    Window {
        /// First instant without a reading \[s\].
        from: f64,
        /// First instant with one again \[s\].
        until: f64,
    },
    /// By chance.
    Random {
        /// That an outage begins at a control instant, after one without.
        probability: f64,
        /// Mean number of control instants in an outage, ≥ 1; numbers are geometric.
        mean_length: f64,
        /// Where chance comes from: one number a control instant.
        random: Random,
    },
}

impl<const N: usize> Dropout<N> {
    /// On the given sides; `holds` says that the last reading is given meanwhile instead of NaN.
    pub fn new(sides: PerSide<bool>, holds: bool, outage: Outage) -> Self {
        Self { sides, holds, outage, is_out: false, held: [Held::NOTHING; 2] }
    }
}

/// Part of a control period by which an instant may be early: times of instants are products, and rounded.
const EARLY: f64 = 1e-9;

impl Outage {
    /// Whether nothing comes now, if at the last control instant that `was_out`.
    fn goes_on(&mut self, instant: &Tick, was_out: bool) -> bool {
        match self {
            Self::Window { from, until } => {
                let t = instant.t + EARLY * instant.period;
                *from <= t && t < *until
            }
            Self::Random { probability, mean_length, random } => {
                let chance = random.uniform();
                if was_out { chance >= 1.0 / *mean_length } else { chance < *probability }
            }
        }
    }
}

impl<const N: usize> Sensing<N> for Dropout<N> {
    fn sense(&mut self, instant: &Tick, measured: &mut Measured<N>) {
        self.is_out = self.outage.goes_on(instant, self.is_out);
        for (side, held) in self.held.iter_mut().enumerate().filter(|(side, _)| self.sides[*side]) {
            if self.is_out {
                held.give(measured, side);
                if !self.holds {
                    for reading in measured.reading(side) {
                        *reading = Vector([f64::NAN; N]);
                    }
                }
            } else {
                held.keep(measured, side);
            }
        }
    }
}
