//! Two systems in feedback.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

use super::blocks::{block_diagonal, part, stack};
use super::{ControlSystem, MatrixField};

/// The feedback interconnection of two systems of `A` and `B` states with `M` inputs and outputs each:
///
/// u_1 = −K y_2 + e_1, u_2 = Kᵀ y_1 + e_2, with the input (e_1, e_2) and the output (y_1, y_2).
///
/// With the coupling K = I it is the paper's eq. feedback-interconnection, with another the paper's eq. diff-passivity-interconnection.
/// Whatever K is, u_1ᵀ y_1 + u_2ᵀ y_2 = e_1ᵀ y_1 + e_2ᵀ y_2, and so of variations: with storages W_1 and W_2 of the parts, the whole is
/// differentially passive with W_1 + W_2, which is [`Both`].
#[derive(Clone, Copy, Debug)]
pub struct Interconnection<S1, S2, C, const A: usize, const B: usize, const M: usize> {
    /// The first system.
    pub first: S1,
    /// The second system.
    pub second: S2,
    /// K.
    pub coupling: Matrix<C, M, M>,
}

impl<C, S1, S2, const A: usize, const B: usize, const M: usize, const N: usize, const P: usize>
    ControlSystem<C, N, P> for Interconnection<S1, S2, C, A, B, M>
where
    C: Scalar,
    S1: ControlSystem<C, A, M>,
    S2: ControlSystem<C, B, M>,
{
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        let (x_1, x_2) = (part::<T, A, N>(x, 0), part::<T, B, N>(x, A));
        let K = self.coupling.map(T::constant);
        let u_1 = -(K * self.second.output(&x_2, t));
        let u_2 = K.transpose() * self.first.output(&x_1, t);
        stack(&self.first.rate_under(&x_1, &u_1, t), &self.second.rate_under(&x_2, &u_2, t))
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, P> {
        block_diagonal(
            &self.first.port(&part::<T, A, N>(x, 0), t),
            &self.second.port(&part::<T, B, N>(x, A), t),
        )
    }
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, P> {
        stack(&self.first.output(&part::<T, A, N>(x, 0), t), &self.second.output(&part::<T, B, N>(x, A), t))
    }
}

/// diag(Π_1(x_1, t), Π_2(x_2, t)): the metric whose storage is the sum of two.
#[derive(Clone, Copy, Debug)]
pub struct Both<F1, F2, const A: usize, const B: usize>(pub F1, pub F2);

impl<C, F1, F2, const A: usize, const B: usize, const N: usize> MatrixField<C, N> for Both<F1, F2, A, B>
where
    C: Scalar,
    F1: MatrixField<C, A>,
    F2: MatrixField<C, B>,
{
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        block_diagonal(&self.0.at(&part::<T, A, N>(x, 0), t), &self.1.at(&part::<T, B, N>(x, A), t))
    }
}
