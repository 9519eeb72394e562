//! Spring torques by motor position: an inner loop of motors around the link law of passivity.

use super::inner_loop::InnerLoop;
use super::sliding::motors;
use super::{ControlLaw, LinkGains};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// Motors are driven to θ_d = q + K⁻¹ u_R, where the springs would put u_R of [`Passivity`](super::Passivity) on the links, by
/// u = K (θ − q) + D_m θ̇ + B (θ̈_d − k_v θ̃̇ − k_p θ̃): θ̃̈ + k_v θ̃̇ + k_p θ̃ = 0 whatever the links do, and these obey
/// M ṡ_1 + (C + D_l + γ_l) s_1 = K θ̃.
#[derive(Clone, Copy, Debug)]
pub struct Cascade<C, const N: usize> {
    /// λ, how fast link errors decay [1/s].
    pub shaping: Vector<C, N>,
    /// γ_l, damping of s_1 on the links [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// k_p and k_v of the motors.
    pub inner: InnerLoop<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Cascade<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let links = LinkGains::sliding(self.shaping, self.link_damping).spring_torque(robot, x, q_ld);
        let q_d = q_ld.map(|x| x.truncate::<3>());
        self.inner.torque(robot, x, &motors(robot, &(q_d + links.error), &links.torque))
    }
}
