//! States and directions at which a rate is not reached, in plain `f64`.

use crate::prove::engine::certificate::BlockName;
use crate::prove::engine::rate::Inequality;

/// Where the distance of two virtual solutions shrinks more slowly than claimed.
#[derive(Clone, Debug, PartialEq)]
pub struct RateWitness {
    /// The block of the closed loop.
    pub block: BlockName,
    /// The state.
    pub state: State,
    /// A variation δz of the block there.
    pub direction: Vec<f64>,
    /// The rate in that direction, δzᵀ A δz / δzᵀ W δz [1/s].
    pub rate: f64,
}

/// What a block depends on.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// Position errors of its side in rad.
    Error(Vec<f64>),
    /// Joint positions in rad or m.
    Configuration(Vec<f64>),
    /// The motors' momenta contract at the same rate everywhere.
    Any,
}

/// A direction in which A − β W is not positive, in `f64`, and the rate in it; none if there is no such direction.
pub fn against(inequality: &Inequality, beta: f64) -> Option<(Vec<f64>, f64)> {
    let n = inequality.form.size();
    let form = |i: usize, j: usize| inequality.form.at(i, j).midpoint();
    let weight = |i: usize, j: usize| inequality.weight.at(i, j).midpoint();
    // L D Lᵀ; where a pivot d_k is not positive, Lᵀ x = e_k gives xᵀ A x = d_k.
    let mut lower = vec![vec![0.0; n]; n];
    let mut pivots = vec![0.0; n];
    for k in 0..n {
        let earlier = |i: usize, lower: &Vec<Vec<f64>>| {
            (0..k).map(|m| lower[i][m] * lower[k][m] * pivots[m]).sum::<f64>()
        };
        let pivot = form(k, k) - beta * weight(k, k) - earlier(k, &lower);
        if pivot <= 0.0 {
            let mut direction = vec![0.0; n];
            direction[k] = 1.0;
            for i in (0..k).rev() {
                direction[i] = -(i + 1..=k).map(|m| lower[m][i] * direction[m]).sum::<f64>();
            }
            let rate = quadratic(&direction, form) / quadratic(&direction, weight);
            return (rate <= beta).then_some((direction, rate));
        }
        for i in k + 1..n {
            let entry = form(i, k) - beta * weight(i, k) - earlier(i, &lower);
            lower[i][k] = entry / pivot;
        }
        pivots[k] = pivot;
        lower[k][k] = 1.0;
    }
    None
}

/// xᵀ A x.
fn quadratic(x: &[f64], a: impl Fn(usize, usize) -> f64) -> f64 {
    (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j))).map(|(i, j)| x[i] * a(i, j) * x[j]).sum()
}
