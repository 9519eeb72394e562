//! Jacobians column by column, and their symmetric part in a metric.

use flexure_core::scalar::{Dual, Scalar};

use crate::linalg::Dense;

/// The Jacobian of `rates` with respect to the first `size` numbers of `at`: entry (i, j) is ∂ rate_i / ∂ at_j. The
/// numbers beyond are constants.
pub fn jacobian<C: Scalar>(
    at: &[C],
    size: usize,
    mut rates: impl FnMut(&[Dual<C, 1>]) -> Vec<Dual<C, 1>>,
) -> Dense<C> {
    let mut variables: Vec<Dual<C, 1>> = at.iter().map(|&x| Dual::constant(x)).collect();
    let columns: Vec<Vec<C>> = (0..size)
        .map(|j| {
            variables[j] = Dual::variable(at[j], 0);
            let column = rates(&variables).iter().map(|rate| rate.gradient[0]).collect();
            variables[j] = Dual::constant(at[j]);
            column
        })
        .collect();
    Dense::from_columns(&columns)
}

/// Entry (i, j) of ½ (G + Gᵀ) for the matrix `entry`.
pub fn symmetric_part<C: Scalar>(entry: impl Fn(usize, usize) -> C, i: usize, j: usize) -> C {
    if i == j { entry(i, i) } else { C::from_f64(0.5) * (entry(i, j) + entry(j, i)) }
}
