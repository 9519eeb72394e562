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
const SHEET: f64 = 0.5;

/// Of what is a guess: a factor of 20.
const GUESS: f64 = 3.0;

/// Of offsets \[s\].
const OFFSET: f64 = 0.02;

impl Prior {
    /// About `mean`; `known` says of which parameters the robot file has numbers.
    pub fn new(mean: Values, known: impl Fn(Parameter) -> bool) -> Self {
        let spread_of = |parameter: Parameter| match parameter {
            parameter if parameter.is_needed() && known(parameter) => SHEET,
            _ => GUESS,
        };
        let parameters = mean.joints.iter().flat_map(|_| Parameter::ALL.map(spread_of));
        let spread = parameters.chain(mean.offsets.iter().map(|_| OFFSET)).collect();
        Self { mean, spread }
    }

    /// How far `values` are from the mean, in standard deviations.
    pub fn distance(&self, values: &Values) -> Vec<f64> {
        let logarithms = values.joints.iter().flatten().zip(self.mean.joints.iter().flatten());
        let offsets = values.offsets.iter().zip(&self.mean.offsets);
        let apart = logarithms.map(|(x, mean)| (x / mean).ln()).chain(offsets.map(|(x, mean)| x - mean));
        apart.zip(&self.spread).map(|(apart, spread)| apart / spread).collect()
    }
}
