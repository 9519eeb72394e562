//! The generalised Jacobian and the contraction inequality.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

use super::tangent::{matrix_direction, moving, passing};
use super::{Dynamics, MatrixField};

/// Θ and its rate along the solution through `x` that moves at `rate`.
#[inline]
pub fn field_rate<C: Scalar, T: Over<C> + Piecewise, const N: usize>(
    field: &impl MatrixField<C, N>,
    x: &Vector<T, N>,
    rate: &Vector<T, N>,
    t: T,
) -> [Matrix<T, N, N>; 2] {
    let moved = field.at(&moving(x, rate), passing(t));
    [moved.map(|m| m.value), matrix_direction(&moved)]
}

/// J̄ = (Θ̇ + Θ ∂F/∂x) Θ⁻¹, the Jacobian of the system in the coordinates δz = Θ δx. Paper, eq. generalizedJacobian, as corrected
/// in `docs/errata.md`.
///
/// Any of its matrix measures below −β proves contraction at the rate β [1/s], in the norm of that measure of Θ δx. Θ has to be regular:
/// Θ⁻¹ = (ΘᵀΘ)⁻¹ Θᵀ.
#[inline]
pub fn generalised_jacobian<C, T, const N: usize>(
    system: &impl Dynamics<C, N>,
    weight: &impl MatrixField<C, N>,
    x: &Vector<T, N>,
    t: T,
) -> Matrix<T, N, N>
where
    C: Scalar,
    T: Over<C> + Piecewise,
{
    let [theta, theta_rate] = field_rate(weight, x, &system.rate(x, t), t);
    let transformed = theta_rate + theta * system.jacobian(x, t);
    let factor = (theta.transpose() * theta).ldl();
    // A Θ⁻¹ = (A Π⁻¹) Θᵀ, and the rows of A Π⁻¹ are Π⁻¹ times those of A.
    let solved = Matrix(transformed.0.map(|row| factor.solve(&Vector(row)).0));
    solved * theta.transpose()
}

/// −(Π̇ + ∂Fᵀ Π + Π ∂F) − 2β Π: positive semidefinite where the system contracts in the metric Π at the rate β [1/s]. Paper,
/// eq. slotinecontractionconditions.
#[inline]
pub fn contraction_matrix<C, T, const N: usize>(
    system: &impl Dynamics<C, N>,
    metric: &impl MatrixField<C, N>,
    beta: T,
    x: &Vector<T, N>,
    t: T,
) -> Matrix<T, N, N>
where
    C: Scalar,
    T: Over<C> + Piecewise,
{
    let [Pi, Pi_rate] = field_rate(metric, x, &system.rate(x, t), t);
    let product = Pi * system.jacobian(x, t);
    -(Pi_rate + product + product.transpose()) - Pi.scaled(beta + beta)
}
