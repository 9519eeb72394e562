//! v-CBC that finds out what the links weigh.

use super::adaptation::{Adaptation, joined};
use super::step::{Seen, advanced};
use super::{Applied, CommandFilteredBackstepping, DynamicLaw};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// A reconstruction of the idea of v-CBC ([`Vcbc`](crate::control::Vcbc)) for links with unknown parameters, not its formula: φ linear, and command filters after
/// Pan, Wang, Li and Yu, *Adaptive command-filtered backstepping control of robot arms with compliant actuators*, IEEE Trans. Control Systems
/// Technology 26(3), 2018, in place of q̇_md and q̈_md, which need the accelerations and jerks that unknown parameters do not give.
///
/// [`AdaptiveCommandFilteredBackstepping`](super::AdaptiveCommandFilteredBackstepping) with the metric Π_l of link errors: −Π_l e in the torque of α_2, −Π_l ξ_1 in that
/// of ξ_2, and ξ̇_1 = −Λ ξ_1 + ξ_2. With v_1 = e − ξ_1 its V has ½ v_1ᵀ Π_l v_1 more and its V̇ −v_1ᵀ Π_l Λ v_1, whatever φ̂ and ω are.
/// Memory: x_3, ẋ_3, x_4, ẋ_4, ξ_1, ξ_2, ξ_3, then φ̂.
#[derive(Clone, Copy, Debug)]
pub struct AdaptiveVcbc<C, const N: usize> {
    /// Λ, K_ld = K_2 and Π_m = W_3, and those of the filters.
    pub backstepping: CommandFilteredBackstepping<C, N>,
    /// Π_l, the metric of link errors [N m/rad].
    pub link_metric: Vector<C, N>,
    /// How φ̂ moves.
    pub adaptation: Adaptation<C, N>,
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 17> for AdaptiveVcbc<C, N> {
    const READS: Signals = Signals::ALL;
    const JOINTWISE: bool = false;

    /// φ̂ starts at the model's φ, the first filter on its input, all else at rest.
    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 17] {
        let Self { backstepping: law, link_metric, .. } = self;
        let [goal, zero, ..] = law.start(robot, x, q_ld);
        let pull = robot.stiffness.map(C::recip).diag_mul(&link_metric.diag_mul(&law.wanted(x, q_ld).e));
        let parameters = robot.links.parameters().map(|slot| slot.lift());
        joined([goal - pull, zero, zero, zero, zero, zero, zero], parameters)
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        [x_3, _, x_4, dx_4, _, _, xi_3, ..]: &[Vector<T, N>; 17],
    ) -> Vector<T, N> {
        self.backstepping.motor_torque(robot, x, [x_3, x_4, dx_4, xi_3])
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [x_3, dx_3, x_4, dx_4, xi_1, xi_2, xi_3, parameters @ ..]: &[Vector<T, N>; 17],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 17] {
        let Self { backstepping: law, link_metric, adaptation } = self;
        let wanted = law.wanted(x, q_ld);
        let pull = [&wanted.e, xi_1].map(|e| link_metric.diag_mul(e));
        let filters = [*x_3, *dx_3, *x_4, *dx_4, *xi_2, *xi_3];
        let ([x_3, dx_3, x_4, dx_4, xi_2_rate, xi_3], parameters) =
            adaptation.rates(law, robot, x, &wanted, (&filters, parameters), pull.each_ref());
        let xi_1 = *xi_2 - law.shaping.diag_mul(xi_1);
        joined([x_3, dx_3, x_4, dx_4, xi_1, xi_2_rate, xi_3], parameters)
    }

    /// φ̂, which is slow, without a Jacobian, and then projected.
    #[inline]
    fn advanced<T: Over<C> + Piecewise, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        seen: [&Seen<T, N>; 2],
        z: &[Vector<T, N>; 17],
        applied: &Applied<T, N>,
        period: T,
    ) -> [Vector<T, N>; 17] {
        let [_, now] = seen;
        let mut next = advanced::<7, _, _, _, _, N, 17>(self, robot, seen, z, applied, period);
        let [_, _, _, _, _, _, _, parameters @ ..] = &mut next;
        *parameters = self.adaptation.projected(&robot.links, &now.x.q_l, parameters);
        next
    }
}
