//! The gains that are optimal for a linearised robot.

use super::{LinearModel, riccati};
use crate::linalg::{BlockMatrix, Matrix, Vector};
use crate::scalar::Float;

/// What a deviation costs per second: Σ Q_i x_i² + Σ R_i u_i².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticCost<C, const N: usize> {
    /// The diagonal of Q: weights of the errors of q and θ [1/rad²/s], of v and w [s/rad²].
    pub state: [Vector<C, N>; 4],
    /// The diagonal of R: weights of torques beyond those of the reference [1/(N m)²/s], positive.
    pub torque: Vector<C, N>,
}

/// Optimal feedback u = −F x and what it costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regulator<C, const N: usize> {
    /// F: gains of the errors of q and θ [N m/rad], of v and w [N m s/rad].
    pub gain: [Matrix<C, N, N>; 4],
    /// P, symmetric and positive definite: xᵀ P x is what is to be paid from x on.
    pub cost_to_go: BlockMatrix<C, N, 4>,
}

/// Why there is no regulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRegulator {
    /// No stabilising solution of the Riccati equation was found: weights that are not positive leave a motion unseen, γ is too small, or the robot's
    /// numbers are too far apart.
    Unstable,
    /// The solution is not positive definite: γ is too small.
    Indefinite,
}

impl<C: Float, const N: usize> QuadraticCost<C, N> {
    /// What a `period` in s costs during which nothing changes.
    #[must_use]
    pub fn over(&self, period: C) -> Self {
        Self { state: self.state.map(|weights| weights.scaled(period)), torque: self.torque.scaled(period) }
    }
}

impl<C: Float, const N: usize> Regulator<C, N> {
    /// Of ẋ = A x + B u + G τ: F = R⁻¹ Bᵀ P, where Aᵀ P + P A − P (B R⁻¹ Bᵀ − G γ⁻² Gᵀ) P + Q = 0.
    ///
    /// With γ = ∞ the linear quadratic regulator, Anderson and Moore, *Optimal control: linear quadratic methods*, 1990, section 3.2. Finite
    /// `attenuation`s γ, the diagonal of γ [1/(N m √s)], make it H∞: from rest, ∫cost dt ≤ ∫|γ τ|² dt under any torques τ on the links. Doyle, Glover,
    /// Khargonekar and Francis, *State-space solutions to standard H₂ and H∞ control problems*, IEEE Trans. Automatic Control 34, 1989.
    ///
    /// # Errors
    /// Without a stabilising, positive definite solution.
    pub fn continuous(
        model: &LinearModel<C, N>,
        cost: &QuadraticCost<C, N>,
        attenuation: &Vector<C, N>,
    ) -> Result<Self, NoRegulator> {
        let LinearModel { state: A, input: B, disturbance: G } = model;
        let (by_R, by_gamma) = (cost.torque.map(C::recip), attenuation.map(|gamma| gamma.square().recip()));
        let mut g = squares(B, &by_R);
        g -= &squares(G, &by_gamma);
        let P = positive(riccati::continuous(A, &g, &BlockMatrix::diagonal(&cost.state)))?;
        let gain = (&P * B).map(|block| Matrix::diagonal(&by_R) * block.transpose());
        Ok(Self { gain, cost_to_go: P })
    }

    /// The least γ for which [`continuous`](Self::continuous) has a solution with the attenuations γ · `weights`, to a hundredth above it.
    ///
    /// # Errors
    /// Without a solution for γ = ∞.
    pub fn least_attenuation(
        model: &LinearModel<C, N>,
        cost: &QuadraticCost<C, N>,
        weights: &Vector<C, N>,
    ) -> Result<C, NoRegulator> {
        let keeps = |gamma: C| Self::continuous(model, cost, &weights.scaled(gamma)).is_ok();
        Self::continuous(model, cost, &Vector([C::INFINITY; N]))?;
        // Brackets one way or the other, as far as numbers go; eight halvings of their factor leave a hundredth.
        let factor = C::from_f64(16.0);
        let (mut refused, mut kept) = (C::ONE, C::ONE);
        while keeps(refused) && refused > C::ZERO {
            (refused, kept) = (refused / factor, refused);
        }
        while !keeps(kept) && kept.is_finite() {
            (refused, kept) = (kept, kept * factor);
        }
        for _ in 0..8 {
            let middle = (refused * kept).sqrt();
            if keeps(middle) { kept = middle } else { refused = middle }
        }
        Ok(kept)
    }

    /// Of x⁺ = A x + B u, the robot [`held`](LinearModel::held) over a period: F = (R + Bᵀ P B)⁻¹ Bᵀ P A, where P = Aᵀ P (1 + B R⁻¹ Bᵀ P)⁻¹ A + Q, with
    /// the `cost` of a period ([`QuadraticCost::over`]).
    ///
    /// # Errors
    /// Without a stabilising solution.
    pub fn discrete(model: &LinearModel<C, N>, cost: &QuadraticCost<C, N>) -> Result<Self, NoRegulator> {
        let LinearModel { state: A, input: B, .. } = model;
        let g = squares(B, &cost.torque.map(C::recip));
        let P = positive(riccati::discrete(&mut [*A, g, BlockMatrix::diagonal(&cost.state)]))?;
        let factor = torque_cost(model, cost, &P).ldl();
        // Columns of F, or rows of Aᵀ P B, through the factor.
        let gain = (&A.transpose() * &(&P * B))
            .map(|block| Matrix(block.0.map(|row| factor.solve(&Vector(row)).0)).transpose());
        Ok(Self { gain, cost_to_go: P })
    }
}

/// R + Bᵀ P B: what it costs, a period's cost and what is to be paid later, to leave u = −F x for a period [1/(N m)²].
pub(super) fn torque_cost<C: Float, const N: usize>(
    model: &LinearModel<C, N>,
    cost: &QuadraticCost<C, N>,
    P: &BlockMatrix<C, N, 4>,
) -> Matrix<C, N, N> {
    let pairs = model.input.iter().zip(P * &model.input);
    pairs.fold(Matrix::diagonal(&cost.torque), |sum, (b, p)| sum + b.transpose() * p)
}

/// B diag(`weights`) Bᵀ.
#[inline(never)]
fn squares<C: Float, const N: usize>(
    B: &[Matrix<C, N, N>; 4],
    weights: &Vector<C, N>,
) -> BlockMatrix<C, N, 4> {
    let weights = Matrix::diagonal(weights);
    BlockMatrix::outer(&B.map(|block| block * weights), &B.map(|block| block.transpose()))
}

fn positive<C: Float, const N: usize>(
    P: Option<BlockMatrix<C, N, 4>>,
) -> Result<BlockMatrix<C, N, 4>, NoRegulator> {
    let P = P.ok_or(NoRegulator::Unstable)?;
    if P.is_positive_definite() { Ok(P) } else { Err(NoRegulator::Indefinite) }
}
