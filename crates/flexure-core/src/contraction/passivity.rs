//! Differential passivity: the variation of a system stores no more than flows in through its port.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

use super::jacobian::field_rate;
use super::{ControlSystem, MatrixField};

/// W = ½ δxᵀ Π(x, t) δx, the differential storage. Paper, eq. differentialStorage-Lemma.
#[inline]
pub fn storage<C: Scalar, T: Over<C> + Piecewise, const N: usize>(
    metric: &impl MatrixField<C, N>,
    x: &Vector<T, N>,
    delta_x: &Vector<T, N>,
    t: T,
) -> T {
    T::from_f64(0.5) * delta_x.dot(&(metric.at(x, t) * *delta_x))
}

/// The terms of Ẇ ≤ δyᵀ δu for one variation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialBalance<T> {
    /// W.
    pub storage: T,
    /// Ẇ along the prolonged system.
    pub rate: T,
    /// δyᵀ δu.
    pub supplied: T,
}

/// W, Ẇ and δyᵀ δu at (x, δx, u, δu, t), `[x, δx]` and `[u, δu]` in pairs. Paper, eq. differentialpassivityinequality.
#[inline]
pub fn differential_passivity<C, T, const N: usize, const M: usize>(
    system: &impl ControlSystem<C, N, M>,
    metric: &impl MatrixField<C, N>,
    [x, delta_x]: &[Vector<T, N>; 2],
    [u, delta_u]: &[Vector<T, M>; 2],
    t: T,
) -> DifferentialBalance<T>
where
    C: Scalar,
    T: Over<C> + Piecewise,
{
    let varied = system.linearised(x, u, t);
    let delta_rate = varied.state * *delta_x + varied.port * *delta_u;
    let [Pi, Pi_rate] = field_rate(metric, x, &system.rate_under(x, u, t), t);
    let (half, momentum) = (T::from_f64(0.5), Pi * *delta_x);
    DifferentialBalance {
        storage: half * delta_x.dot(&momentum),
        rate: momentum.dot(&delta_rate) + half * delta_x.dot(&(Pi_rate * *delta_x)),
        supplied: (varied.output * *delta_x).dot(delta_u),
    }
}

/// Differential passivity for all variations at once: Ẇ = δyᵀ δu − ½ δxᵀ Q δx + δxᵀ R δu.
#[derive(Clone, Copy, Debug)]
pub struct PassivityMatrices<T, const N: usize, const M: usize> {
    /// Q = −(Π̇ + Aᵀ Π + Π A). Positive semidefinite: passive; zero: lossless; above 2β Π: strictly passive, and the system contracts at
    /// the rate β under inputs that do not vary.
    pub dissipation: Matrix<T, N, N>,
    /// R = Π B − Cᵀ, which has to vanish.
    pub mismatch: Matrix<T, N, M>,
}

/// [`PassivityMatrices`] at (x, u, t): the paper's eq. dPBCinequality for any system, in its own coordinates.
#[inline]
pub fn passivity_matrices<C, T, const N: usize, const M: usize>(
    system: &impl ControlSystem<C, N, M>,
    metric: &impl MatrixField<C, N>,
    x: &Vector<T, N>,
    u: &Vector<T, M>,
    t: T,
) -> PassivityMatrices<T, N, M>
where
    C: Scalar,
    T: Over<C> + Piecewise,
{
    let varied = system.linearised(x, u, t);
    let [Pi, Pi_rate] = field_rate(metric, x, &system.rate_under(x, u, t), t);
    let product = Pi * varied.state;
    PassivityMatrices {
        dissipation: -(Pi_rate + product + product.transpose()),
        mismatch: Pi * varied.port - varied.output.transpose(),
    }
}
