//! Composite control on an integral manifold.

use super::{ControlLaw, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = u_0 + μ u_1 + u_f with μ = K⁻¹: computed torque u_0 for links and motors as one rigid robot, the correction u_1 that
/// makes the slow manifold of the flexible robot that of the rigid one, and damping u_f of the springs about it.
/// Spong, Khorasani and Kokotović, *An integral manifold approach to the feedback control of flexible joint robots*, IEEE J.
/// Robotics and Automation 3, 1987; Spong 1987, section 5.
///
/// On the manifold links obey ë + k_v ė + k_p e = 0 for every stiffness. With the accelerations that this makes of a link
/// position and velocity, u_0 + μ u_1 is the inverse dynamics of the flexible robot: they are not computed apart. Off the
/// manifold, where motors are not at its θ_h, u_f = −K_f (θ̇ − θ̇_h) damps the springs; μ must be small for the loop to be
/// stable.
#[derive(Clone, Copy, Debug)]
pub struct IntegralManifold<C, const N: usize> {
    /// k_p, feedback of the link position error e [1/s²].
    pub position: Vector<C, N>,
    /// k_v, feedback of its rate [1/s].
    pub velocity: Vector<C, N>,
    /// K_f, on the rate of the motors off the manifold [N m s/rad].
    pub damping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> IntegralManifold<C, N> {
    /// The links' motion on the manifold from position and velocity, to order 4.
    #[inline]
    fn slow_motion<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<Jet<T, 5>, N> {
        let [q_d, v_d, a_d, jerk_d, snap_d] = q_ld.derivatives();
        let next = |e: &Vector<T, N>, rate: &Vector<T, N>| {
            -(self.position.diag_mul(e) + self.velocity.diag_mul(rate))
        };
        let (e, de) = (*q - q_d, *v - v_d);
        let dde = next(&e, &de);
        let d3e = next(&de, &dde);
        let d4e = next(&dde, &d3e);
        Vector::from_derivatives(&[*q, *v, a_d + dde, jerk_d + d3e, snap_d + d4e])
    }
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for IntegralManifold<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: false, v_l: true, v_m: true };

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let slow = robot.inverse_dynamics::<_, 1, 3, 5>(&self.slow_motion(&x.q_l, &x.v_l, q_ld));
        let ([_, rate, _], [u]) = (slow.q_m.derivatives(), slow.u_m.derivatives());
        u - self.damping.diag_mul(&(x.v_m - rate))
    }
}
