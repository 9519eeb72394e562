//! Optimal feedback that knows the torque limits.

use super::{LinearModel, NoRegulator, QuadraticCost, Regulator, deviation, feedback};
use crate::control::ControlLaw;
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Float, Jet, Over, Scalar};

/// Sweeps over the torques of the horizon.
const SWEEPS: usize = 30;

/// A reconstruction of the idea ...
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mpc<C, const N: usize, const H: usize> {
    /// Gains of the plan without limits: F (A − B F)ᵏ.
    plan: [[Matrix<C, N, N>; 4]; H],
    /// Transposed.
    response: [Matrix<C, N, N>; H],
    /// Curvature of the cost in each torque of the horizon.
    curvature: [Vector<C, N>; H],
    torque_limit: Vector<C, N>,
}

impl<C: Float, const N: usize, const H: usize> Mpc<C, N, H> {
    /// The law
    pub fn design<L: Links<C, N>>(
        robot: &Fjr<C, L, N>,
        posture: &Vector<C, N>,
        cost: &QuadraticCost<C, N>,
        period: C,
        torque_limit: Vector<C, N>,
    ) -> Result<Self, NoRegulator> {
        let model = LinearModel::at_rest(robot, posture).held(period);
        let Regulator { gain, torque_cost, .. } = Regulator::discrete(&model, cost, period)?;
        let root = torque_cost.ldl().root();
        let mut row = gain;
        let plan = core::array::from_fn(|_| {
            let now = row;
            // F (A − B F)ᵏ⁺¹ = (F (A − B F)ᵏ) A − ((F (A − B F)ᵏ) B) F.
            let kick = product(&row, &model.input);
            let next = model.state.transpose() * row.map(|x| x.transpose());
            row = core::array::from_fn(|c| next[c].transpose() - kick * gain[c]);
            now
        });
        let mut moved = model.input;
        let response: [Matrix<C, N, N>; H] = core::array::from_fn(|k| {
            if k == 0 {
                return root.transpose();
            }
            let now = (root * product(&gain, &moved)).transpose();
            moved = model.state * moved;
            now
        });
        let curvature = core::array::from_fn(|k| {
            Vector::from_fn(|i| {
                response.iter().take(H - k).map(|m| m.row(i)).fold(C::ZERO, |sum, r| sum + r.dot(&r))
            })
        });
        Ok(Self { plan, response, curvature, torque_limit })
    }
}

/// A row of blocks times a column of blocks.
fn product<C: Float, const N: usize>(
    row: &[Matrix<C, N, N>; 4],
    column: &[Matrix<C, N, N>; 4],
) -> Matrix<C, N, N> {
    row.iter().zip(column).fold(Matrix::ZERO, |sum, (x, y)| sum + *x * *y)
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
        let mut torques = self.plan.each_ref().map(|gain| u_d + feedback(gain, &error));
        let mut residual = [Vector::<T, N>::ZERO; H];
        let limit = &self.torque_limit;
        for _ in 0..SWEEPS {
            for (k, (torque, curvature)) in torques.iter_mut().zip(&self.curvature).enumerate() {
                for i in 0..N {
                    let mut slope = T::ZERO;
                    for (residual, response) in residual.iter().skip(k).zip(&self.response) {
                        slope += response.row(i).weigh(residual);
                    }
                    let next = limited(torque[i] - slope.scale(curvature[i].recip()), limit[i]);
                    let change = next - torque[i];
                    torque[i] = next;
                    for (residual, response) in residual.iter_mut().skip(k).zip(&self.response) {
                        *residual += response.row(i).map(|x| change.scale(x));
                    }
                }
            }
        }
        let [first, ..] = torques.as_slice() else { return u_d };
        *first
    }
}

/// x, or the `limit` with its sign: x/√max(1, (x/limit)²) with max(1, y) = ½ (1 + y + √(1 − y)²).
#[inline]
fn limited<C: Scalar, T: Over<C>>(x: T, limit: C) -> T {
    let y = x.scale(limit.recip()).square();
    let larger = (T::ONE + y + (T::ONE - y).square().sqrt()) * T::from_ratio(1, 2);
    x / larger.sqrt()
}
