//! Regulation from motor encoders with an observer.

use super::motor_position_pd::motor_error;
use super::{Applied, DynamicLaw};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the idea of Ailon and Ortega, *An observer-based set-point controller for robot manipulators with flexible joints*, Systems &
/// Control Letters 21, 1993, not their formula: only motor positions are measured, an observer of order 2n takes the place of velocities.
///
/// u = g(q_0) − K_P e_m − y, where y = K_c (e_m − x_c) is the spring to a copy of the motor that the controller computes, ẋ_c = v_c,
/// B_c v̇_c = y − D_c v_c, and e_m = θ − θ_0, θ_0 = q_0 + K⁻¹ g(q_0).
///
/// Regulation: globally asymptotically stable under Tomei's condition on K_P; energy, that of the copy included, goes into dampers only. As B_c → 0 it is
/// [`MotorPositionPd`](super::MotorPositionPd) with K_D a = K_c and a = K_c/D_c. Memory: x_c, v_c.
#[derive(Clone, Copy, Debug)]
pub struct MotorObserverPd<C, const N: usize> {
    /// The diagonal of K_P [N m/rad].
    pub stiffness: Vector<C, N>,
    /// Inertia of the copy, the diagonal of B_c [kg m²].
    pub inertia: Vector<C, N>,
    /// Damping of the copy, the diagonal of D_c [N m s/rad].
    pub damping: Vector<C, N>,
    /// Stiffness of the spring to it, the diagonal of K_c [N m/rad].
    pub coupling: Vector<C, N>,
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 2> for MotorObserverPd<C, N> {
    const READS: Signals = Signals::MOTOR_POSITIONS;
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 2] {
        [motor_error(robot, &x.q_m, q_ld).1, Vector::ZERO]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [x_c, _]: &[Vector<T, N>; 2],
    ) -> Vector<T, N> {
        let (gravity, error) = motor_error(robot, &x.q_m, q_ld);
        gravity - self.stiffness.diag_mul(&error) - self.coupling.diag_mul(&(error - *x_c))
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [x_c, v_c]: &[Vector<T, N>; 2],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 2] {
        let error = motor_error(robot, &x.q_m, q_ld).1;
        let torque = self.coupling.diag_mul(&(error - *x_c)) - self.damping.diag_mul(v_c);
        [*v_c, self.inertia.map(C::recip).diag_mul(&torque)]
    }
}
