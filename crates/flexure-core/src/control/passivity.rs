//! Passivity-based tracking.

use super::sliding::motors;
use super::{ControlLaw, LinkGains};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// With q̇_r = q̇_d − λ e, s_1 = ė + λ e and u_R = M q̈_r + C q̇_r + D_l q̇_r + g − γ_l s_1 the motors shall be at
/// θ_d = q_d + K⁻¹ u_R, and u = B θ̈_r + D_m θ̇_r + K (θ_d − q_d) − γ_m s_2 with θ̇_r = θ̇_d − λ θ̃ and s_2 = θ̇ − θ̇_r. Brogliato, Ortega
/// and Lozano, *Global tracking controllers for flexible-joint manipulators: a comparative study*, Automatica 31, 1995, with
/// the dampers of the robot.
///
/// V = ½ s_1ᵀ M s_1 + ½ s_2ᵀ B s_2 + ½ (θ̃ − e)ᵀ K (θ̃ − e) decays as V̇ = −s_1ᵀ (D_l + γ_l) s_1 − s_2ᵀ (D_m + γ_m) s_2 −
/// (θ̃ − e)ᵀ K λ (θ̃ − e), which needs the same λ on both sides.
#[derive(Clone, Copy, Debug)]
pub struct Passivity<C, const N: usize> {
    /// λ, how fast position errors decay [1/s].
    pub shaping: Vector<C, N>,
    /// γ_l, damping of s_1 on the links [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// γ_m, damping of s_2 on the motors [N m s/rad].
    pub motor_damping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Passivity<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let wanted = LinkGains::sliding(self.shaping, self.link_damping).spring_torque(robot, x, q_ld).torque;
        let theta_d = motors(robot, &q_ld.map(|x| x.truncate::<3>()), &wanted);
        let [theta_d, rate_d, second_d] = theta_d.derivatives();
        let (error, rate) = (x.q_m - theta_d, x.v_m - rate_d);
        let v_r = rate_d - self.shaping.diag_mul(&error);
        let a_r = second_d - self.shaping.diag_mul(&rate);
        robot.motor_inertia.diag_mul(&a_r)
            + robot.motor_damping.diag_mul(&v_r)
            + wanted.map(|u| u.coefficient(0))
            - self.motor_damping.diag_mul(&(x.v_m - v_r))
    }
}
