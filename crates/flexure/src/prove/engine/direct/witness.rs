//! States that refute a rate, confirmed by intervals.

use flexure_core::scalar::Interval;

use crate::linalg::weakest;
use crate::prove::engine::direct::flow::Flow;

/// A state: every coordinate by its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedState {
    /// Name and value of each coordinate, in the flow's order and units.
    pub coordinates: Vec<(String, f64)>,
}

impl std::fmt::Display for NamedState {
    /// `e_l[0] = 0.5, …`
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (name, value)) in self.coordinates.iter().enumerate() {
            write!(f, "{}{name} = {value:.6}", if i == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

/// A state where √W does not decay at the claimed rate, and the direction in which it does not.
///
/// Plain `f64` found it and intervals confirmed it: the real value at this very state is at most `value`, for all constants
/// that the flow encloses.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectWitness {
    /// The state at which the rate is not reached.
    pub at: NamedState,
    /// Direction δz in which it is not reached.
    pub direction: Vec<f64>,
    /// An upper bound of δzᵀ (dissipation − β weight) δz, where δzᵀ weight δz is about 1: negative.
    pub value: f64,
    /// An upper bound of the contraction rate at the state [1/s].
    pub rate: f64,
}

/// A point with the weakest rate that `f64` sees there [1/s], and its direction.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    pub at: Vec<f64>,
    pub rate: f64,
    pub direction: Vec<f64>,
}

impl Sample {
    /// At the point `at`; `None` where the metric is not one.
    pub(crate) fn new(flow: &dyn Flow, at: Vec<f64>) -> Option<Self> {
        let balance = flow.value(&at);
        let (rate, direction) = weakest(&balance.dissipation, &balance.weight)?;
        Some(Self { at, rate, direction })
    }

    /// An upper bound of the contraction rate at this point [1/s], by intervals, and one of the quadratic form at `beta`.
    pub(crate) fn bounds(&self, flow: &dyn Flow, beta: f64) -> Option<(f64, f64)> {
        let at: Vec<Interval> = self.at.iter().map(|&x| Interval::point(x)).collect();
        let direction: Vec<Interval> = self.direction.iter().map(|&x| Interval::point(x)).collect();
        let balance = flow.enclosure(&at);
        let lost = balance.dissipation.value(&direction);
        let stored = balance.weight.value(&direction);
        let value = lost - Interval::point(beta) * stored;
        (stored.lo() > 0.0).then_some(((lost / stored).hi(), value.hi()))
    }

    /// The witness against `beta`, if intervals confirm it.
    pub(crate) fn refutes(&self, flow: &dyn Flow, beta: f64) -> Option<DirectWitness> {
        if self.rate >= beta {
            return None;
        }
        let (rate, value) = self.bounds(flow, beta)?;
        let direction = self.direction.clone();
        (value < 0.0).then(|| DirectWitness { at: self.state(flow), direction, value, rate })
    }

    pub(crate) fn state(&self, flow: &dyn Flow) -> NamedState {
        let names = flow.coordinates().iter().map(|c| c.name.clone());
        NamedState { coordinates: names.zip(self.at.iter().copied()).collect() }
    }
}

impl NamedState {
    /// The value of the coordinate `name`.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.coordinates.iter().find(|(n, _)| n == name).map(|(_, x)| *x)
    }

    /// The values in the flow's order.
    pub fn values(&self) -> Vec<f64> {
        self.coordinates.iter().map(|(_, x)| *x).collect()
    }
}
