//! Regulation after gravity is cancelled.

use super::sliding::motors;
use super::{ControlLaw, MotorPd};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = g + D_m K⁻¹ ġ + B K⁻¹ g̈ + u_0 with u_0 = −K_P (θ_n − q_0) − K_D (θ̇_n − q̇_0): in the shifted motor position
/// θ_n = θ − K⁻¹ g(q) the robot moves as if there were no gravity. De Luca and Flacco, *Dynamic gravity cancellation in robots
/// with flexible transmissions*, IEEE Conf. Decision and Control, 2010.
///
/// Any K_P > 0 and any stiffness will do. A law of regulation: on tracking tasks q_0 is the reference as it passes.
#[derive(Clone, Copy, Debug)]
pub struct GravityCancellation<C, const N: usize> {
    /// K_P and K_D, the feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for GravityCancellation<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let links = Vector::from_derivatives(&[x.q_l, x.v_l, robot.link_acceleration(x)]);
        let gravity = robot.links.gravity_torque::<Jet<T, 3>>(&links);
        let [shift, shift_rate, shift_second] = motors(robot, &Vector::ZERO, &gravity).derivatives();
        let [q_d, v_d] = q_ld.map(|x| x.truncate::<2>()).derivatives();
        self.motor.feedback(&(x.q_m - shift - q_d), &(x.v_m - shift_rate - v_d))
            + gravity.map(|g| g.coefficient(0))
            + robot.motor_damping.diag_mul(&shift_rate)
            + robot.motor_inertia.diag_mul(&shift_second)
    }
}
