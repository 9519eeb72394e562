//! Algebraic Riccati equations by doubling.

use crate::linalg::BlockMatrix;
use crate::scalar::Float;

/// Doublings that are enough for any equation with a solution: time constants up to 2⁶⁰ steps.
const DOUBLINGS: u32 = 60;

type Square<S, const N: usize> = BlockMatrix<S, N, 4>;

/// X = Aᵀ X (1 + G X)⁻¹ A + Q with (1 + G X)⁻¹ A stable, for A, G and Q, the last two symmetric: the limit of the structure-preserving doubling algorithm, which goes
/// over 2ᵏ steps after k doublings. Chu, Fan, Lin and Wang, *Structure-preserving algorithms for periodic discrete-time algebraic
/// Riccati equations*, Int. J. Control 77, 2004.
///
/// `None` where it does not converge: there is no such X, or the numbers do not reach so far. Where there is one with G of the game of H∞, what k doublings find
/// is paid over 2ᵏ steps, and never falls: a diagonal entry that loses half says that there is none.
// Not inlined, as below: they hold a dozen matrices each, one after the other.
#[inline(never)]
pub(super) fn discrete<S: Float, const N: usize>([a, g, x]: &mut [Square<S, N>; 3]) -> Option<Square<S, N>> {
    for _ in 0..DOUBLINGS {
        let mut through = [*a, *g];
        let mut met = &*g * &*x;
        met += &BlockMatrix::identity();
        met.solve(&mut through);
        let [by_a, by_g] = &through;
        let back = a.transpose();
        *g += &(&(&*a * by_g) * &back);
        g.symmetrize();
        let mut next = &(&back * &*x) * by_a;
        next += x;
        next.symmetrize();
        *a = &*a * by_a;
        let falls = |(next, x): (S, S)| x > S::ZERO && next + next < x;
        if next.diagonal_entries().zip(x.diagonal_entries()).any(falls) {
            return None;
        }
        // What is added shrinks with the square of a: it rounds to nothing at last.
        if next.diagonal_entries().eq(x.diagonal_entries()) {
            let size = a.rows().flatten().fold(S::ZERO, |sum, x| sum + x.square());
            return (size < S::ONE).then_some(next);
        }
        *x = next;
    }
    None
}

/// X with Aᵀ X + X A − X G X + Q = 0 and A − G X stable, for symmetric G and Q: that of the discrete equation of [`cayley`].
pub(super) fn continuous<S: Float, const N: usize>(
    a: &Square<S, N>,
    g: &Square<S, N>,
    q: &Square<S, N>,
) -> Option<Square<S, N>> {
    discrete(&mut cayley(a, g, q))
}

/// A, G and Q of a discrete equation with the same solution: Cayley's transform, (A − s)⁻¹ (A + s) where there is no feedback. Chu, Fan and Lin,
/// *A structure-preserving doubling algorithm for continuous-time algebraic Riccati equations*, Linear Algebra and its Applications 396, 2005.
///
/// s should be a mean rate of the loop. Entries of A are rates and squares of rates, K/M, so it is √‖A‖. From a hundredth to a hundred times that, the
/// residual is the same but for a factor of ten.
#[inline(never)]
fn cayley<S: Float, const N: usize>(
    a: &Square<S, N>,
    g: &Square<S, N>,
    q: &Square<S, N>,
) -> [Square<S, N>; 3] {
    let shift = a.norm().sqrt();
    let mut shifted = BlockMatrix::identity();
    shifted.scale(-shift);
    shifted += a;
    let mut back = shifted.transpose();
    let mut by_g = [*g];
    shifted.solve(&mut by_g);
    let [by_g] = &by_g;
    // With W = (A − s)ᵀ + Q (A − s)⁻¹ G: 1 + 2s W⁻ᵀ, 2s (A − s)⁻¹ G W⁻¹ and 2s W⁻¹ Q (A − s)⁻¹, the last two symmetric.
    let mut w = q * by_g;
    w += &back;
    let mut by_w = [BlockMatrix::identity(), by_g.transpose()];
    w.transpose().solve(&mut by_w);
    let [mut a, mut g] = by_w;
    let mut by_a = [q * &a];
    back.solve(&mut by_a);
    let [mut x] = by_a;
    for part in [&mut a, &mut g, &mut x] {
        part.scale(shift + shift);
    }
    a += &BlockMatrix::identity();
    g.symmetrize();
    x.symmetrize();
    [a, g, x]
}
