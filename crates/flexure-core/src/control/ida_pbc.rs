//! Interconnection and damping assignment.

use super::dynamic::motor_error;
use super::{ControlLaw, MotorPd};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of interconnection and damping assignment as Zhang, Cheah, Collins and others use it for flexible joints; the matching is exact, the choice of
/// the desired energy is this project's: motors of inertia B_θ at springs K_P to θ_0, and damping D_θ and R, the latter between motors and links.
///
/// u = K ζ + D_m θ̇ − k (K ζ + K_P e_m − g(q_0)) − 2 R q̇ − k D_θ θ̇, k = B B_θ⁻¹, e_m = θ − θ_0, θ_0 = q_0 + K⁻¹ g(q_0), makes
/// H_d = ½ q̇ᵀMq̇ + ½ θ̇ᵀB_θθ̇ + ½ ζᵀKζ + P(q) + ½ e_mᵀK_Pe_m − θᵀg(q_0) fall as Ḣ_d = −q̇ᵀD_lq̇ − 2 q̇ᵀR k⁻¹θ̇ − θ̇ᵀD_θθ̇.
///
/// Regulation: stable under Tomei's condition on K_P ([`Pd::gravity_slope_limit`](super::Pd::gravity_slope_limit)) and where the dampers dissipate,
/// [`damping_margin`](Self::damping_margin) ≥ 0. On tracking tasks q_0 is the reference as it passes.
#[derive(Clone, Copy, Debug)]
pub struct IdaPbc<C, const N: usize> {
    /// Motor inertias that the robot shall seem to have, the diagonal of B_θ [kg m²].
    pub inertia: Vector<C, N>,
    /// K_P and D_θ.
    pub motor: MotorPd<C, N>,
    /// R, link velocity fed to the motors [N m s/rad].
    pub cross: Vector<C, N>,
}

impl<C: Scalar, const N: usize> IdaPbc<C, N> {
    /// D_l D_θ − (R k⁻¹)², joint by joint [(N m s/rad)²]: not below 0 where no motion feeds the desired energy.
    #[inline]
    pub fn damping_margin<L>(&self, robot: &Fjr<C, L, N>) -> Vector<C, N> {
        Vector::from_fn(|i| {
            let cross = self.cross[i] * self.inertia[i] / robot.motor_inertia[i];
            robot.link_damping[i] * self.motor.damping[i] - cross.square()
        })
    }
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for IdaPbc<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let (gravity, error) = motor_error(robot, &x.q_m, q_ld);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        let ratio = Vector::from_fn(|i| robot.motor_inertia[i] / self.inertia[i]);
        let shaped = gravity - spring + self.motor.feedback(&error, &x.v_m);
        let cross = self.cross.diag_mul(&x.v_l);
        spring + robot.motor_damping.diag_mul(&x.v_m) + ratio.diag_mul(&shaped) - cross - cross
    }
}
