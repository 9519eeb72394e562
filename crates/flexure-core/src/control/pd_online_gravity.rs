//! PD control of the motors with the gravity of where they are.

use super::{ControlLaw, MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = −K_P (θ − θ_0) − K_D (θ̇ − θ̇_0) + g(q̄(θ)), where q̄(θ) is where the links would rest with the motors at θ:
/// [`Fjr::links_at_rest`].
/// De Luca, Siciliano and Zollo, *PD control with on-line gravity compensation for robots with elastic joints*, Automatica
/// 41, 2005; with q̄(θ): Albu-Schäffer, Ott and Hirzinger, Int. J. Robotics Research 26, 2007.
///
/// Any K_P > 0 will do as long as the springs are stiffer than gravity. A law of regulation: on tracking tasks θ_0 is
/// q_d + K⁻¹ g(q_d) as it passes.
#[derive(Clone, Copy, Debug)]
pub struct PdOnlineGravity<C, const N: usize> {
    /// K_P and K_D, the feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
}

/// The law with any feedback of the motors.
#[inline]
pub(super) fn regulate<C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize>(
    motor: &MotorPd<C, N>,
    robot: &Fjr<C, L, N>,
    x: &Motion<T, N>,
    q_ld: &Vector<Jet<T, 5>, N>,
) -> Vector<T, N> {
    let [theta_0, rate_0] = robot.motors_at_rest(&q_ld.map(|x| x.truncate::<2>())).derivatives();
    let gravity = robot.links.gravity_torque(&robot.links_at_rest(&x.q_m));
    motor.feedback(&(x.q_m - theta_0), &(x.v_m - rate_0)) + gravity
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for PdOnlineGravity<C, N> {
    const READS: Signals = Signals::MOTORS;

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        regulate(&self.motor, robot, x, q_ld)
    }
}
