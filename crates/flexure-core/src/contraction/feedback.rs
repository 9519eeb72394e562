//! A control system under a state feedback.

use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

use super::{ControlSystem, Dynamics};

/// u = γ(x, t).
pub trait Feedback<C: Scalar, const N: usize, const M: usize> {
    /// γ(x, t).
    fn input<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, M>;
}

/// A constant input.
impl<C: Scalar, const N: usize, const M: usize> Feedback<C, N, M> for Vector<C, M> {
    #[inline]
    fn input<T: Over<C> + Piecewise>(&self, _: &Vector<T, N>, _: T) -> Vector<T, M> {
        self.lift()
    }
}

/// Σ: ẋ = F(x, t) = f(x, t) + G(x, t) γ(x, t). Paper, eq. closedloopcontrolsystem.
///
/// `M` is the number of inputs.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLoop<S, K, const M: usize> {
    /// Σ_u.
    pub system: S,
    /// γ.
    pub feedback: K,
}

impl<C, S, K, const N: usize, const M: usize> Dynamics<C, N> for ClosedLoop<S, K, M>
where
    C: Scalar,
    S: ControlSystem<C, N, M>,
    K: Feedback<C, N, M>,
{
    #[inline]
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        self.system.rate_under(x, &self.feedback.input(x, t), t)
    }
}
