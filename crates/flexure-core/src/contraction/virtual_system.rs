//! Virtual systems and the three steps of virtual-contraction based control.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

use super::blocks::{part, stack};
use super::tangent::{direction, moving, passing};
use super::{ControlSystem, Dynamics, MatrixField};

/// A virtual system of a system of one's own, a law for it and what the law is to track: the three steps of v-CBC.
///
/// 1. [`virtual_rate`](Self::virtual_rate) and [`virtual_output`](Self::virtual_output) are the virtual system Γ_v, h_v, driven by
///    the real state x. Paper, eq. virtualsystemTheorem1.
/// 2. [`law`](Self::law) is u_v = ζ(x_v, x, t), made for the virtual system; [`reference`](Self::reference) is what that shall follow, and
///    [`weight`](Self::weight) the length in which it shall contract.
/// 3. The real system gets u = ζ(x, x, t): [`actual_rate`](Self::actual_rate).
///
/// What the method asks for, each a function of its own:
///
/// - x_v = x solves the virtual system: [`actual_defect`](Self::actual_defect) vanishes;
/// - the reference solves the virtual closed loop: [`reference_defect`](Self::reference_defect) vanishes;
/// - the virtual closed loop contracts: a matrix measure of [`generalised_jacobian`](super::generalised_jacobian) of
///   [`along`](Self::along), which is both the system and the weight, is negative, at samples or over a box of intervals.
///
/// Then the real state converges to the reference. Paper, theorem partialcontraction.
///
/// A scalar system with a cubic term:
///
/// ```
/// use flexure_core::contraction::{ControlSystem, VirtualSystem, generalised_jacobian, measure_2, runge_kutta};
/// use flexure_core::linalg::{Matrix, Vector};
/// use flexure_core::scalar::{Dual, Over, Piecewise, Scalar};
///
/// /// ẋ = −x − x³ + u.
/// struct Cubic;
/// impl<C: Scalar> ControlSystem<C, 1, 1> for Cubic {
///     fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Vector<T, 1> {
///         x.map(|x| -x - x.square() * x)
///     }
///     fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, 1>, _: T) -> Matrix<T, 1, 1> {
///         Matrix::identity()
///     }
///     fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 1>, _: T) -> Vector<T, 1> {
///         *x
///     }
/// }
///
/// /// The virtual system is linear in x_v; it shall follow sin t.
/// struct Design(Cubic);
/// impl<C: Scalar> VirtualSystem<C, 1, 1> for Design {
///     type Actual = Cubic;
///     fn actual(&self) -> &Cubic {
///         &self.0
///     }
///     fn virtual_rate<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 1>, x: &Vector<T, 1>, u: &Vector<T, 1>, _: T) -> Vector<T, 1> {
///         *u - x_v.scaled(T::ONE + x[0].square())
///     }
///     fn virtual_output<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 1>, _: &Vector<T, 1>, _: T) -> Vector<T, 1> {
///         *x_v
///     }
///     fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 1>, x: &Vector<T, 1>, t: T) -> Vector<T, 1> {
///         let target = Dual::<T, 1>::variable(t, 0).sin(); // and its rate
///         Vector([target.gradient[0] + target.value * (T::ONE + x[0].square()) - (x_v[0] - target.value)])
///     }
///     fn reference<T: Over<C> + Piecewise>(&self, _: &Vector<T, 1>, t: T) -> Vector<T, 1> {
///         Vector([t.sin()])
///     }
///     fn weight<T: Over<C> + Piecewise>(&self, _: &Vector<T, 1>, _: &Vector<T, 1>, _: T) -> Matrix<T, 1, 1> {
///         Matrix::identity()
///     }
/// }
///
/// let (design, x, t) = (Design(Cubic), Vector([0.5]), 0.3);
/// assert!(design.actual_defect::<f64>(&x, &Vector([2.0]), t).rate[0].abs() < 1e-15);
/// assert!(design.reference_defect::<f64>(&x, t)[0].abs() < 1e-15);
/// let now = design.along(x, t);
/// assert_eq!(measure_2(&generalised_jacobian::<f64, _, _>(&now, &now, &Vector([2.0]), 0.0)), -2.25);
/// ```
pub trait VirtualSystem<C: Scalar, const N: usize, const M: usize> {
    /// The real system Σ_u.
    type Actual: ControlSystem<C, N, M>;

    /// Σ_u.
    fn actual(&self) -> &Self::Actual;

