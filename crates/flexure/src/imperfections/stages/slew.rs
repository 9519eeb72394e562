//! Drives whose torque changes so fast and no faster.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::{Actuating, Tick};

/// Limits how much torque changes from one control period to the next.
#[derive(Clone, Copy, Debug)]
pub struct Slew<const N: usize> {
    rate: Vector<f64, N>,
    last: Vector<f64, N>,
}

impl<const N: usize> Slew<N> {
    /// At most `rate` > 0 [N m/s], from the torque `before` the first control instant [N m].
    pub fn new(rate: Vector<f64, N>, before: Vector<f64, N>) -> Self {
        Self { rate, last: before }
    }
}

impl<const N: usize> Actuating<N> for Slew<N> {
    fn actuate(&mut self, instant: &Tick, torque: &mut Vector<f64, N>) {
        for i in 0..N {
            let (most, last) = (self.rate[i] * instant.period, self.last[i]);
            torque[i] = torque[i].clamp(last - most, last + most);
            // From a number that is none there is no way back.
            if torque[i].is_finite() {
                self.last[i] = torque[i];
            }
        }
    }
}
