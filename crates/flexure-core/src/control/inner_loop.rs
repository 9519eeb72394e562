//! Motors that are driven to where the springs give what the links shall get.

use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// θ̃̈ + k_v θ̃̇ + k_p θ̃ = 0 of the motors about any θ_d, whatever the links do: u = K (θ − q) + D_m θ̇ + B (θ̈_d − k_v θ̃̇ − k_p θ̃).
#[derive(Clone, Copy, Debug)]
pub struct InnerLoop<C, const N: usize> {
    /// k_p, feedback of the motor position error θ̃ [1/s²].
    pub position: Vector<C, N>,
    /// k_v, feedback of its rate [1/s].
    pub velocity: Vector<C, N>,
}

impl<C: Scalar, const N: usize> InnerLoop<C, N> {
    /// Motor torque [N m], for motors that shall be at `theta_d` in rad, to order 2.
    #[inline]
    pub fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        theta_d: &Vector<Jet<T, 3>, N>,
    ) -> Vector<T, N> {
        let [theta_d, rate_d, second_d] = theta_d.derivatives();
        let a =
            second_d - self.velocity.diag_mul(&(x.v_m - rate_d)) - self.position.diag_mul(&(x.q_m - theta_d));
        robot.motor_torque(x, &a)
    }
}
