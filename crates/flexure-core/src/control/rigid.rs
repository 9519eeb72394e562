//! The v-CBC law for a fully actuated rigid robot.

use super::{ControlLaw, LinkGains, LinkTorque, Shaping, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// The law of a robot whose links are driven directly. Paper, lemma fullstatecontroller-rigid.
#[derive(Clone, Copy, Debug)]
pub struct RigidVcbc<C, P, const N: usize> {
    /// Metric, shaping function and damping of the links.
    pub link: LinkGains<C, P, N>,
}

impl<C: Scalar, P: Shaping<C, N>, const N: usize> RigidVcbc<C, P, N> {
    /// The joint torque u_l with its errors, at positions `q` in rad and velocities `v` [rad/s]. `link_damping` is
    /// the diagonal of D_l; `q_d` the reference to order 2; `omega` an external torque [N m] that is added.
    #[inline]
    pub fn command<T: Over<C>, L: Links<C, N>>(
        &self,
        links: &L,
        link_damping: &Vector<C, N>,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        q_d: &Vector<Jet<T, 3>, N>,
        omega: &Vector<T, N>,
    ) -> LinkTorque<T, N, 1> {
        let motion = Vector::from_fn(|i| Jet::new([q[i], v[i]]));
        let mut law = self.link.torque(link_damping, &motion, q_d, |v_r, a_r| {
            let value = |x: &Vector<Jet<T, 1>, N>| x.map(|jet| jet.coefficient(0));
            links.inverse_dynamics(q, v, &value(v_r), &value(a_r)).map(Jet::value)
        });
        law.torque += omega.map(Jet::value);
        law
    }
}

/// Applied to the motors as if the springs were rigid: positions and velocities are those of the motors, whose inertia and
/// damping add to the links'. The baseline that shows what flexibility costs.
impl<C: Scalar, P: Shaping<C, N>, const N: usize> ControlLaw<C, N> for RigidVcbc<C, P, N> {
    const READS: Signals = Signals::MOTORS;

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let damping = robot.link_damping + robot.motor_damping;
        let motion = Vector::from_fn(|i| Jet::new([x.q_m[i], x.v_m[i]]));
        let q_d = q_ld.map(|x| x.truncate::<3>());
        let law = self.link.torque::<T, 1, 2, 3>(&damping, &motion, &q_d, |v_r, a_r| {
            let ([v_r], [a_r]) = (v_r.derivatives(), a_r.derivatives());
            let torque = robot.links.inverse_dynamics(&x.q_m, &x.v_m, &v_r, &a_r);
            (torque + robot.motor_inertia.diag_mul(&a_r)).map(Jet::value)
        });
        law.torque.map(|u| u.coefficient(0))
    }
}
