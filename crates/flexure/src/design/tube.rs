//! What is proved of a tuned loop as it is sampled.

use serde::Serialize;

use crate::files::number::{rounded_down, significant};
use crate::prove::sampled_data::SampledTube;

/// What is proved of a sampled loop near its run, under every reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tube {
    /// Two motions in it come closer at this rate in every control period [1/s].
    pub rate: f64,
    /// How far links reach at the start in rad under the first reference, which is that of the tuned file: what `certify --sampled-tube` takes.
    pub width: f64,
}

impl Tube {
    /// Of the tubes under each reference; none without.
    pub(super) fn of(tubes: &[SampledTube]) -> Option<Self> {
        let width = tubes.first()?.asked.extents[0];
        Some(Self { rate: tubes.iter().map(|tube| tube.rate).fold(f64::INFINITY, f64::min), width })
    }

    /// Rate and place in words.
    pub fn words(&self) -> String {
        let rate = significant(rounded_down(self.rate, 4), 4);
        format!("a rate of {rate} 1/s or more near its run (certify --sampled-tube {:e})", self.width)
    }
}
