//! Algebraic Riccati equations by doubling.

use crate::linalg::BlockMatrix;
use crate::scalar::Float;

/// Doublings that are enough for any equation with a solution: time constants up to 2⁶⁰ steps.
const DOUBLINGS: u32 = 60;

type Square<S, const N: usize> = BlockMatrix<S, N, 4>;

/// X = Aᵀ X (1 + G X)⁻¹ A + Q with (1 + G X)⁻¹ A stable, for symmetric G and Q: the limit of the structure-preserving doubling algorithm, which goes
/// over 2ᵏ steps of the horizon after k doublings. Chu, Fan, Lin and Wang, *Structure-preserving algorithms for periodic discrete-time algebraic
/// Riccati equations*, Int. J. Control 77, 2004.
///
/// `None` where it does not converge: there is no such X, or the numbers do not reach so far.
pub(super) fn discrete<S: Float, const N: usize>(
    mut a: Square<S, N>,
    mut g: Square<S, N>,
    mut x: Square<S, N>,
) -> Option<Square<S, N>> {
    let one = BlockMatrix::identity();
    for _ in 0..DOUBLINGS {
        let [by_a, by_g] = (one + g * x).solve([a, g]);
        let next = (x + a.transpose() * x * by_a).symmetric();
        g = (g + a * by_g * a.transpose()).symmetric();
        a = a * by_a;
        // What is added shrinks with the square of a: it rounds to nothing at last.
        if next.diagonal_entries().eq(x.diagonal_entries()) {
            let size = a.rows().flatten().fold(S::ZERO, |sum, x| sum + x.square());
            return (size < S::ONE).then_some(next);
        }
        x = next;
    }
    None
}

/// X with Aᵀ X + X A − X G X + Q = 0 and A − G X stable, for symmetric G and Q: Cayley's transform (A − s)⁻¹ (A + s) makes it a discrete equation with
/// the same solution. Chu, Fan and Lin, *A structure-preserving doubling algorithm for continuous-time algebraic Riccati equations*, Linear Algebra
/// and its Applications 396, 2005.
///
/// s should be a mean rate of the loop. Entries of A are rates and squares of rates, K/M, so it is √‖A‖: the residual is the same from a hundredth to a
/// hundred times that.
pub(super) fn continuous<S: Float, const N: usize>(
    a: &Square<S, N>,
    g: &Square<S, N>,
    q: &Square<S, N>,
) -> Option<Square<S, N>> {
    let one = BlockMatrix::identity();
    let shift = a.norm().sqrt();
    let double = shift + shift;
    let shifted = *a - one.scaled(shift);
    let [by_g] = shifted.solve([*g]);
    // With W = (A − s)ᵀ + Q (A − s)⁻¹ G: 1 + 2s W⁻ᵀ, 2s (A − s)⁻¹ G W⁻¹ and 2s W⁻¹ Q (A − s)⁻¹, the last two symmetric.
    let w = shifted.transpose() + *q * by_g;
    let [inverse, by_w] = w.transpose().solve([one, by_g.transpose()]);
    let [x] = shifted.transpose().solve([*q * inverse]);
    discrete(one + inverse.scaled(double), by_w.scaled(double).symmetric(), x.scaled(double).symmetric())
}
