//! The robot immersed in a controlled rigid one.

use super::inner_loop::InnerLoop;
use super::sliding::motors;
use super::{ControlLaw, LoadedLaw, MotorPd};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the design of Astolfi and Ortega, *Immersion and invariance: a new tool for stabilization and adaptive control of nonlinear systems*, IEEE
/// Trans. Automatic Control 48, 2003, for their flexible-joint example, with a choice of target that is this project's: the links under rigid computed torque
/// w = M q̈_d + C(q, q̇) q̇_d + D_l q̇_d + g − K_Pl e − K_Dl ė.
///
/// Off the manifold θ = π, π = q + K⁻¹ w, motors obey z̈ + k_v ż + k_p z = 0, z = θ − π, whatever the links do; on it V = ½ ėᵀMė + ½ eᵀK_Pl e has
/// V̇ = −ėᵀ(D_l + K_Dl)ė + ėᵀK z. Global for any gains above 0. [`Cascade`](super::Cascade) is the same with a sliding target.
#[derive(Clone, Copy, Debug)]
pub struct ImmersionInvariance<C, const N: usize> {
    /// K_Pl and K_Dl of the target, feedback of link errors.
    pub link: MotorPd<C, N>,
    /// k_p and k_v, how motors get onto the manifold.
    pub inner: InnerLoop<C, N>,
}

impl<C: Scalar, const N: usize> MotorPd<C, N> {
    /// Computed torque of the links as they are: M q̈_d + C(q, q̇) q̇_d + D_l q̇_d + g − K_P e − K_D ė [N m], for links that move as the series `q` in rad, which has
    /// one coefficient more than the torque.
    #[inline]
    pub(super) fn link_torque<T: Over<C>, L: Links<C, N>, const U: usize, const U1: usize>(
        &self,
        robot: &Fjr<C, L, N>,
        q: &Vector<Jet<T, U1>, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<Jet<T, U>, N> {
        let (v_d, a_d) = (q_ld.map(|q| q.differentiate::<U>()), q_ld.map(|q| q.differentiate_twice::<U>()));
        let (v, error) = (q.map(|q| q.differentiate::<U>()), *q - q_ld.map(|q| q.truncate::<U1>()));
        robot.links.inverse_dynamics(&q.map(|q| q.truncate()), &v, &v_d, &a_d)
            + robot.link_damping.diag_mul(&v_d)
            + self.feedback(&error.map(|e| e.truncate()), &error.map(|e| e.differentiate()))
    }
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for ImmersionInvariance<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        self.torque_under(robot, x, q_ld, &Vector::ZERO)
    }
}

impl<C: Scalar, const N: usize> LoadedLaw<C, N> for ImmersionInvariance<C, N> {
    #[inline]
    fn torque_under<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        load: &Vector<T, N>,
    ) -> Vector<T, N> {
        let motion = robot.link_motion_under(&robot.links.factor(&x.q_l), x, load);
        let torque = self.link.link_torque::<_, _, 3, 4>(robot, &motion, q_ld) - load.map(Jet::value);
        let manifold = motors(robot, &motion.map(|q| q.truncate()), &torque);
        self.inner.torque(robot, x, &manifold)
    }
}
