//! The link part that passivity-based laws share: the sliding variable without a metric.

use super::{Linear, LinkGains, LinkTorque, Metric};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

impl<C: Scalar, const N: usize> LinkGains<C, Linear<C, N>, N> {
    /// q̇_r = q̇_d − λ e and damping γ of s = q̇ − q̇_r, Π = 0; λ [1/s], γ [N m s/rad].
    #[inline]
    pub(super) fn sliding(lambda: Vector<C, N>, gamma: Vector<C, N>) -> Self {
        let metric = Metric::Constant(Vector::ZERO);
        Self { metric, shaping: Linear { gain: lambda }, damping: gamma }
    }

    /// The torque M q̈_r + C q̇_r + D_l q̇_r + g − γ s that the springs shall put on the links, along the motion to order 2,
    /// with accelerations and jerks from the model.
    #[inline]
    pub(super) fn spring_torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> LinkTorque<T, N, 3> {
        let links = &robot.links;
        let motion = robot.link_motion(&links.factor(&x.q_l), x);
        let (q, v) = (motion.map(|x| x.truncate::<3>()), motion.map(|x| x.differentiate::<3>()));
        let rigid = |v_r: &Vector<_, N>, a_r: &Vector<_, N>| links.inverse_dynamics(&q, &v, v_r, a_r);
        self.torque(&robot.link_damping, &motion, q_ld, rigid)
    }
}

/// Motor positions in rad at which the springs of links at `q` in rad give `torque` [N m].
#[inline]
pub(super) fn motors<T: Over<C>, C: Scalar, L, const N: usize>(
    robot: &Fjr<C, L, N>,
    q: &Vector<T, N>,
    torque: &Vector<T, N>,
) -> Vector<T, N> {
    *q + robot.stiffness.map(C::recip).diag_mul(torque)
}
