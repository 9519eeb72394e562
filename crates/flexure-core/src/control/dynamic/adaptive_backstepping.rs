//! Command-filtered backstepping that finds out what the links weigh.

use super::adaptation::{Adaptation, joined};
use super::step::{Seen, advanced};
use super::{Applied, CommandFilteredBackstepping, DynamicLaw};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// A reconstruction of the idea of Pan, Wang, Li and Yu, *Adaptive command-filtered backstepping control of robot arms with compliant actuators*,
/// IEEE Trans. Control Systems Technology 26(3), 2018, not their formula: [`CommandFilteredBackstepping`] whose links have parameters φ̂ in place
/// of those of the model.
///
/// φ̂̇ = −Γ Y(q, q̇, α_1 + ξ_2, α̇_1 + ξ̇_2)ᵀ v_2, with ξ̇_2 from the mass and Coriolis matrices of φ̂. V of the law with known links plus
/// ½ (φ̂ − φ)ᵀ Γ⁻¹ (φ̂ − φ) decays by the same formula, whatever φ̂ and ω are: v vanishes, and what is left of the error is the lag of the filters. φ̂ need
/// not come to φ. Springs, motors and dampers have to be known. Memory: that of the law with known links, then φ̂.
#[derive(Clone, Copy, Debug)]
pub struct AdaptiveCommandFilteredBackstepping<C, const N: usize> {
    /// The law with known links.
    pub nominal: CommandFilteredBackstepping<C, N>,
    /// How φ̂ moves.
    pub adaptation: Adaptation<C, N>,
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 16> for AdaptiveCommandFilteredBackstepping<C, N> {
    const READS: Signals = Signals::ALL;
    const JOINTWISE: bool = false;

    /// φ̂ starts at the model's φ, the first filter on its input, all else at rest.
    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 16] {
        joined(self.nominal.start(robot, x, q_ld), robot.links.parameters().map(|slot| slot.lift()))
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        [x_3, _, x_4, dx_4, _, xi_3, ..]: &[Vector<T, N>; 16],
    ) -> Vector<T, N> {
        self.nominal.motor_torque(robot, x, [x_3, x_4, dx_4, xi_3])
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [x_3, dx_3, x_4, dx_4, xi_2, xi_3, parameters @ ..]: &[Vector<T, N>; 16],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 16] {
        let (filters, still) = ([*x_3, *dx_3, *x_4, *dx_4, *xi_2, *xi_3], Vector::ZERO);
        let wanted = self.nominal.wanted(x, q_ld);
        let (filters, parameters) =
            self.adaptation.rates(&self.nominal, robot, x, &wanted, (&filters, parameters), [&still, &still]);
        joined(filters, parameters)
    }

    /// φ̂, which is slow, without a Jacobian, and then projected.
    #[inline]
    fn advanced<T: Over<C> + Piecewise, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        seen: [&Seen<T, N>; 2],
        z: &[Vector<T, N>; 16],
        applied: &Applied<T, N>,
        period: T,
    ) -> [Vector<T, N>; 16] {
        let [_, now] = seen;
        let mut next = advanced::<6, _, _, _, _, N, 16>(self, robot, seen, z, applied, period);
        let [_, _, _, _, _, _, parameters @ ..] = &mut next;
        *parameters = self.adaptation.projected(&robot.links, &now.x.q_l, parameters);
        next
    }
}
