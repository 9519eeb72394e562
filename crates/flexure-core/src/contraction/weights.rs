//! The diagonal weight that is best for μ_1 or μ_∞.

use crate::linalg::{Matrix, Vector};
use crate::scalar::Piecewise;

/// The diagonal of the Θ with the least μ_1(Θ A Θ⁻¹) of all diagonal ones, the largest entry 1; for μ_∞ take the reciprocals of that of Aᵀ.
///
/// It is the left Perron vector of the matrix with the entries A_ii and |A_ij|, whose Perron root the least measure is: there is a diagonal Θ
/// with a negative measure if and only if that matrix is Hurwitz. Entries are positive where the matrix is irreducible.
///
/// This is the theorem of Perron and Frobenius: w A ≤ μ w for a positive row w and the least μ.
#[inline]
pub fn diagonal_weight<S: Piecewise, const N: usize>(a: &Matrix<S, N, N>) -> Vector<S, N> {
    /// The power 2^40: what is left of other eigenvectors is rounding, unless two agree to 11 digits.
    const SQUARINGS: usize = 40;
    let largest = |x: &[S]| x.iter().fold(S::ZERO, |most, x| most.max(x.abs()));
    // Shifted, so that no entry is negative and the Perron root is the eigenvalue of largest size.
    let shift = largest(a.0.as_flattened());
    let mut power = Matrix::from_fn(|i, j| if i == j { a[(i, i)] + shift } else { a[(i, j)].abs() });
    for _ in 0..SQUARINGS {
        power = power.scaled(largest(power.0.as_flattened()).recip());
        power = power * power;
    }
    // Every row is a multiple of the vector that is sought.
    let sum = power.0.iter().fold(Vector::ZERO, |sum, row| sum + Vector(*row));
    sum.scaled(largest(&sum.0).recip())
}
