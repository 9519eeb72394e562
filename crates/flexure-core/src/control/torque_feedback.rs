//! Feedback of the spring torques that shapes the motor inertias.

use super::pd_online_gravity::regulate;
use super::{ControlLaw, MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = B B_θ⁻¹ u′ + (1 − B B_θ⁻¹) τ with τ = K (θ − q): the motors move as if their inertia were B_θ, driven by the
/// regulator u′ = −K_θ (θ − θ_0) − D_θ (θ̇ − θ̇_0) + g(q̄(θ)) of [`PdOnlineGravity`](super::PdOnlineGravity).
/// Albu-Schäffer, Ott and Hirzinger, *A unified passivity-based control framework for position, torque and impedance control
/// of flexible joint robots*, Int. J. Robotics Research 26, 2007.
#[derive(Clone, Copy, Debug)]
pub struct TorqueFeedback<C, const N: usize> {
    /// Motor inertias that the robot shall seem to have, the diagonal of B_θ [kg m²].
    pub inertia: Vector<C, N>,
    /// K_θ and D_θ, the feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for TorqueFeedback<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: true, v_l: false, v_m: true };

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let shaped = regulate(&self.motor, robot, x, q_ld);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        let ratio = Vector::from_fn(|i| robot.motor_inertia[i] / self.inertia[i]);
        spring + ratio.diag_mul(&(shaped - spring))
    }
}
