//! Links whose parameters a law finds out.

use super::CommandFilteredBackstepping;
use super::command_filtered::{Filters, Reckoned, Virtual};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion, Parameters};
use crate::scalar::{Over, Piecewise, Scalar};

/// How a law adapts its [parameters φ̂ of the links](Links::parameters): φ̂̇ = −Γ Yᵀ v_2, between bounds.
///
/// φ̂ is clamped number by number after each step. As Γ is diagonal, that is the projection onto the bounds in the metric Γ⁻¹ of the laws' storage: if the
/// robot's own φ is between the bounds, the storage does not grow by it. The law divides by the mass matrix of φ̂, and the bounds have to keep it positive
/// definite. It is linear in φ̂, so that it is so everywhere between the bounds if it is at their corners: for the arm in
/// [closed form](crate::robots::PlanarTwoLink) where b² < a1 a2 at the least a1, a2 and the largest |b|.
#[derive(Clone, Copy, Debug)]
pub struct Adaptation<C, const N: usize> {
    /// The diagonal of Γ, in the squared unit of each number per J. Where it is 0, φ̂ stays what the robot's model has.
    pub gain: Parameters<C, N>,
    /// Least φ̂.
    pub low: Parameters<C, N>,
    /// Largest φ̂.
    pub high: Parameters<C, N>,
}

impl<C: Piecewise, const N: usize> Adaptation<C, N> {
    /// Around the parameters φ of `links`: Γ = γ φ² with a `rate` γ [1/J] of each joint, so that the share of φ that φ̂ moves by is the same in
    /// all units, and bounds φ ∓ `range` |φ|. What is 0 in φ is not adapted.
    #[inline]
    pub fn around(links: &impl Links<C, N>, rate: &Vector<C, N>, range: &Vector<C, N>) -> Self {
        let parameters = links.parameters();
        let bound =
            |side: C| parameters.map(|slot| Vector::from_fn(|i| slot[i] + side * range[i] * slot[i].abs()));
        Self {
            gain: parameters.map(|slot| Vector::from_fn(|i| rate[i] * slot[i].square())),
            low: bound(-C::ONE),
            high: bound(C::ONE),
        }
    }
}

impl<C: Scalar, const N: usize> Adaptation<C, N> {
    /// The nearest parameters between the bounds.
    #[inline]
    pub(super) fn bounded<T: Over<C> + Piecewise>(&self, parameters: &Parameters<T, N>) -> Parameters<T, N> {
        core::array::from_fn(|k| {
            Vector::from_fn(|i| {
                parameters[k][i].clamp(T::constant(self.low[k][i]), T::constant(self.high[k][i]))
            })
        })
    }

    /// Rates of the filters of `law` and of φ̂, on links with the parameters φ̂ that the torques `pull` [N m] act on besides, in α_2 and in ξ_2.
    #[inline]
    pub(super) fn rates<T: Over<C>, L: Links<C, N>>(
        &self,
        law: &CommandFilteredBackstepping<C, N>,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        wanted: &Virtual<T, N>,
        (filters, parameters): (&Filters<T, N>, &Parameters<T, N>),
        pull: [&Vector<T, N>; 2],
    ) -> (Filters<T, N>, Parameters<T, N>) {
        let factor = robot.links.mass_matrix_of(parameters, &x.q_l).ldl();
        let links = Reckoned {
            torque: |v_r: &_, a_r: &_| robot.links.regressor_mul(parameters, &x.q_l, &x.v_l, v_r, a_r),
            solve: |torque: &_| factor.solve(torque),
        };
        let rates = law.filter_rates(robot, x, wanted, filters, pull, &links);
        let ([.., xi_2, _], [.., xi_2_rate, _]) = (filters, &rates);
        let (v_r, a_r) = (wanted.velocity + *xi_2, wanted.acceleration + *xi_2_rate);
        let powers = robot.links.regressor_transpose_mul(&x.q_l, &x.v_l, &v_r, &a_r, &(x.v_l - v_r));
        (rates, core::array::from_fn(|k| -self.gain[k].diag_mul(&powers[k])))
    }
}

/// A memory of parts that filters and links have, then φ̂.
#[inline]
pub(super) fn joined<T: Scalar, const N: usize, const I: usize, const K: usize>(
    first: [Vector<T, N>; I],
    parameters: Parameters<T, N>,
) -> [Vector<T, N>; K] {
    let mut parts = first.into_iter().chain(parameters);
    [Vector::ZERO; K].map(|zero| parts.next().unwrap_or(zero))
}
