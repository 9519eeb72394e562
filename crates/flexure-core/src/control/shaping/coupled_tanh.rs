//! The shaping function that couples the joints.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// φ_3,i = (1 + κ_i) q̃_i + Σ_{j≠i} (θ_j/θ_i) tanh(q̃_j) / (n − 1): contracting in the matrix measure μ_1 at the rate
/// min κ whatever Λ is. Paper, eq. matrixmeasure1-phi-flexible, which is the case n = 2.
#[derive(Clone, Copy, Debug)]
pub struct CoupledTanh<C, const N: usize> {
    kappa: Vector<C, N>,
    theta: Vector<C, N>,
    /// 1 / ((n − 1) θ_i), what joint i takes of the others; 0 for joints beyond the first n.
    share: Vector<C, N>,
}

impl<C: Scalar, const N: usize> CoupledTanh<C, N> {
    /// From κ [1/s] and the diagonal of Λ, whose square root is Θ.
    pub fn new(kappa: Vector<C, N>, gain: &Vector<C, N>) -> Self {
        Self::of_joints(N, kappa, gain)
    }

    /// The same among the first n = `joints` joints only; the others are coupled with nothing, in either direction as long as
    /// they have no error.
    pub fn of_joints(joints: usize, kappa: Vector<C, N>, gain: &Vector<C, N>) -> Self {
        let divisor = i32::try_from(joints).unwrap_or(i32::MAX).saturating_sub(1).max(1);
        let theta = gain.map(C::sqrt);
        let share =
            Vector::from_fn(|i| if i < joints { C::from_ratio(1, divisor) / theta[i] } else { C::ZERO });
        Self { kappa, theta, share }
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for CoupledTanh<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        // Σ_{j≠i} θ_j tanh(q̃_j): the sum before i and the sum after, O(n) for all. The sum of all less the i-th would have
        // a derivative that cancels only up to the width of an interval.
        let weighted = self.theta.diag_mul(&error.map(T::tanh));
        let mut others = Vector::<T, N>::ZERO;
        let (mut before, mut after) = (T::ZERO, T::ZERO);
        for i in 0..N {
            others[i] = before;
            before += weighted[i];
        }
        for i in (0..N).rev() {
            others[i] += after;
            after += weighted[i];
        }
        Vector::from_fn(|i| error[i].scale(C::ONE + self.kappa[i]) + others[i].scale(self.share[i]))
    }
}
