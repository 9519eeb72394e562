//! Regulation by the power port of the motors.

use super::motor_position_pd::motor_error;
use super::step::advanced;
use super::{Applied, DynamicLaw, Seen};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// Control by interconnection of Ortega and Borja, *New results on control by interconnection and energy-balancing passivity-based control of
/// port-Hamiltonian systems*, IEEE Conf. Decision and Control, 2014: their method, with a choice of controller that is this project's.
///
/// The controller is a port-Hamiltonian system on the power port (θ̇, u): an integrator without losses and a Maxwell element,
/// H_c = ½ (x_1 − θ_0)ᵀ K_P (x_1 − θ_0) − x_1ᵀ g(q_0) + ½ x_2ᵀ K_2 x_2, ẋ_1 = θ̇, ẋ_2 = θ̇ − R⁻¹ K_2 x_2, u = −∂H_c/∂x_1 − ∂H_c/∂x_2.
///
/// The Casimir x_1 − θ never changes: what it is at the start shifts where the loop rests. Started at 0, as here, the law is
/// [`MotorPositionPd`](super::MotorPositionPd) with K_D a = K_2, a = K_2/R. Regulation, under Tomei's condition. The step of the
/// memory takes increments of motor positions instead of integrals of velocities. Memory: x_1, x_2.
#[derive(Clone, Copy, Debug)]
pub struct ControlByInterconnection<C, const N: usize> {
    /// The diagonal of K_P [N m/rad].
    pub stiffness: Vector<C, N>,
    /// Spring of the Maxwell element, the diagonal of K_2 [N m/rad].
    pub elastic: Vector<C, N>,
    /// Its damper, the diagonal of R [N m s/rad].
    pub viscous: Vector<C, N>,
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 2> for ControlByInterconnection<C, N> {
    // Positions where it starts and in increments.
    const READS: Signals = Signals { q_l: false, q_m: true, v_l: false, v_m: true };
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 2] {
        [x.q_m, Vector::ZERO]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        _: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [x_1, x_2]: &[Vector<T, N>; 2],
    ) -> Vector<T, N> {
        let (gravity, error) = motor_error(robot, x_1, q_ld);
        gravity - self.stiffness.diag_mul(&error) - self.elastic.diag_mul(x_2)
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        [_, x_2]: &[Vector<T, N>; 2],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 2] {
        [x.v_m, x.v_m - Vector::from_fn(|i| x_2[i].scale(self.elastic[i] / self.viscous[i]))]
    }

    /// x_1 by increments of motor positions instead of integrals of velocities, which would drift.
    #[inline]
    fn advanced<T: Over<C> + Piecewise, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        [before, now]: [&Seen<T, N>; 2],
        z: &[Vector<T, N>; 2],
        applied: &Applied<T, N>,
        period: T,
    ) -> [Vector<T, N>; 2] {
        let [_, x_2] = advanced::<2, _, _, _, _, N, 2>(self, robot, [before, now], z, applied, period);
        let [x_1, _] = z;
        [*x_1 + (now.x.q_m - before.x.q_m), x_2]
    }
}
