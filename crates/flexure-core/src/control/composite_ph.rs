//! Slow and fast: the rigid law of the links and motors, and damping of what the springs do beside it.

use super::ControlLaw;
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the idea of Jardón-Kojakhmetov, Muñoz-Arias and Scherpen, *Model reduction of a flexible-joint robot: a port-Hamiltonian approach*, IFAC
/// Symp. Nonlinear Control Systems, 2016, not their formula: u = u_s + u_f, the tracking law of the rigid port-Hamiltonian robot with the inertia
/// M_s = M + B, and feedback of how far the springs are from the slow manifold.
///
/// u_s = M_s q̈_r + C q̇_r + (D_l + D_m) q̇_r + g − Π e − K_d σ, with q̇_r = q̇_d − Λ e, σ = q̇ − q̇_r; u_f = −K_z (ζ − K⁻¹ h) − K_f (θ̇ − q̇), h the spring torque on the
/// manifold to order 0. Exponential up to errors of the order of the compliance, for springs that are stiff enough only: on soft ones the loop is unstable.
#[derive(Clone, Copy, Debug)]
pub struct CompositePh<C, const N: usize> {
    /// Λ, how fast link errors decay [1/s].
    pub shaping: Vector<C, N>,
    /// Π, the metric of link errors [N m/rad].
    pub metric: Vector<C, N>,
    /// K_d, injected damping [N m s/rad].
    pub damping: Vector<C, N>,
    /// K_z, feedback of spring deflections [N m/rad].
    pub fast_stiffness: Vector<C, N>,
    /// K_f, damping of the springs [N m s/rad].
    pub fast_damping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for CompositePh<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let [q_d, v_d, a_d, ..] = q_ld.derivatives();
        let (e, de) = (x.q_l - q_d, x.v_l - v_d);
        let (v_r, a_r) = (v_d - self.shaping.diag_mul(&e), a_d - self.shaping.diag_mul(&de));
        let damping = robot.link_damping + robot.motor_damping;
        let slow = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &v_r, &a_r)
            + robot.motor_inertia.diag_mul(&a_r)
            + damping.diag_mul(&v_r)
            - self.metric.diag_mul(&e)
            - self.damping.diag_mul(&(x.v_l - v_r));
        // The acceleration that the rigid robot would have, and what the springs would then carry.
        let together = robot.links.mass_matrix(&x.q_l) + Matrix::diagonal(&robot.motor_inertia.lift());
        let bias = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO);
        let a = together.ldl().solve(&(slow - bias - damping.diag_mul(&x.v_l)));
        let carried = slow - robot.motor_inertia.diag_mul(&a) - robot.motor_damping.diag_mul(&x.v_l);
        let off = x.deflection() - robot.stiffness.map(C::recip).diag_mul(&carried);
        slow - self.fast_stiffness.diag_mul(&off) - self.fast_damping.diag_mul(&(x.v_m - x.v_l))
    }
}
