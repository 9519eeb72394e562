//! Systems: ẋ = F(x, t), and ẋ = f(x, t) + G(x, t) u with the output y = h(x, t).

use crate::linalg::{Matrix, Vector};
use crate::model::seeded;
use crate::scalar::{Dual, Over, Piecewise, Scalar};

use super::tangent::{direction, moving};

/// Σ: ẋ = F(x, t), a system without input, of `N` states and with constants of type `C`. Paper, eq. closedloopcontrolsystem.
pub trait Dynamics<C: Scalar, const N: usize> {
    /// F(x, t), the rate of the state.
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N>;

    /// ∂F/∂x.
    #[inline]
    fn jacobian<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        rows(&self.rate(&seeded(x), Dual::constant(t)))
    }

    /// δẋ = ∂F/∂x δx, the rate of a variation. Paper, eq. prolonged-closedloop-system.
    #[inline]
    fn variation<T: Over<C> + Piecewise>(
        &self,
        x: &Vector<T, N>,
        delta_x: &Vector<T, N>,
        t: T,
    ) -> Vector<T, N> {
        direction(&self.rate(&moving(x, delta_x), Dual::constant(t)))
    }
}

/// Σ_u: ẋ = f(x, t) + G(x, t) u, y = h(x, t), of `N` states, `M` inputs and `M` outputs. Paper, eq. controlsystem.
///
/// A system of one's own, and whether the difference of two of its solutions dies out:
///
/// ```
/// use flexure_core::contraction::{ClosedLoop, ControlSystem, generalised_jacobian, measure_1};
/// use flexure_core::linalg::{Matrix, Vector};
/// use flexure_core::scalar::{Interval, Over, Piecewise, Scalar};
///
/// /// Two tanks in a row, filled by u: what runs out of each grows with its level.
/// struct Tanks<C> {
///     /// Speed of the outflow [1/s].
///     outflow: C,
/// }
///
/// impl<C: Scalar> ControlSystem<C, 2, 1> for Tanks<C> {
///     fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Vector<T, 2> {
///         let out = x.map(|x| (x + (T::ONE + x.square()).ln()).scale(self.outflow));
///         Vector([-out[0], out[0] - out[1]])
///     }
///     fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, 2>, _: T) -> Matrix<T, 2, 1> {
///         Matrix([[T::ONE], [T::ZERO]])
///     }
///     fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Vector<T, 1> {
///         Vector([x[0]])
///     }
/// }
///
/// // For all levels from 0 to 2 at once, in intervals.
/// let tanks = Tanks { outflow: Interval::ONE };
/// let fed = ClosedLoop { system: &tanks, feedback: Vector([Interval::ONE]) };
/// let level = Interval::new(0.0, 2.0).unwrap();
/// let theta = Matrix([[8.0, 0.0], [0.0, 1.0]]).map(Interval::point);
/// let jacobian = generalised_jacobian::<Interval, _, _>(&fed, &theta, &Vector([level; 2]), Interval::ZERO);
/// assert!(measure_1(&jacobian).hi() < -0.3);
/// ```
pub trait ControlSystem<C: Scalar, const N: usize, const M: usize> {
    /// f(x, t).
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N>;

    /// G(x, t), whose columns are the fields g_i of the inputs.
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, M>;

    /// y = h(x, t).
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, M>;

    /// f + G u.
    #[inline]
    fn rate_under<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, u: &Vector<T, M>, t: T) -> Vector<T, N> {
        self.drift(x, t) + self.port(x, t) * *u
    }

    /// The variation of the system about (x, u, t).
    #[inline]
    fn linearised<T: Over<C> + Piecewise>(
        &self,
        x: &Vector<T, N>,
        u: &Vector<T, M>,
        t: T,
    ) -> Linearised<T, N, M> {
        let (variables, now) = (seeded(x), Dual::<T, N>::constant(t));
        Linearised {
            state: rows(&self.rate_under(&variables, &u.map(Dual::constant), now)),
            port: self.port(x, t),
            output: rows(&self.output(&variables, now)),
        }
    }
}

/// δẋ = A δx + B δu, δy = C δx. Paper, eq. prolongedcontrolsystem-variational.
#[derive(Clone, Copy, Debug)]
pub struct Linearised<T, const N: usize, const M: usize> {
    /// A = ∂(f + G u)/∂x.
    pub state: Matrix<T, N, N>,
    /// B = G.
    pub port: Matrix<T, N, M>,
    /// C = ∂h/∂x.
    pub output: Matrix<T, M, N>,
}

impl<C: Scalar, S: Dynamics<C, N>, const N: usize> Dynamics<C, N> for &S {
    #[inline]
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        (*self).rate(x, t)
    }
}

impl<C: Scalar, S: ControlSystem<C, N, M>, const N: usize, const M: usize> ControlSystem<C, N, M> for &S {
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        (*self).drift(x, t)
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, M> {
        (*self).port(x, t)
    }
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, M> {
        (*self).output(x, t)
    }
}

/// The gradients, as rows.
#[inline]
pub(super) fn rows<T: Scalar, const R: usize, const N: usize>(x: &Vector<Dual<T, N>, R>) -> Matrix<T, R, N> {
    Matrix(x.map(|x| x.gradient).0)
}
