//! What is believed before a log is seen: the numbers of the robot file, and how far they may be off.

use super::parameters::{Parameter, Values};

/// Normal distributions of the unknowns: logarithms of the parameters, then offsets in s. They count as one more measurement of
/// each.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    pub mean: Values,
    /// Standard deviations.
    pub spread: Vec<f64>,
}

/// Of a data sheet's stiffness and inertia: a factor of 1.6 either way.
pub(crate) const SHEET: f64 = 0.5;

/// Of what the log cannot see, and what is held near the file's number for that.
const HELD: f64 = 0.02;

/// Of what is a guess: a factor of 20.
const GUESS: f64 = 3.0;

/// Of offsets \[s\].
const OFFSET: f64 = 0.02;

impl Prior {
    /// About `mean`; of the `gaps` (joint, parameter) the robot file has no numbers.
    pub fn new(mean: Values, gaps: &[(usize, Parameter)]) -> Self {
        let spread_of = |joint: usize, parameter: Parameter| {
            if parameter.is_needed() && !gaps.contains(&(joint, parameter)) { SHEET } else { GUESS }
        };
        let joints = 0..mean.joints.len();
        let parameters = joints.flat_map(|joint| Parameter::ALL.map(|parameter| spread_of(joint, parameter)));
        let spread = parameters.chain(mean.offsets.iter().map(|_| OFFSET)).collect();
        Self { mean, spread }
    }

    /// Holds `unknown` near its mean.
    pub fn hold(&mut self, unknown: usize) {
        self.spread[unknown] = HELD;
    }

    /// How far `values` are from the mean, in standard deviations.
    pub fn distance(&self, values: &Values) -> Vec<f64> {
        let logarithms = values.joints.iter().flatten().zip(self.mean.joints.iter().flatten());
        let offsets = values.offsets.iter().zip(&self.mean.offsets);
        let apart = logarithms.map(|(x, mean)| (x / mean).ln()).chain(offsets.map(|(x, mean)| x - mean));
        apart.zip(&self.spread).map(|(apart, spread)| apart / spread).collect()
    }
}
