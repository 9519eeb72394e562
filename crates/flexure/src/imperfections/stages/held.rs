//! Readings that are kept while no new ones come.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::Measured;

/// The last readings of one side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held<const N: usize> {
    readings: [Vector<f64, N>; 2],
    age: u32,
}

impl<const N: usize> Held<N> {
    /// Before anything came.
    pub const NOTHING: Self = Self { readings: [Vector([f64::NAN; N]); 2], age: 0 };

    /// Keeps what is read of `side`.
    pub fn keep(&mut self, measured: &mut Measured<N>, side: usize) {
        self.readings = measured.reading(side).map(|reading| *reading);
        self.age = measured.age[side];
    }

    /// Gives what was kept instead of what is read of `side`, a control period older than last time.
    pub fn give(&mut self, measured: &mut Measured<N>, side: usize) {
        self.age = self.age.saturating_add(1);
        measured.age[side] = self.age;
        for (reading, kept) in measured.reading(side).into_iter().zip(self.readings) {
            *reading = kept;
        }
    }
}
