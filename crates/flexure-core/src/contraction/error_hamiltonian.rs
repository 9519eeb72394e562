//! The closed loop of v-CBC in port-Hamiltonian form, for the members that keep it.

use crate::control::{Shaping, Vcbc};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, LinkMatrices, Links, MassFactor, Motion};
use crate::scalar::{Over, Piecewise, Scalar};
use crate::virtual_system::ErrorState;

use super::PortHamiltonian;
use super::blocks::{four, squares};
use super::instant::after;

/// The error x̃ under v-CBC while the robot passes through `motion`, in port-Hamiltonian form with the input ω and the error Hamiltonian H̃.
/// Paper, eq. design-closed-complete-structure-Lamnda.
///
/// It is the closed loop of [`ErrorLoop`](super::ErrorLoop) if and only if φ_l = ∫Π_l and φ_m = Π_m q̃_m:
/// [`keeps_hamiltonian_structure`](super::keeps_hamiltonian_structure) asks so. The shaping functions of the law do not enter.
#[derive(Clone, Copy, Debug)]
pub struct ErrorHamiltonian<'a, C, L, Pl, Pm, const N: usize> {
    /// The robot.
    pub robot: &'a Fjr<C, L, N>,
    /// The law.
    pub law: &'a Vcbc<C, Pl, Pm, N>,
    /// The real motion.
    pub motion: Motion<C, N>,
}

impl<C, L, Pl, Pm, const N: usize, const D: usize, const M: usize> PortHamiltonian<C, D, M>
    for ErrorHamiltonian<'_, C, L, Pl, Pm, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    /// H̃ = ∫φ_l + ½ q̃_mᵀ Π_m q̃_m + ½ σᵀ M⁻¹ σ with φ_l = ∫Π_l. Paper, eq. closed-looperror-Hamiltonianfunction, as corrected in
    /// `docs/errata.md`; for constant Π_l it is eq. closed-looperror-Hamiltonianfunction-quadratic.
    #[inline]
    fn hamiltonian<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> T {
        let (robot, x) = (self.robot, ErrorState::<T, N>::from_vector(x));
        let s_l = robot.links.factor(&after(&self.motion, t).q_l).solve(&x.sigma_l);
        let s_m = robot.motor_inertia.map(C::recip).diag_mul(&x.sigma_m);
        let motors = x.e_m.dot(&self.law.motor.metric.diag_mul(&x.e_m));
        self.law.link.metric.potential(&x.e_l)
            + T::from_f64(0.5) * (motors + x.sigma_l.dot(&s_l) + x.sigma_m.dot(&s_m))
    }

    /// The Ξ of [`Structure`](crate::virtual_system::Structure).
    #[inline]
    fn interconnection<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let x = after(&self.motion, t);
        let skew = LinkMatrices::new(&self.robot.links, &x.q_l, &x.v_l).skew;
        let (stiffness, metric) = (self.robot.stiffness, self.law.motor.metric);
        let coupling = Matrix::diagonal(&Vector::from_fn(|i| T::constant(stiffness[i] / metric[i])));
        let (zero, one) = (Matrix::ZERO, Matrix::identity());
        squares([
            [zero, zero, one, zero],
            [zero, zero, -coupling, one],
            [-one, coupling, -skew, zero],
            [zero, -one, zero, zero],
        ])
    }

    /// R̃ = diag(I, I, D_l + K_ld − ½ Ṁ_l, D_m + K_md).
    #[inline]
    fn dissipation<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let x = after(&self.motion, t);
        let mass_rate = LinkMatrices::new(&self.robot.links, &x.q_l, &x.v_l).mass_rate;
        let diagonal = |d: Vector<C, N>| Matrix::diagonal(&d.lift());
        let links = diagonal(self.robot.link_damping + self.law.link.damping);
        let motors = diagonal(self.robot.motor_damping + self.law.motor.damping);
        let one = Matrix::identity();
        four([one, one, links - mass_rate.scaled(T::from_f64(0.5)), motors])
    }

    /// Ψ.
    #[inline]
    fn input<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, _: T) -> Matrix<T, D, M> {
        const { assert!(2 * N == M, "an input for each momentum") }
        Matrix::from_fn(|i, j| if i == 2 * N + j { T::ONE } else { T::ZERO })
    }
}
