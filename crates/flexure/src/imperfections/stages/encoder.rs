//! Encoders: positions in whole counts.

use flexure_core::linalg::Vector;

use crate::imperfections::stages::{Measured, PerSide, Random, Sensing, Tick};

/// Rounds positions to the nearest count.
#[derive(Clone, Debug)]
pub struct Encoder<const N: usize> {
    /// One count ≥ 0 \[rad\]; none for a side whose positions are left as they are.
    pub resolution: PerSide<Option<Vector<f64, N>>>,
    /// Noise of half a count to either side, uniform, before rounding: it makes the mean of many readings exact.
    pub dither: Option<Random>,
}

impl<const N: usize> Sensing<N> for Encoder<N> {
    fn sense(&mut self, _: &Tick, measured: &mut Measured<N>) {
        for (side, resolution) in self.resolution.iter().enumerate() {
            let Some(resolution) = resolution else { continue };
            let [position, _] = measured.reading(side);
            for i in 0..N {
                let dither = self.dither.as_mut().map_or(0.0, |random| random.uniform() - 0.5);
                position[i] = rounded(position[i], resolution[i], dither);
            }
        }
    }
}

/// `x` and `shift` steps, to the nearest multiple of `step`; `x` itself if that is 0.
pub(crate) fn rounded(x: f64, step: f64, shift: f64) -> f64 {
    if step > 0.0 { (x / step + shift).round() * step } else { x }
}