    /// Γ_v(x_v, x, u_v, t).
    fn virtual_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, N>,
        x: &Vector<T, N>,
        u_v: &Vector<T, M>,
        t: T,
    ) -> Vector<T, N>;

    /// h_v(x_v, x, t).
    fn virtual_output<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, N>,
        x: &Vector<T, N>,
        t: T,
    ) -> Vector<T, M>;

    /// ζ(x_v, x, t).
    fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, N>, x: &Vector<T, N>, t: T) -> Vector<T, M>;

    /// The state x_d that the virtual system shall be in while the real one is at `x`.
    fn reference<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N>;

    /// Θ(x_v, x, t): the virtual closed loop contracts in a norm of Θ δx_v.
    fn weight<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, N>, x: &Vector<T, N>, t: T) -> Matrix<T, N, N>;

    /// Φ_v(x_v, x, t) = Γ_v(x_v, x, ζ(x_v, x, t), t), the virtual closed loop. Paper, eq. virtualsystemTheorem.
    #[inline]
    fn closed_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, N>,
        x: &Vector<T, N>,
        t: T,
    ) -> Vector<T, N> {
        self.virtual_rate(x_v, x, &self.law(x_v, x, t), t)
    }

    /// The real system under u = ζ(x, x, t).
    #[inline]
    fn actual_rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        self.actual().rate_under(x, &self.law(x, x, t), t)
    }

    /// What is missing from Γ_v(x, x, u, t) = f + G u and h_v(x, x, t) = h: zero if this is a virtual system. Paper, eq.
    /// virtualcontrolsystemTheorem1 and virtualsystemTheorem-condition.
    #[inline]
    fn actual_defect<T: Over<C> + Piecewise>(
        &self,
        x: &Vector<T, N>,
        u: &Vector<T, M>,
        t: T,
    ) -> ActualDefect<T, N, M> {
        ActualDefect {
            rate: self.virtual_rate(x, x, u, t) - self.actual().rate_under(x, u, t),
            output: self.virtual_output(x, x, t) - self.actual().output(x, t),
        }
    }

    /// How far the reference is from solving the virtual closed loop while the real system is at `x` under the law: ẋ_d − Φ_v(x_d, x, t).
    #[inline]
    fn reference_defect<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        let moved = self.reference(&moving(x, &self.actual_rate(x, t)), passing(t));
        direction(&moved) - self.closed_rate(&moved.map(|x| x.value), x, t)
    }

    /// The virtual closed loop at the instant when the real system is at `x`.
    #[inline]
    fn along(&self, x: Vector<C, N>, t: C) -> Along<'_, Self, C, N, M>
    where
        Self: Sized,
        C: Over<C> + Piecewise,
    {
        Along { design: self, rate: self.actual_rate(&x, t), x, t }
    }
}

/// From [`VirtualSystem::actual_defect`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActualDefect<T, const N: usize, const M: usize> {
    /// Γ_v(x, x, u, t) − f − G u.
    pub rate: Vector<T, N>,
    /// h_v(x, x, t) − h.
    pub output: Vector<T, M>,
}

/// A virtual closed loop at one instant of the real system: [`Dynamics`] of x_v, and [`MatrixField`], the weight Θ.
///
/// Their time τ in s counts from that instant, and the real state is x + ẋ τ: right to first order, which is all that Θ̇ and Jacobians
/// at τ = 0 see. Of intervals it stands for a box of instants.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a, V, C, const N: usize, const M: usize> {
    design: &'a V,
    x: Vector<C, N>,
    rate: Vector<C, N>,
    t: C,
}

impl<V, C: Scalar, const N: usize, const M: usize> Along<'_, V, C, N, M> {
    /// Real state and time `tau` after the instant.
    #[inline]
    fn instant<T: Over<C>>(&self, tau: T) -> (Vector<T, N>, T) {
        (Vector::from_fn(|i| T::constant(self.x[i]) + tau.scale(self.rate[i])), T::constant(self.t) + tau)
    }
}

impl<C, V, const N: usize, const M: usize> Dynamics<C, N> for Along<'_, V, C, N, M>
where
    C: Scalar,
    V: VirtualSystem<C, N, M>,
{
    #[inline]
    fn rate<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, N>, tau: T) -> Vector<T, N> {
        let (x, t) = self.instant(tau);
        self.design.closed_rate(x_v, &x, t)
    }
}

impl<C, V, const N: usize, const M: usize> MatrixField<C, N> for Along<'_, V, C, N, M>
where
    C: Scalar,
    V: VirtualSystem<C, N, M>,
{
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, N>, tau: T) -> Matrix<T, N, N> {
        let (x, t) = self.instant(tau);
        self.design.weight(x_v, &x, t)
    }
}

/// A virtual system in closed loop with its real system: the state (x, x_v), of `D = 2 N` numbers.
#[derive(Clone, Copy, Debug)]
pub struct Together<'a, V, const N: usize, const M: usize>(pub &'a V);

impl<C, V, const N: usize, const M: usize, const D: usize> Dynamics<C, D> for Together<'_, V, N, M>
where
    C: Scalar,
    V: VirtualSystem<C, N, M>,
{
    #[inline]
    fn rate<T: Over<C> + Piecewise>(&self, state: &Vector<T, D>, t: T) -> Vector<T, D> {
        let (x, x_v) = (part::<T, N, D>(state, 0), part(state, N));
        stack(&self.0.actual_rate(&x, t), &self.0.closed_rate(&x_v, &x, t))
    }
}
