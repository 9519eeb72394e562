//! A law for rigid robots with damping of the springs.

use super::{ControlLaw, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = u_0 − K_f (θ̇ − q̇) with computed torque u_0 = (M + B) (q̈_d − k_v ė − k_p e) + C q̇ + g + (D_l + D_m) q̇ for links and motors
/// as one rigid robot: the composite law of two time scales. Spong, *Modeling and control of elastic joint robots*, ASME J.
/// Dynamic Systems, Measurement and Control 109, 1987; [`IntegralManifold`](super::IntegralManifold) corrects what it leaves:
/// an error in proportion to the compliance K⁻¹.
#[derive(Clone, Copy, Debug)]
pub struct SingularPerturbation<C, const N: usize> {
    /// k_p, feedback of the link position error e [1/s²].
    pub position: Vector<C, N>,
    /// k_v, feedback of its rate [1/s].
    pub velocity: Vector<C, N>,
    /// K_f, on the rate of the deflection [N m s/rad].
    pub damping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for SingularPerturbation<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: false, v_l: true, v_m: true };

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let [q_d, v_d, a_d] = q_ld.map(|x| x.truncate::<3>()).derivatives();
        let a = a_d - self.position.diag_mul(&(x.q_l - q_d)) - self.velocity.diag_mul(&(x.v_l - v_d));
        robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &a)
            + robot.motor_inertia.diag_mul(&a)
            + (robot.link_damping + robot.motor_damping).diag_mul(&x.v_l)
            - self.damping.diag_mul(&(x.v_m - x.v_l))
    }
}
