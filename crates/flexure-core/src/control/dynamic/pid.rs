//! The baseline without a model.

use super::{Applied, DynamicLaw};
use crate::control::{MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// What every drive has: u = −K_P (θ − q_d) − K_D (θ̇ − q̇_d) − K_I z, ż = q − q_d, the error of the links integrated. No model, no gravity. Local: with rigid
/// joints K_I < K_D K_P/J, joint by joint.
///
/// What limits withhold of the torque takes the integral back: ż = q − q_d + K_P⁻¹ (asked − given). Memory: z.
#[derive(Clone, Copy, Debug)]
pub struct Pid<C, const N: usize> {
    /// K_P and K_D, feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
    /// K_I, feedback of the integral of link errors [N m/(rad s)].
    pub integral: Vector<C, N>,
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 1> for Pid<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: true, v_l: false, v_m: true };
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        _: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 1] {
        [Vector::ZERO]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z]: &[Vector<T, N>; 1],
    ) -> Vector<T, N> {
        let [q_d, v_d, ..] = q_ld.derivatives();
        self.motor.feedback(&(x.q_m - q_d), &(x.v_m - v_d)) - self.integral.diag_mul(z)
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        _: &[Vector<T, N>; 1],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; 1] {
        let error = x.q_l - q_ld.map(|q| q.coefficient(0));
        [error + self.motor.stiffness.map(C::recip).diag_mul(&applied.withheld())]
    }
}
