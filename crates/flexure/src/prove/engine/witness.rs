//! States and directions at which a rate is not reached, in plain `f64`.

use flexure_core::scalar::Interval;

use crate::linalg::{Symmetric, direction_of_descent};
use crate::prove::engine::certificate::BlockName;
use crate::prove::engine::rate::Inequality;

/// Where the distance of two virtual solutions shrinks more slowly than claimed.
#[derive(Clone, Debug, PartialEq)]
pub struct RateWitness {
    /// The block of the closed loop.
    pub block: BlockName,
    /// The state at which the block is slower than was asked.
    pub state: WitnessState,
    /// A variation δz of the block there.
    pub direction: Vec<f64>,
    /// The rate in that direction, δzᵀ A δz / δzᵀ W δz [1/s].
    pub rate: f64,
}

/// What a block depends on.
#[derive(Clone, Debug, PartialEq)]
pub enum WitnessState {
    /// Position errors of its side in rad.
    Error(Vec<f64>),
    /// Joint positions in rad or m.
    Configuration(Vec<f64>),
    /// The motors' momenta contract at the same rate everywhere.
    Any,
}

/// A direction in which A − β W is not positive, in `f64`, and the rate in it; none if there is no such direction.
pub fn against(inequality: &Inequality, beta: f64) -> Option<(Vec<f64>, f64)> {
    let [form, weight] = [&inequality.form, &inequality.weight].map(|matrix| matrix.map(Interval::midpoint));
    let direction = direction_of_descent(&form.minus(&weight, beta))?;
    let rate = quadratic(&direction, &form) / quadratic(&direction, &weight);
    (rate <= beta).then_some((direction, rate))
}

/// xᵀ A x, summed entry by entry, row by row: published witnesses have the last digits of this order.
fn quadratic(x: &[f64], a: &Symmetric<f64>) -> f64 {
    (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j))).map(|(i, j)| x[i] * a.at(i, j) * x[j]).sum()
}
