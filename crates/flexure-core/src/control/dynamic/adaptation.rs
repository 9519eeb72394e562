//! Links whose parameters a law finds out.

use super::CommandFilteredBackstepping;
use super::command_filtered::{Filters, Reckoned, Virtual};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion, Parameters};
use crate::scalar::{Over, Piecewise, Scalar};

/// How a law adapts its [parameters φ̂ of the links](Links::parameters): φ̂̇ = −Γ Yᵀ v_2, projected after each step.
///
/// The projection clamps φ̂ between bounds and then keeps the mass matrix M̂ of φ̂, which the laws divide by, positive definite. It has a half-space for each pivot of
/// M̂ = L D Lᵀ where the robot is: as pivot i is the least yᵀ M̂ y of all y with y_i = 1 and 0 behind i, those φ whose mass matrix has a pivot of at least
/// ε times that of the model have yᵀ M(φ) y no less for y = L⁻ᵀ e_i either, which is linear in φ. All of these sets are convex, and all projections are those in the
/// metric Γ⁻¹ of the laws' storage V: V does not grow by them if the robot's own φ is in these sets. What one projection spoils of another, the next steps mend.
///
/// Bounds alone do not keep M̂ positive definite on trees, whose numbers only make sense together; for the arm in
/// [closed form](crate::robots::PlanarTwoLink) they do where b² < a1 a2 at the least a1, a2 and the largest |b|.
#[derive(Clone, Copy, Debug)]
pub struct Adaptation<C, const N: usize> {
    /// The diagonal of Γ, in the squared unit of each number per J. Where it is 0, φ̂ stays what the robot's model has.
    pub gain: Parameters<C, N>,
    /// Least φ̂.
    pub low: Parameters<C, N>,
    /// Largest φ̂.
    pub high: Parameters<C, N>,
    /// ε, the share of each pivot of the model's mass matrix that is left in any case: positive, below 1.
    pub least: Vector<C, N>,
}

impl<C: Piecewise, const N: usize> Adaptation<C, N> {
    /// Around the parameters φ of `links`: Γ = γ φ² with a `rate` γ [1/J] of each joint, so that the share of φ that φ̂ moves by is the same in
    /// all units, and bounds φ ∓ `range` |φ|. What is 0 in φ is not adapted.
    #[inline]
    pub fn around(
        links: &impl Links<C, N>,
        rate: &Vector<C, N>,
        range: &Vector<C, N>,
        least: &Vector<C, N>,
    ) -> Self {
        let parameters = links.parameters();
        let bound =
            |side: C| parameters.map(|slot| Vector::from_fn(|i| slot[i] + side * range[i] * slot[i].abs()));
        Self {
            gain: parameters.map(|slot| Vector::from_fn(|i| rate[i] * slot[i].square())),
            low: bound(-C::ONE),
            high: bound(C::ONE),
            least: *least,
        }
    }
}

/// `f` of the slots of both.
#[inline]
fn zip<A: Copy, B: Copy, T: Scalar, const N: usize>(
    a: &Parameters<A, N>,
    b: &Parameters<B, N>,
    f: impl Fn(&Vector<A, N>, &Vector<B, N>) -> Vector<T, N>,
) -> Parameters<T, N> {
    let mut slots = a.iter().zip(b);
    [Vector::ZERO; 10].map(|zero| slots.next().map_or(zero, |(a, b)| f(a, b)))
}

/// a·b.
#[inline]
fn dot<T: Scalar, const N: usize>(a: &Parameters<T, N>, b: &Parameters<T, N>) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (a, b)| sum + a.dot(b))
}

impl<C: Scalar, const N: usize> Adaptation<C, N> {
    /// φ̂ projected with `links` at `q` in rad.
    #[inline]
    pub fn projected<T: Over<C> + Piecewise>(
        &self,
        links: &impl Links<C, N>,
        q: &Vector<T, N>,
        parameters: &Parameters<T, N>,
    ) -> Parameters<T, N> {
        let least = zip(parameters, &self.low, |x, low| Vector::from_fn(|i| x[i].max(T::constant(low[i]))));
        let clamped = zip(&least, &self.high, |x, high| Vector::from_fn(|i| x[i].min(T::constant(high[i]))));
        let model = links.mass_matrix(q).ldl();
        let factor = links.mass_matrix_of(&clamped, q).ldl();
        let rest = Vector::ZERO;
        let mut found = clamped;
        for i in 0..N {
            // yᵀ M(φ) y = slope·φ, but for what has no numbers; less what gravity has to do with it.
            let y = factor.pivotal(i);
            let powers = |a: &Vector<T, N>| links.regressor_transpose_mul(q, &rest, &rest, a, &y);
            let slope = zip(&powers(&y), &powers(&rest), |with, without| *with - *without);
            let moved = zip(&found, &clamped, |found, clamped| *found - *clamped);
            let missing = model.pivots()[i].scale(self.least[i]) - factor.pivots()[i] - dot(&slope, &moved);
            let along = zip(&self.gain, &slope, Vector::diag_mul);
            let power = dot(&slope, &along);
            // Where nothing is missing, or nothing adapts, nothing moves.
            let share = (-missing).select(T::ZERO, (-power).select(T::ZERO, missing / power));
            found = zip(&found, &along, |found, along| *found + along.scaled(share));
        }
        found
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
        (rates, zip(&self.gain, &powers, |gain, power| -gain.diag_mul(power)))
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
