//! Shaping functions φ: how a position error turns into a velocity towards the reference.

mod coupled_tanh;
mod linear;
mod odd_series;
mod tanh;

pub use coupled_tanh::CoupledTanh;
pub use linear::Linear;
pub use odd_series::{OddSeries, TERMS};
pub use tanh::Tanh;

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Dual, Over, Scalar};

/// A shaping function φ with φ(0) = 0 whose slope contracts in the metric Π: eq. controllaw-positionmetricinquality.
///
/// Entry i may depend on the errors of other joints, but a joint that has no error must not change what it is without that
/// joint. A shaping function of one's own, for any [`Vcbc`](super::Vcbc):
///
/// ```
/// use flexure_core::control::Shaping;
/// use flexure_core::linalg::Vector;
/// use flexure_core::scalar::{Over, Scalar};
///
/// /// φ = Λ q̃ / √(1 + q̃²): bounded by Λ, with the slope Λ at no error.
/// struct Root<C, const N: usize> {
///     /// Diagonal of Λ [rad/s].
///     gain: Vector<C, N>,
/// }
///
/// impl<C: Scalar, const N: usize> Shaping<C, N> for Root<C, N> {
///     fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
///         self.gain.diag_mul(&error.map(|e| e / (T::ONE + e.square()).sqrt()))
///     }
/// }
///
/// let phi = Root { gain: Vector([2.0]) };
/// assert_eq!(phi.eval(&Vector([0.75])), Vector([1.2])); // 2 · 0.75 / 1.25
/// assert_eq!(phi.slope(&Vector([0.0])).0, [[2.0]]); // by dual numbers
/// ```
pub trait Shaping<C: Scalar, const N: usize> {
    /// φ(q̃) [rad/s] at the position error q̃ in rad.
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N>;

    /// Slope ∂φ/∂q̃ [1/s].
    #[inline]
    fn slope<T: Over<C>>(&self, error: &Vector<T, N>) -> Matrix<T, N, N> {
        let variables = Vector::from_fn(|j| Dual::<T, N>::variable(error[j], j));
        Matrix(self.eval(&variables).map(|phi| phi.gradient).0)
    }
}
