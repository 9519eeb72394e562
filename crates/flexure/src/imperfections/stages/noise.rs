//! White measurement noise.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::{Measured, PerSide, Random, Sensing, Tick};

/// Adds independent normal numbers at every control instant.
#[derive(Clone, Debug)]
pub struct Noise<const N: usize> {
    /// Standard deviations ≥ 0 of positions \[rad\].
    pub position: PerSide<Vector<f64, N>>,
    /// Standard deviations ≥ 0 of velocities [rad/s].
    pub velocity: PerSide<Vector<f64, N>>,
    /// Where they come from: 4 N a control instant, whatever the deviations.
    pub random: Random,
}

impl<const N: usize> Sensing<N> for Noise<N> {
    fn sense(&mut self, _: &Tick, measured: &mut Measured<N>) {
        for side in 0..2 {
            let deviations = [self.position[side], self.velocity[side]];
            for (reading, deviation) in measured.reading(side).into_iter().zip(deviations) {
                for i in 0..N {
                    let normal = self.random.normal();
                    // Adding a zero may change the sign of one.
                    if deviation[i] > 0.0 {
                        reading[i] += deviation[i] * normal;
                    }
                }
            }
        }
    }
}
