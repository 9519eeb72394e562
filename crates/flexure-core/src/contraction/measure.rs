//! Matrix measures μ(A) = lim (‖I + h A‖ − 1) / h for h → 0⁺.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Float, Piecewise, Scalar};

/// μ_1(A) = max_j (A_jj + Σ_{i≠j} |A_ij|). Paper, eq. matrixMeasure1.
#[inline]
pub fn measure_1<S: Piecewise, const N: usize>(a: &Matrix<S, N, N>) -> S {
    measure_infinity(&a.transpose())
}

/// μ_∞(A) = max_i (A_ii + Σ_{j≠i} |A_ij|).
#[inline]
pub fn measure_infinity<S: Piecewise, const N: usize>(a: &Matrix<S, N, N>) -> S {
    let mut largest = None;
    for i in 0..N {
        let mut sum = a[(i, i)];
        for j in (0..N).filter(|j| *j != i) {
            sum += a[(i, j)].abs();
        }
        largest = Some(largest.map_or(sum, |most: S| most.max(sum)));
    }
    largest.unwrap_or(S::ZERO)
}

/// μ_2(A), half the largest eigenvalue of A + Aᵀ.
#[inline]
pub fn measure_2<S: Float, const N: usize>(a: &Matrix<S, N, N>) -> S {
    let eigenvalues = symmetric_eigenvalues(&(*a + a.transpose()));
    let largest = eigenvalues.iter().reduce(S::max).unwrap_or(S::ZERO);
    largest * S::from_f64(0.5)
}

/// The pivots of 2 `bound` I − (A + Aᵀ): all positive if and only if μ_2(A) < `bound`. On intervals this proves it for every matrix enclosed.
#[inline]
pub fn measure_2_margins<S: Scalar, const N: usize>(a: &Matrix<S, N, N>, bound: S) -> Vector<S, N> {
    let slack = Matrix::<S, N, N>::identity().scaled(bound + bound) - *a - a.transpose();
    *slack.ldl().pivots()
}

/// Eigenvalues of a symmetric matrix, in no order: Jacobi's rotations, which converge quadratically.
///
/// Golub & Van Loan, *Matrix Computations*, 4th ed., section 8.5.
#[inline]
pub fn symmetric_eigenvalues<S: Float, const N: usize>(a: &Matrix<S, N, N>) -> Vector<S, N> {
    /// More than any matrix of this size needs.
    const SWEEPS: usize = 12;
    let mut a = *a;
    for _ in 0..SWEEPS {
        for p in 0..N {
            for q in p + 1..N {
                rotate(&mut a, p, q);
            }
        }
    }
    Vector::from_fn(|i| a[(i, i)])
}

/// √(a² + b²) of numbers that are not both 0, whose squares may be too large or too small.
#[inline]
fn length<S: Float>(a: S, b: S) -> S {
    let size = a.abs().max(b.abs());
    size * ((a / size).square() + (b / size).square()).sqrt()
}

/// Turns the plane of the axes `p` and `q` so that entry (p, q) vanishes.
#[inline]
fn rotate<S: Float, const N: usize>(a: &mut Matrix<S, N, N>, p: usize, q: usize) {
    let (twice, difference) = (a[(p, q)] + a[(p, q)], a[(q, q)] - a[(p, p)]);
    if twice == S::ZERO {
        return;
    }
    // tan of the smaller of the two angles.
    let root = length(difference, twice);
    let tan = twice / difference.select(difference + root, difference - root);
    let cos = (S::ONE + tan.square()).sqrt().recip();
    let sin = tan * cos;
    for k in 0..N {
        let (x, y) = (a[(k, p)], a[(k, q)]);
        a[(k, p)] = cos * x - sin * y;
        a[(k, q)] = sin * x + cos * y;
    }
    for k in 0..N {
        let (x, y) = (a[(p, k)], a[(q, k)]);
        a[(p, k)] = cos * x - sin * y;
        a[(q, k)] = sin * x + cos * y;
    }
}
