//! Integrator backstepping from links to motors.

use super::sliding::motors;
use super::{ControlLaw, LinkGains};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// With θ_d = q + K⁻¹ u_R, where the springs would put u_R of [`Passivity`](super::Passivity) on the links, and θ̃ = θ − θ_d:
/// u = K (θ − q) + D_m θ̇ + B (θ̈_d − 2 a θ̃̇ − 2 a² θ̃ − W⁻¹ K (ṡ_1 + a s_1)). Brogliato, Ortega and Lozano, *Global tracking
/// controllers for flexible-joint manipulators: a comparative study*, Automatica 31, 1995, which has a = W = 1.
///
/// With z = θ̃̇ + a θ̃ + W⁻¹ K s_1, V = ½ s_1ᵀ M s_1 + ½ θ̃ᵀ W θ̃ + ½ zᵀ a⁻² W z decays as
/// V̇ = −s_1ᵀ (D_l + γ_l) s_1 − θ̃ᵀ a W θ̃ − zᵀ a⁻¹ W z.
#[derive(Clone, Copy, Debug)]
pub struct Backstepping<C, const N: usize> {
    /// λ, how fast link errors decay [1/s].
    pub shaping: Vector<C, N>,
    /// γ_l, damping of s_1 on the links [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// W, the weight of motor errors [N m/rad].
    pub metric: Vector<C, N>,
    /// a, how fast motor errors decay [1/s].
    pub motor_shaping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Backstepping<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let links = LinkGains::sliding(self.shaping, self.link_damping).spring_torque(robot, x, q_ld);
        let q_d = q_ld.map(|x| x.truncate::<3>());
        let [theta_d, rate_d, second_d] = motors(robot, &(q_d + links.error), &links.torque).derivatives();
        let [s, s_rate, _] = links.velocity_error.derivatives();
        let twice = |v: Vector<T, N>| v + v;
        let once = |v: &Vector<T, N>| self.motor_shaping.diag_mul(v);
        let coupling = Vector::from_fn(|i| robot.stiffness[i] / self.metric[i]);
        let decay = twice(once(&(x.v_m - rate_d + once(&(x.q_m - theta_d)))));
        let a = second_d - decay - coupling.diag_mul(&(s_rate + once(&s)));
        robot.motor_torque(x, &a)
    }
}
