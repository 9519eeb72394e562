//! The shaping function that couples the joints.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// φ_3,i = (1 + κ_i) q̃_i + Σ_{j≠i} (θ_j/θ_i) tanh(q̃_j) / (n − 1): contracting in the matrix measure μ_1 at the rate
/// min κ whatever Λ is. Paper, eq. matrixmeasure1-phi-flexible, which is the case n = 2.
///
/// Beyond the first n joints (phantoms of a [`Tree`](crate::robots::Tree)) there is no coupling: φ_3,i = (1 + κ_i) q̃_i.
#[derive(Clone, Copy, Debug)]
pub struct CoupledTanh<C, const N: usize> {
    /// 1 + κ.
    own: Vector<C, N>,
    /// θ_i, 0 beyond the first n joints.
    weight: Vector<C, N>,
    /// 1 / ((n − 1) θ_i), 0 beyond the first n joints.
    share: Vector<C, N>,
}

impl<C: Scalar, const N: usize> CoupledTanh<C, N> {
    /// Coupling all joints, n = N: from κ [1/s] and the diagonal of Λ, positive, whose square root is Θ.
    pub fn new(kappa: Vector<C, N>, gain: &Vector<C, N>) -> Self {
        Self::of_joints(N, kappa, gain)
    }

    /// [`new`](Self::new) that couples the first n = `joints` only, all of them if there are fewer: what a robot needs whose
    /// vectors have room for more joints.
    pub fn of_joints(joints: usize, kappa: Vector<C, N>, gain: &Vector<C, N>) -> Self {
        let divisor = i32::try_from(joints.min(N)).unwrap_or(i32::MAX).saturating_sub(1).max(1);
        let coupled = |i: usize, x: C| if i < joints { x } else { C::ZERO };
        let theta = gain.map(C::sqrt);
        Self {
            own: kappa.map(|kappa| C::ONE + kappa),
            weight: Vector::from_fn(|i| coupled(i, theta[i])),
            share: Vector::from_fn(|i| coupled(i, C::from_ratio(1, divisor) / theta[i])),
        }
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for CoupledTanh<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        // Σ_{j≠i} θ_j tanh(q̃_j): the sum before i and the sum after, O(n) for all. The sum of all less the i-th would have
        // a derivative that cancels only up to the width of an interval.
        let weighted = self.weight.diag_mul(&error.map(T::tanh));
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
        Vector::from_fn(|i| error[i].scale(self.own[i]) + others[i].scale(self.share[i]))
    }
}
