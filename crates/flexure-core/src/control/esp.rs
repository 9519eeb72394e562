//! Damping injection that preserves the elastic structure.

use super::sliding::motors;
use super::{ControlLaw, LinkGains, MotorPd};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// ESP+ control for linear springs: in the coordinates η = θ − q_d − K⁻¹ n with n = M q̈_d + C q̇_d + D_l q̇_d + g − D_i ė the
/// closed loop is a robot of the same inertias and springs, M ë + (C + D_l + D_i) ė = K (η − e) and
/// B η̈ + (D_m + K_D) η̇ + K_P η + K (η − e) = 0: damping on the links without a change of the elastic structure. Keppler,
/// Lakatos, Ott and Albu-Schäffer, *Elastic structure preserving (ESP) control for compliantly actuated robots*, IEEE Trans.
/// Robotics 34, 2018, with the dampers of the robot.
///
/// V = ½ ėᵀ M ė + ½ η̇ᵀ B η̇ + ½ (η − e)ᵀ K (η − e) + ½ ηᵀ K_P η decays as V̇ = −ėᵀ (D_l + D_i) ė − η̇ᵀ (D_m + K_D) η̇.
#[derive(Clone, Copy, Debug)]
pub struct Esp<C, const N: usize> {
    /// Damping of the links that is injected, the diagonal of D_i [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// K_P and K_D, the feedback of the motors' new coordinates η and of their rates.
    pub motor: MotorPd<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Esp<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let wanted = LinkGains::sliding(Vector::ZERO, self.link_damping).spring_torque(robot, x, q_ld).torque;
        let still = motors(robot, &q_ld.map(|x| x.truncate::<3>()), &wanted);
        let [position, rate, second] = still.derivatives();
        self.motor.feedback(&(x.q_m - position), &(x.v_m - rate))
            + wanted.map(|n| n.coefficient(0))
            + robot.motor_inertia.diag_mul(&second)
            + robot.motor_damping.diag_mul(&rate)
    }
}
