//! The gains and the cost that are optimal for a linearised robot.

use super::{LinearModel, riccati};
use crate::linalg::{BlockMatrix, Matrix, Vector};
use crate::scalar::Float;

/// What a deviation costs per second: Σ q_i x_i² + Σ r_i u_i².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticCost<C, const N: usize> {
    /// Weights of errors of q and θ [1/rad²], v and w [s²/rad²].
    pub state: [Vector<C, N>; 4],
    /// Weights of the torque beyond that of the reference [1/(N m)²], positive.
    pub torque: Vector<C, N>,
}

/// Optimal feedback and what it costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regulator<C, const N: usize> {
    /// F: gains of the errors of q and θ [N m/rad], v and w [N m s/rad].
    pub gain: [Matrix<C, N, N>; 4],
    /// P, symmetric and positive definite: xᵀ P x is what is still to be paid from x on.
    pub cost_to_go: BlockMatrix<C, N, 4>,
    /// R, or R + Bᵀ P B where torques are held: the cost of another torque than −F x, for a moment [1/(N m)²].
    pub torque_cost: Matrix<C, N, N>,
}

/// Why there is no regulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRegulator {
    /// The Riccati equation has no stabilising solution that was found: γ is too small, or weights that are not positive leave a motion unseen.
    Unstable,
    /// The solution is not positive definite: γ is too small.
    Indefinite,
}

impl<C: Float, const N: usize> QuadraticCost<C, N> {
    fn state_matrix(&self) -> BlockMatrix<C, N, 4> {
        BlockMatrix::from_blocks(|row, column| {
            if row == column { Matrix::diagonal(&self.state[row]) } else { Matrix::ZERO }
        })
    }

    /// What a `period` in s costs: the rate times its length.
    fn over(&self, period: C) -> Self {
        Self { state: self.state.map(|weights| weights.scaled(period)), torque: self.torque.scaled(period) }
    }
}

impl<C: Float, const N: usize> Regulator<C, N> {
    /// Of ẋ = A x + B u + G τ: F = R⁻¹ Bᵀ P, where Aᵀ P + P A − P (B R⁻¹ Bᵀ − γ⁻² G Gᵀ) P + Q = 0.
    ///
    /// With γ = ∞ the linear quadratic regulator: Anderson and Moore, *Optimal control: linear quadratic methods*, 1990, section 3.2. A finite
    /// `attenuation` γ [1/(N m)] is H∞: √∫cost never exceeds γ √∫τ² from rest, for torques τ on the links. Doyle, Glover, Khargonekar and Francis,
    /// *State-space solutions to standard H2 and H∞ control problems*, IEEE Trans. Automatic Control 34, 1989.
    pub fn continuous(
        model: &LinearModel<C, N>,
        cost: &QuadraticCost<C, N>,
        attenuation: C,
    ) -> Result<Self, NoRegulator> {
        let (B, G) = (&model.input, &model.disturbance);
        let (by_cost, by_gamma) =
            (Matrix::diagonal(&cost.torque.map(C::recip)), attenuation.square().recip());
        let g = BlockMatrix::from_blocks(|row, column| {
            B[row] * by_cost * B[column].transpose() - (G[row] * G[column].transpose()).scaled(by_gamma)
        });
        let P = riccati::continuous(&model.state, &g, &cost.state_matrix(), C::from_f64(100.0))
            .ok_or(NoRegulator::Unstable)?;
        if !P.is_positive_definite() {
            return Err(NoRegulator::Indefinite);
        }
        let gain = transposed(&(P * *B)).map(|block| by_cost * block);
        Ok(Self { gain, cost_to_go: P, torque_cost: Matrix::diagonal(&cost.torque) })
    }

    /// Of x⁺ = A x + B u over a `period` in s, a model that is [`held`](LinearModel::held) over it: F = (R + Bᵀ P B)⁻¹ Bᵀ P A, where
    /// P = Aᵀ P (1 + B R⁻¹ Bᵀ P)⁻¹ A + Q, and Q and R are the weights times the period.
    pub fn discrete(
        model: &LinearModel<C, N>,
        cost: &QuadraticCost<C, N>,
        period: C,
    ) -> Result<Self, NoRegulator> {
        let (A, B, cost) = (&model.state, &model.input, cost.over(period));
        let by_cost = Matrix::diagonal(&cost.torque.map(C::recip));
        let g = BlockMatrix::from_blocks(|row, column| B[row] * by_cost * B[column].transpose());
        let P = riccati::discrete(*A, g, cost.state_matrix()).ok_or(NoRegulator::Unstable)?;
        let by_P = transposed(&(P * *B));
        let torque_cost =
            by_P.iter().zip(B).fold(Matrix::diagonal(&cost.torque), |sum, (p, b)| sum + *p * *b);
        let factor = torque_cost.ldl();
        let gain = transposed(&(A.transpose() * (P * *B)))
            .map(|block| Matrix::from_fn(|i, j| factor.solve(&block.column(j))[i]));
        Ok(Self { gain, cost_to_go: P, torque_cost })
    }
}

/// A column of blocks as a row of their transposes.
fn transposed<C: Float, const N: usize>(column: &[Matrix<C, N, N>; 4]) -> [Matrix<C, N, N>; 4] {
    column.map(|block| block.transpose())
}
