//! Impedance of the links, by energy that only motors see.

use super::{ControlLaw, MotorPd, Signals};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Dual, Jet, Over, Scalar};

/// A reconstruction of the joint-space form of Ott, Albu-Schäffer, Kugi and Hirzinger, *On the passivity-based impedance control of flexible joint robots*,
/// IEEE Trans. Robotics 24, 2008, with the exact gradient factor: links that rest are springs K_des to the goal.
///
/// With q̄(θ), where the links rest ([`Fjr::links_at_rest`]), G = 1 + K⁻¹ ∂g(q̄) and K_i = (K_des⁻¹ − K⁻¹)⁻¹: u′ = g(q̄) − G⁻ᵀ K_i (q̄ − q_0) − D_θ θ̇ and
/// u = K ζ + B B_θ⁻¹ (u′ − K ζ). The energy of the motors with the inertia B_θ, the springs and ½ (q̄ − q_0)ᵀK_i(q̄ − q_0) only goes into dampers.
///
/// Regulation, where the springs are stiffer than gravity, for K_des below K. A torque τ on links without gravity moves them by K_des⁻¹ τ. On tracking tasks q_0
/// is the reference as it passes.
#[derive(Clone, Copy, Debug)]
pub struct LinkImpedance<C, const N: usize> {
    /// Motor inertias that the robot shall seem to have, the diagonal of B_θ [kg m²].
    pub inertia: Vector<C, N>,
    /// K_i, [in series](in_series) with the springs K_des, and D_θ.
    pub motor: MotorPd<C, N>,
}

/// K_i = (K_des⁻¹ − K⁻¹)⁻¹ [N m/rad]: what is K_des = `wanted` in series with a spring of `stiffness`, which must be more.
#[inline]
pub fn in_series<C: Scalar>(stiffness: C, wanted: C) -> C {
    stiffness * wanted / (stiffness - wanted)
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for LinkImpedance<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: true, v_l: false, v_m: true };

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let q = robot.links_at_rest(&x.q_m);
        // Value and slope of gravity; G = K⁻¹ (K + ∂g), and ∂g is symmetric.
        let seeded: Vector<Dual<T, N>, N> = Vector::from_fn(|i| Dual::variable(q[i], i));
        let gravity = robot.links.gravity_torque(&seeded);
        let slope = Matrix(gravity.map(|g| g.gradient).0) + Matrix::diagonal(&robot.stiffness.lift());
        let pull = self.motor.stiffness.diag_mul(&(q - q_ld.map(|q| q.coefficient(0))));
        let pull = robot.stiffness.diag_mul(&slope.ldl().solve(&pull));
        let shaped = gravity.map(|g| g.value) - pull - self.motor.damping.diag_mul(&x.v_m);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        let ratio = Vector::from_fn(|i| robot.motor_inertia[i] / self.inertia[i]);
        spring + ratio.diag_mul(&(shaped - spring))
    }
}
