//! The closed loop of v-CBC in error coordinates, as a system.

use crate::control::{Input, Shaping, Vcbc};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, MassFactor, Motion};
use crate::scalar::{Over, Piecewise, Scalar};
use crate::virtual_system::{ErrorState, closed_loop};

use super::blocks::{four, join, quarters, stack};
use super::instant::after;
use super::{ControlSystem, MatrixField};

/// The error x̃ = (q̃_l, q̃_m, σ_l, σ_m), of `D = 4 N` numbers, under v-CBC while the robot passes through `motion`: a [`ControlSystem`] with
/// the input ω = (ω_l, ω_m) and the output M⁻¹ σ, of `2 N` numbers, and a [`MatrixField`], its metric Π. [`closed_loop`] says which system.
///
/// Time counts from that instant, and the real links are at q_l + q̇_l t: right to first order, which is all that rates of metrics
/// see. Of intervals it stands for a box of motions.
#[derive(Clone, Copy, Debug)]
pub struct ErrorLoop<'a, C, L, Pl, Pm, const N: usize> {
    /// The robot.
    pub robot: &'a Fjr<C, L, N>,
    /// The law.
    pub law: &'a Vcbc<C, Pl, Pm, N>,
    /// The real motion.
    pub motion: Motion<C, N>,
}

impl<C, L, Pl, Pm, const N: usize, const D: usize, const M: usize> ControlSystem<C, D, M>
    for ErrorLoop<'_, C, L, Pl, Pm, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, D> {
        let x = ErrorState::from_vector(x);
        closed_loop(self.robot, self.law, &x, &after(&self.motion, t), &Input::ZERO).to_vector()
    }
    /// Ψ.
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, _: T) -> Matrix<T, D, M> {
        Matrix::from_fn(|i, j| if i == 2 * N + j { T::ONE } else { T::ZERO })
    }
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, M> {
        const { assert!(2 * N == M, "an input and an output for each momentum") }
        let error = ErrorState::<T, N>::from_vector(x);
        let s_l = self.robot.links.factor(&after(&self.motion, t).q_l).solve(&error.sigma_l);
        let s_m = self.robot.motor_inertia.map(C::recip).diag_mul(&error.sigma_m);
        stack(&s_l, &s_m)
    }
}

/// Π = diag(Π_l, Π_m, M_l⁻¹, M_m⁻¹). Paper, eq. design-dLCF-sigma-flexible.
impl<C, L, Pl, Pm, const N: usize, const D: usize> MatrixField<C, D> for ErrorLoop<'_, C, L, Pl, Pm, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    #[inline]
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let factor = self.robot.links.factor(&after(&self.motion, t).q_l);
        let unit = Matrix::<T, N, N>::identity();
        let inverse_mass = Matrix(core::array::from_fn(|j| factor.solve(&unit.row(j)).0));
        let Pi_l = Matrix::diagonal(&self.law.link.metric.at(&ErrorState::<T, N>::from_vector(x).e_l));
        let constant = |d: Vector<C, N>| Matrix::diagonal(&d.lift());
        let Pi_m = constant(self.law.motor.metric);
        four([Pi_l, Pi_m, inverse_mass, constant(self.robot.motor_inertia.map(C::recip))])
    }
}

impl<T: Copy, const N: usize> ErrorState<T, N> {
    /// The error whose numbers are those of `x`, of `D = 4 N` entries: (q̃_l, q̃_m, σ_l, σ_m).
    #[inline]
    pub fn from_vector<const D: usize>(x: &Vector<T, D>) -> Self {
        let [e_l, e_m, sigma_l, sigma_m] = quarters(x);
        Self { e_l, e_m, sigma_l, sigma_m }
    }

    /// Its numbers as a vector of `D = 4 N` entries.
    #[inline]
    pub fn to_vector<const D: usize>(&self) -> Vector<T, D> {
        join([self.e_l, self.e_m, self.sigma_l, self.sigma_m])
    }
}
