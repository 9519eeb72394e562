//! The cascade that series-elastic drives run.

use super::{Applied, DynamicLaw};
use crate::control::{MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// Velocity-sourced torque control, the published structure: links ask for a spring torque, its error asks for a motor velocity, whose error asks for a motor torque.
/// Vallery, Veneman, van Asseldonk, Ekkelenkamp, Buss and van der Kooij, *Compliant actuation of rehabilitation robots*, IEEE Robotics and Automation
/// Magazine 15, 2008. The outermost loop is this project's: the target of [`ImmersionInvariance`](crate::control::ImmersionInvariance).
///
/// w_s = q̇_d + K_τ ε_τ + K_τi z_τ and u = K ζ + K_w ε_w + K_wi z_w with ż_τ = ε_τ = τ_s − K ζ and ż_w = ε_w = w_s − θ̇. What limits withhold of the torque takes the
/// integrals back, each through the gain beside it. No global proof. Memory: z_τ, z_w.
#[derive(Clone, Copy, Debug)]
pub struct SeaCascade<C, const N: usize> {
    /// Stiffness and damping of the links.
    pub link: MotorPd<C, N>,
    /// K_τ, motor velocity for spring torque [rad/(N m s)].
    pub torque: Vector<C, N>,
    /// K_τi, motor velocity for its integral [rad/(N m s²)].
    pub torque_integral: Vector<C, N>,
    /// K_w, motor torque for motor velocity [N m s/rad].
    pub velocity: Vector<C, N>,
    /// K_wi, motor torque for its integral [N m/rad].
    pub velocity_integral: Vector<C, N>,
}

impl<C: Scalar, const N: usize> SeaCascade<C, N> {
    /// The errors of spring torque [N m] and of motor velocity [rad/s].
    #[inline]
    fn errors<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z_torque: &Vector<T, N>,
    ) -> [Vector<T, N>; 2] {
        let wanted = self.link.link_torque::<_, _, 1, 2>(robot, &x.q_l.with_rate(&x.v_l), q_ld);
        let torque = wanted.map(|u| u.coefficient(0)) - robot.spring_torque(&x.q_l, &x.q_m);
        let velocity = q_ld.map(|q| q.coefficient(1))
            + self.torque.diag_mul(&torque)
            + self.torque_integral.diag_mul(z_torque);
        [torque, velocity - x.v_m]
    }
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 2> for SeaCascade<C, N> {
    const READS: Signals = Signals::ALL;
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        _: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 2] {
        [Vector::ZERO; 2]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z_torque, z_velocity]: &[Vector<T, N>; 2],
    ) -> Vector<T, N> {
        let [_, velocity] = self.errors(robot, x, q_ld, z_torque);
        robot.spring_torque(&x.q_l, &x.q_m)
            + self.velocity.diag_mul(&velocity)
            + self.velocity_integral.diag_mul(z_velocity)
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z_torque, _]: &[Vector<T, N>; 2],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; 2] {
        let [torque, velocity] = self.errors(robot, x, q_ld, z_torque);
        // Errors that would have asked for what was given.
        let excess_velocity = self.velocity.map(C::recip).diag_mul(&applied.withheld());
        let excess_torque = self.torque.map(C::recip).diag_mul(&excess_velocity);
        [torque - excess_torque, velocity - excess_velocity]
    }
}
