//! Optimal feedback that knows the torque limits.

use super::{
    LinearModel, NoRegulator, QuadraticCost, Regulator, deviation, feedback, regulator::torque_cost,
};
use crate::array::filled;
use crate::control::ControlLaw;
use crate::linalg::{BlockMatrix, Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Float, Jet, Over, Scalar};

/// Sweeps over the torques of the plan: a number that does not depend on the state, so that neither does the time a torque takes.
const SWEEPS: usize = 30;

/// A reconstruction of the constrained linear quadratic regulator, around the reference: the first of `H` torques that cost least within the limits, for
/// the errors x − x_d of [`Lqr`](super::Lqr). Each torque is held for a step by the robot linearised at a posture; after the last come no limits, at the cost to
/// go P of the discrete regulator. Scokaert and Rawlings, *Constrained linear quadratic regulation*, IEEE Trans. Automatic Control 43, 1998.
///
/// The model is that of the posture throughout, not that of the reference as it passes: A, B, P and F belong together, so that as long as no limit is met the
/// law is the discrete regulator u_d − F (x − x_d), on any reference. Stability is as local as there. u_d is that of now for the whole plan: of the
/// torque along a reference that is known to order 4 no derivative is.
///
/// The torques u_k cost what the regulator costs and Σ |r_k|², where r_k = √(R + Bᵀ P B) (u_k − u_d + F e_k) is how far they leave it. So the best are a least
/// squares solution in a box, found from the plan without limits by projected coordinate descent: each torque in turn goes down its slope, as far as is best
/// for the first, and back to its limit; 30 times round. Of plans of 10 ms this leaves 10⁻¹⁰ of the limit, of 200 ms 5·10⁻⁵.
///
/// A step may be longer than the control period, in each of which torques are planned anew: a limit that lasts is foreseen as far as `H` steps reach. The swing
/// in the test `mpc::limits_that_are_known_cost_less` costs 183 with `Lqr` and saturation, 109 with 20 steps of 1 ms, and 88 with 20 of 10 ms.
///
/// Where a torque meets its limit the law has a kink: a derivative exactly there is not a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mpc<C, const N: usize, const H: usize> {
    /// Gains of the torques of step k without limits, F (A − B F)ᵏ.
    pub plan: [[Matrix<C, N, N>; 4]; H],
    /// What a torque does to r after k steps, √(R + Bᵀ P B) (1, F B, F A B, …), a row for each motor.
    pub leaving: [Matrix<C, N, N>; H],
    /// How far the torque of each motor goes per slope: the reciprocal of what Σ |r|² grows by with the square of the first.
    pub reach: Vector<C, N>,
    /// The most torque of each motor [N m]; infinity for none.
    pub limit: Vector<C, N>,
}

impl<C: Float, const N: usize, const H: usize> Mpc<C, N, H> {
    /// The law for a robot linearised at rest with links at `posture` in rad, with torques up to `limit` [N m], positive, and steps of `step` in s.
    ///
    /// # Errors
    /// Without a stabilising solution of the Riccati equation.
    pub fn design<L: Links<C, N>>(
        robot: &Fjr<C, L, N>,
        posture: &Vector<C, N>,
        cost: &QuadraticCost<C, N>,
        step: C,
        limit: &Vector<C, N>,
    ) -> Result<Self, NoRegulator> {
        let (model, cost) = (LinearModel::at_rest(robot, posture).held(step), cost.over(step));
        let Regulator { gain: F, cost_to_go: P } = Regulator::discrete(&model, &cost)?;
        let LinearModel { state: A, input: B, .. } = model;
        let root = torque_cost(&model, &cost, &P).ldl().root();
        let mut closed = A;
        closed -= &BlockMatrix::outer(&B, &F);
        let back = closed.transpose();
        let (mut ahead, mut moved) = (F.map(|block| block.transpose()), B);
        let plan = filled(|_| {
            let gain = ahead.map(|block| block.transpose());
            ahead = &back * &ahead;
            gain
        });
        let leaving = filled(|k| {
            let mut felt = Matrix::identity();
            if k > 0 {
                felt = F.iter().zip(moved).fold(Matrix::ZERO, |sum, (f, x)| sum + *f * x);
                moved = &A * &moved;
            }
            (root * felt).transpose()
        });
        let curvature = |i| leaving.iter().fold(C::ZERO, |sum, block| sum + block.row(i).dot(&block.row(i)));
        let reach = Vector::from_fn(|i| curvature(i).recip());
        Ok(Self { plan, leaving, reach, limit: *limit })
    }
}

impl<C: Copy, const N: usize, const H: usize> Mpc<C, N, H> {
    /// The law with constants of another type, each through `f`.
    #[inline]
    pub fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> Mpc<D, N, H> {
        Mpc {
            plan: self.plan.map(|gain| gain.map(|block| block.map(&f))),
            leaving: self.leaving.map(|block| block.map(&f)),
            reach: self.reach.map(&f),
            limit: self.limit.map(&f),
        }
    }
}

impl<C: Scalar, const N: usize, const H: usize> ControlLaw<C, N> for Mpc<C, N, H> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let (error, u_d) = deviation(robot, x, q_ld);
        let mut plan = self.plan.each_ref().map(|gain| u_d + feedback(gain, &error));
        let mut left = [Vector::<T, N>::ZERO; H];
        for _ in 0..SWEEPS {
            for (k, torque) in plan.iter_mut().enumerate() {
                for i in 0..N {
                    let mut slopes = Vector::ZERO;
                    for (left, leaving) in left.iter().skip(k).zip(&self.leaving) {
                        slopes += leaving.row(i).diag_mul(left);
                    }
                    let slope = slopes.iter().fold(T::ZERO, |sum, x| sum + x);
                    let best = limited(torque[i] - slope.scale(self.reach[i]), self.limit[i]);
                    let change = best - torque[i];
                    for (left, leaving) in left.iter_mut().skip(k).zip(&self.leaving) {
                        *left += leaving.row(i).map(|x| change.scale(x));
                    }
                    torque[i] = best;
                }
            }
        }
        plan.first().copied().unwrap_or(u_d)
    }
}

/// The number nearest to `x` in ±`limit`, to two units in the last place: x/√max(1, y) of y = (x/limit)², with max(1, y) = ½ (1 + y + √((1 − y)²)) in
/// operations that every number has.
#[inline]
fn limited<C: Scalar, T: Over<C>>(x: T, limit: C) -> T {
    let y = x.scale(limit.recip()).square();
    let larger = (T::ONE + y + (T::ONE - y).square().sqrt()).scale(C::from_ratio(1, 2));
    x / larger.sqrt()
}
