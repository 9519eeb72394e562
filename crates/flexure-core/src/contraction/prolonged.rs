//! The prolonged system: a solution and a variation of it, as one system.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Dual, Over, Piecewise, Scalar};

use super::blocks::{block, part, stack};
use super::tangent::{direction, matrix_direction, moving};
use super::{ControlSystem, Dynamics};

/// The prolonged system of a system of `N` states and `M` inputs, with the state (x, δx), the input (u, δu) and the output (y, δy).
/// Paper, eq. prolongedcontrolsystem; with `M = 0` that of a system without input, eq. prolonged-closedloop-system.
///
/// It is affine in its input as well: u moves δx through ∂G/∂x δx.
#[derive(Clone, Copy, Debug)]
pub struct Prolonged<S, const N: usize, const M: usize>(pub S);

impl<C: Scalar, S: Dynamics<C, N>, const N: usize, const D: usize> Dynamics<C, D> for Prolonged<S, N, 0> {
    #[inline]
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, D> {
        let moved = self.0.rate(&along::<T, N, D>(x), Dual::constant(t));
        pair(&moved)
    }
}

impl<C, S, const N: usize, const M: usize, const D: usize, const P: usize> ControlSystem<C, D, P>
    for Prolonged<S, N, M>
where
    C: Scalar,
    S: ControlSystem<C, N, M>,
{
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, D> {
        pair(&self.0.drift(&along::<T, N, D>(x), Dual::constant(t)))
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Matrix<T, D, P> {
        let port = self.0.port(&along::<T, N, D>(x), Dual::constant(t));
        let value = port.map(|g| g.value);
        block(&value, &Matrix::ZERO, &matrix_direction(&port), &value)
    }
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, P> {
        pair(&self.0.output(&along::<T, N, D>(x), Dual::constant(t)))
    }
}

/// (x, δx) as x moving along δx.
#[inline]
fn along<T: Scalar, const N: usize, const D: usize>(x: &Vector<T, D>) -> Vector<Dual<T, 1>, N> {
    const { assert!(2 * N == D, "a prolonged system has twice the states") }
    moving(&part::<T, N, D>(x, 0), &part(x, N))
}

/// Value and direction, one after the other.
#[inline]
fn pair<T: Scalar, const N: usize, const D: usize>(x: &Vector<Dual<T, 1>, N>) -> Vector<T, D> {
    stack(&x.map(|x| x.value), &direction(x))
}
