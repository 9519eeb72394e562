//! Port-Hamiltonian systems.

use crate::linalg::{Matrix, Vector};
use crate::model::seeded;
use crate::scalar::{Dual, Over, Piecewise, Scalar};

use super::system::rows;
use super::tangent::{moving, passing};
use super::{ControlSystem, MatrixField};

/// ẋ = (J − R) ∂H/∂x + g u, y = gᵀ ∂H/∂x. Paper, eq. IOpHsystem; H may depend on time, as that of a virtual system does.
///
/// J is skew-symmetric and R symmetric; where R is not positive semidefinite the paper speaks of a pH-like system.
/// [`PortSystem`] makes a [`ControlSystem`] of it, [`Hessian`] a metric.
pub trait PortHamiltonian<C: Scalar, const N: usize, const M: usize> {
    /// H(x, t).
    fn hamiltonian<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> T;

    /// J(x, t).
    fn interconnection<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N>;

    /// R(x, t).
    fn dissipation<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N>;

    /// g(x, t).
    fn input<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, M>;

    /// ∂H/∂x.
    #[inline]
    fn gradient<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        Vector(self.hamiltonian(&seeded(x), Dual::<T, N>::constant(t)).gradient)
    }

    /// ∂²H/∂x².
    #[inline]
    fn hessian<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        rows(&self.gradient(&seeded(x), Dual::<T, N>::constant(t)))
    }

    /// The terms of Ḣ at (x, u, t).
    #[inline]
    fn energy_balance<T: Over<C> + Piecewise>(
        &self,
        x: &Vector<T, N>,
        u: &Vector<T, M>,
        t: T,
    ) -> EnergyBalance<T>
    where
        Self: Sized,
    {
        let (effort, port) = (self.gradient(x, t), self.input(x, t));
        let rate = PortSystem(self).rate_under(x, u, t);
        EnergyBalance {
            rate: self.hamiltonian(&moving(x, &rate), passing(t)).gradient[0],
            supplied: (port.transpose() * effort).dot(u),
            dissipated: effort.dot(&(self.dissipation(x, t) * effort)),
            explicit: self.hamiltonian(&x.map(Dual::<T, 1>::constant), passing(t)).gradient[0],
        }
    }
}

/// Ḣ = yᵀu − ∂Hᵀ R ∂H + ∂H/∂t.
///
/// Where the last two make no more than zero the map u ↦ y is cyclo-passive, and passive if H is bounded from below as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyBalance<T> {
    /// Ḣ along the solution.
    pub rate: T,
    /// yᵀu.
    pub supplied: T,
    /// ∂Hᵀ R ∂H.
    pub dissipated: T,
    /// ∂H/∂t.
    pub explicit: T,
}

/// A port-Hamiltonian system as a control system.
#[derive(Clone, Copy, Debug)]
pub struct PortSystem<P>(pub P);

impl<C, P, const N: usize, const M: usize> ControlSystem<C, N, M> for PortSystem<P>
where
    C: Scalar,
    P: PortHamiltonian<C, N, M>,
{
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, N> {
        (self.0.interconnection(x, t) - self.0.dissipation(x, t)) * self.0.gradient(x, t)
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, M> {
        self.0.input(x, t)
    }
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Vector<T, M> {
        self.0.input(x, t).transpose() * self.0.gradient(x, t)
    }
}

impl<C, P, const N: usize, const M: usize> PortHamiltonian<C, N, M> for &P
where
    C: Scalar,
    P: PortHamiltonian<C, N, M>,
{
    #[inline]
    fn hamiltonian<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> T {
        (*self).hamiltonian(x, t)
    }
    #[inline]
    fn interconnection<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        (*self).interconnection(x, t)
    }
    #[inline]
    fn dissipation<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        (*self).dissipation(x, t)
    }
    #[inline]
    fn input<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, M> {
        (*self).input(x, t)
    }
}

/// ∂²H/∂x² of a port-Hamiltonian system of `M` inputs, as a metric.
#[derive(Clone, Copy, Debug)]
pub struct Hessian<P, const M: usize>(pub P);

impl<C, P, const N: usize, const M: usize> MatrixField<C, N> for Hessian<P, M>
where
    C: Scalar,
    P: PortHamiltonian<C, N, M>,
{
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, N>, t: T) -> Matrix<T, N, N> {
        self.0.hessian(x, t)
    }
}
