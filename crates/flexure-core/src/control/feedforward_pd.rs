//! Nominal torque of the reference and PD control of the motors around it.

use super::{ControlLaw, MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = u_d − K_P (θ − θ_d) − K_D (θ̇ − θ̇_d), where u_d and θ_d follow from the reference of the links alone, because the
/// robot is flat: [`Fjr::inverse_dynamics`]. De Luca, *Feedforward/feedback laws for the control of flexible robots*, IEEE
/// Int. Conf. Robotics and Automation, 2000.
///
/// All that depends on the model can be computed beforehand. Stability is local.
#[derive(Clone, Copy, Debug)]
pub struct FeedforwardPd<C, const N: usize> {
    /// K_P and K_D, the feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for FeedforwardPd<C, N> {
    const READS: Signals = Signals::MOTORS;

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let nominal = robot.inverse_dynamics::<_, 1, 3, 5>(q_ld);
        let ([theta_d, rate_d, _], [u_d]) = (nominal.q_m.derivatives(), nominal.u_m.derivatives());
        u_d + self.motor.feedback(&(x.q_m - theta_d), &(x.v_m - rate_d))
    }
}
