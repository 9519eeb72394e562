//! Shaping functions φ: how a position error turns into a velocity towards the reference.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Dual, Over, Scalar};

/// A shaping function φ with φ(0) = 0 whose slope contracts in the metric Π: eq. controllaw-positionmetricinquality.
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

/// φ_2 = Λ q̃: the linear law. Keeps the pH-like structure when Π = Λ.
#[derive(Clone, Copy, Debug)]
pub struct Linear<C, const N: usize> {
    /// Diagonal of Λ [1/s].
    pub gain: Vector<C, N>,
}

/// φ_1 = Λ tanh q̃, entry by entry: bounded, so that far errors do not ask for high speeds. Keeps the variational
/// structure; its contraction rate tends to 0 far from the reference. Paper, corollary controller-tanh.
#[derive(Clone, Copy, Debug)]
pub struct Tanh<C, const N: usize> {
    /// Diagonal of Λ [rad/s].
    pub gain: Vector<C, N>,
}

/// φ_3,i = (1 + κ_i) q̃_i + Σ_{j≠i} (θ_j/θ_i) tanh(q̃_j) / (n − 1): contracting in the matrix measure μ_1 at the rate
/// min κ whatever Λ is. Paper, eq. matrixmeasure1-phi-flexible, which is the case n = 2.
///
/// Beyond the first n joints (phantoms of a [`Tree`](crate::robots::Tree)) there is no coupling: φ_3,i = (1 + κ_i) q̃_i.
#[derive(Clone, Copy, Debug)]
pub struct CoupledTanh<C, const N: usize> {
    kappa: Vector<C, N>,
    theta: Vector<C, N>,
    /// 1 / ((n − 1) θ_i).
    share: Vector<C, N>,
    /// n, at most `N`.
    coupled: usize,
}

impl<C: Scalar, const N: usize> CoupledTanh<C, N> {
    /// Coupling all joints, n = N: from κ [1/s] and the diagonal of Λ, positive, whose square root is Θ.
    pub fn new(kappa: Vector<C, N>, gain: &Vector<C, N>) -> Self {
        let theta = gain.map(C::sqrt);
        Self { kappa, theta, share: Vector::ZERO, coupled: N }.coupling(N)
    }

    /// Coupling the first n = `joints` only, all of them if there are fewer: what a robot needs whose arrays have room for
    /// more.
    #[must_use]
    pub fn coupling(mut self, joints: usize) -> Self {
        self.coupled = joints.min(N);
        let divisor = i32::try_from(self.coupled).unwrap_or(i32::MAX).saturating_sub(1).max(1);
        self.share = self.theta.map(|theta| C::from_ratio(1, divisor) / theta);
        self
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for Linear<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        self.gain.diag_mul(error)
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for Tanh<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        self.gain.diag_mul(&error.map(T::tanh))
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for CoupledTanh<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        // Σ_{j≠i} θ_j tanh(q̃_j): the sum before i and the sum after, O(n) for all. The sum of all less the i-th would have
        // a derivative that cancels only up to the width of an interval.
        let coupled = self.coupled.min(N);
        let weighted = self.theta.diag_mul(&error.map(T::tanh));
        let mut others = Vector::<T, N>::ZERO;
        let (mut before, mut after) = (T::ZERO, T::ZERO);
        for i in 0..coupled {
            others[i] = before;
            before += weighted[i];
        }
        for i in (0..coupled).rev() {
            others[i] += after;
            after += weighted[i];
        }
        Vector::from_fn(|i| error[i].scale(C::ONE + self.kappa[i]) + others[i].scale(self.share[i]))
    }
}
