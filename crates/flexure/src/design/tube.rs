//! What is proved of a tuned loop as it is sampled.

use serde::Serialize;

use crate::files::number::{rounded_down, significant};
use crate::prove::sampled_data::SampledTube;

/// What is proved of a sampled loop near its run, under every reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tube {
    /// Two motions in it come closer at this rate in every control period [1/s].
    pub rate: f64,
    /// How far links reach at the start in rad: what `certify --sampled-tube` takes.
    pub width: f64,
}

impl Tube {
    /// Of the tubes under each reference; none without.
    pub(super) fn of(tubes: &[SampledTube]) -> Option<Self> {
        let each = tubes.iter().map(|tube| Self { rate: tube.rate, width: tube.asked.extents[0] });
        each.reduce(|a, b| Self { rate: a.rate.min(b.rate), width: a.width.min(b.width) })
    }

    /// Rate and place in words.
    pub fn words(&self) -> String {
        let rate = significant(rounded_down(self.rate, 4), 4);
        format!("a rate of {rate} 1/s near its run (certify --sampled-tube {:e})", self.width)
    }
}
