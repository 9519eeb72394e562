//! The virtual system of a flexible-joint robot in pH-like form.

use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, LinkMatrices, Links, MassFactor, Motion, State};
use crate::scalar::{Over, Piecewise, Scalar};

use super::PortHamiltonian;
use super::blocks::{four, squares};
use super::instant::after;

/// The virtual system while the robot passes through `motion`: [`virtual_dynamics`](crate::virtual_system::virtual_dynamics) as
/// ẋ_v = (J_v − R_v) ∂H_v/∂x_v + g u_mv, with the state (q_lv, q_mv, p_lv, p_mv) of `D = 4 N` numbers. Paper, eq. pHlike-virtual.
///
/// It is pH-like only: R_v contains −½ Ṁ_l, which may have any sign; what that supplies, ∂H_v/∂t takes away.
///
/// Time counts from the instant, and the real links are at q_l + q̇_l t: right to first order, which is all that rates see.
#[derive(Clone, Copy, Debug)]
pub struct VirtualRobot<'a, C, L, const N: usize> {
    /// The robot.
    pub robot: &'a Fjr<C, L, N>,
    /// The real motion.
    pub motion: Motion<C, N>,
}

impl<C, L, const N: usize, const D: usize> PortHamiltonian<C, D, N> for VirtualRobot<'_, C, L, N>
where
    C: Scalar,
    L: Links<C, N>,
{
    /// H_v = ½ p_vᵀ M⁻¹(q) p_v + P(q_v) in J. Paper, eq. phmechanicalHamiltonianvirtual.
    #[inline]
    fn hamiltonian<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, D>, t: T) -> T {
        let (robot, x_v) = (self.robot, State::<T, N>::from_vector(x_v));
        let v_lv = robot.links.factor(&after(&self.motion, t).q_l).solve(&x_v.p_l);
        let v_mv = robot.motor_inertia.map(C::recip).diag_mul(&x_v.p_m);
        let zeta = x_v.q_m - x_v.q_l;
        let twice = x_v.p_l.dot(&v_lv) + x_v.p_m.dot(&v_mv) + zeta.dot(&robot.stiffness.diag_mul(&zeta));
        T::from_f64(0.5) * twice + robot.links.potential_energy(&x_v.q_l)
    }

    /// J_v = [[0, I], [−I, −S_H]], with the S_l of the links in S_H. Paper, eq. pH-likesystem.
    #[inline]
    fn interconnection<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let x = after(&self.motion, t);
        let skew = LinkMatrices::new(&self.robot.links, &x.q_l, &x.v_l).skew;
        let (zero, one) = (Matrix::ZERO, Matrix::identity());
        squares([
            [zero, zero, one, zero],
            [zero, zero, zero, one],
            [-one, zero, -skew, zero],
            [zero, -one, zero, zero],
        ])
    }

    /// R_v = diag(0, 0, D_l − ½ Ṁ_l, D_m). Paper, eq. pH-likesystem.
    #[inline]
    fn dissipation<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let x = after(&self.motion, t);
        let mass_rate = LinkMatrices::new(&self.robot.links, &x.q_l, &x.v_l).mass_rate;
        let diagonal = |d: Vector<C, N>| Matrix::diagonal(&d.lift());
        let links = diagonal(self.robot.link_damping) - mass_rate.scaled(T::from_f64(0.5));
        four([Matrix::ZERO, Matrix::ZERO, links, diagonal(self.robot.motor_damping)])
    }

    #[inline]
    fn input<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, _: T) -> Matrix<T, D, N> {
        Matrix::from_fn(|i, j| if i == 3 * N + j { T::ONE } else { T::ZERO })
    }
}
