//! A computer that is late at times.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::{Actuating, Random, Tick};

/// Keeps the last command for another period where the law misses its instant.
#[derive(Clone, Debug)]
pub struct Deadlines<const N: usize> {
    missed: Missed,
    last: Vector<f64, N>,
}

/// Which instants are missed.
#[derive(Clone, Debug)]
pub enum Missed {
    /// Each with a probability, which is drawn from one number a control instant.
    Random(f64, Random),
    /// Each so-many-th, counted from 1 at k = 0.
    Every(u32),
}

impl<const N: usize> Deadlines<N> {
    /// `before` is the torque until the first instant that is not missed [N m].
    pub fn new(missed: Missed, before: Vector<f64, N>) -> Self {
        Self { missed, last: before }
    }
}

impl<const N: usize> Actuating<N> for Deadlines<N> {
    fn actuate(&mut self, instant: &Tick, torque: &mut Vector<f64, N>) {
        let is_missed = match &mut self.missed {
            Missed::Random(probability, random) => random.uniform() < *probability,
            Missed::Every(every) => (instant.k + 1).is_multiple_of(u64::from(*every)),
        };
        if is_missed {
            *torque = self.last;
        } else {
            self.last = *torque;
        }
    }
}
