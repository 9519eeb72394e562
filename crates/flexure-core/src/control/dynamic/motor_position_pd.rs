//! Regulation from motor encoders alone.

use super::dirty_derivative::dirty_derivative;
use super::{Applied, DynamicLaw};
use crate::control::{MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// The published law in this project's notation: u = g(q_0) − K_P e_m − K_D ϑ, e_m = θ − θ_0, θ_0 = q_0 + K⁻¹ g(q_0), where ϑ is e_m through
/// a s/(s + a). Kelly, Ortega, Ailon and Loría, *Global regulation of flexible joint robots using approximate differentiation*, IEEE Trans.
/// Automatic Control 39, 1994; Ortega, Loría, Nicklasson and Sira-Ramírez, *Passivity-based control of Euler–Lagrange systems*, 1998.
///
/// Regulation: globally asymptotically stable under Tomei's condition on K_P ([`Pd::gravity_slope_limit`](crate::control::Pd::gravity_slope_limit)),
/// for any K_D and a, without any damping of the robot. On tracking tasks q_0 is the reference as it passes. Memory: z of the filter.
#[derive(Clone, Copy, Debug)]
pub struct MotorPositionPd<C, const N: usize> {
    /// K_P and K_D, the feedback of motor positions and of their filtered derivative.
    pub motor: MotorPd<C, N>,
    /// a, where differentiating ends [1/s].
    pub cutoff: Vector<C, N>,
}

/// [`MotorPositionPd`] whose feedback saturates smoothly: u = g(q_0) − T_P tanh(K_P e_m/T_P) − T_D tanh(K_D ϑ/T_D), a reconstruction of the idea in
/// the same sources. |u_i| never exceeds |g_i(q_0)| + T_P + T_D.
///
/// Near the goal Tomei's condition is that of [`MotorPositionPd`]; further away what is left of K_P must beat gravity.
#[derive(Clone, Copy, Debug)]
pub struct MotorPositionPdCapped<C, const N: usize> {
    /// K_P and K_D near the goal.
    pub motor: MotorPd<C, N>,
    /// a, where differentiating ends [1/s].
    pub cutoff: Vector<C, N>,
    /// T_P, the most torque against position errors [N m].
    pub stiffness_cap: Vector<C, N>,
    /// T_D, the most torque against their derivative [N m].
    pub damping_cap: Vector<C, N>,
}

/// Gravity g(q_0) [N m] of the goal and e_m = θ − θ_0 in rad.
#[inline]
pub(in crate::control) fn motor_error<C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    q_m: &Vector<T, N>,
    q_ld: &Vector<Jet<T, 5>, N>,
) -> (Vector<T, N>, Vector<T, N>) {
    let q_0 = q_ld.map(|q| q.coefficient(0));
    let gravity = robot.links.gravity_torque(&q_0);
    (gravity, *q_m - q_0 - robot.stiffness.map(C::recip).diag_mul(&gravity))
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 1> for MotorPositionPd<C, N> {
    const READS: Signals = Signals::MOTOR_POSITIONS;
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 1] {
        [motor_error(robot, &x.q_m, q_ld).1]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z]: &[Vector<T, N>; 1],
    ) -> Vector<T, N> {
        let (gravity, error) = motor_error(robot, &x.q_m, q_ld);
        gravity + self.motor.feedback(&error, &dirty_derivative(&self.cutoff, &error, z))
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z]: &[Vector<T, N>; 1],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 1] {
        [dirty_derivative(&self.cutoff, &motor_error(robot, &x.q_m, q_ld).1, z)]
    }
}

impl<C: Scalar, const N: usize> MotorPositionPdCapped<C, N> {
    #[inline]
    fn linear(&self) -> MotorPositionPd<C, N> {
        MotorPositionPd { motor: self.motor, cutoff: self.cutoff }
    }
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 1> for MotorPositionPdCapped<C, N> {
    const READS: Signals = Signals::MOTOR_POSITIONS;
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 1] {
        self.linear().start(robot, x, q_ld)
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z]: &[Vector<T, N>; 1],
    ) -> Vector<T, N> {
        let (gravity, error) = motor_error(robot, &x.q_m, q_ld);
        let rate = dirty_derivative(&self.cutoff, &error, z);
        let capped = |gain: &Vector<C, N>, cap: &Vector<C, N>, y: &Vector<T, N>| {
            Vector::from_fn(|i| y[i].scale(gain[i] / cap[i]).tanh().scale(cap[i]))
        };
        gravity
            - capped(&self.motor.stiffness, &self.stiffness_cap, &error)
            - capped(&self.motor.damping, &self.damping_cap, &rate)
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; 1],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; 1] {
        self.linear().rate(robot, x, q_ld, z, applied)
    }
}
