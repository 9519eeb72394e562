//! Which structures a shaping function and a metric keep, and why not.

use core::cmp::Ordering;
use core::error::Error;
use core::fmt;

use crate::control::Shaping;
use crate::linalg::{Matrix, Vector};
use crate::scalar::{Float, Over, Piecewise, Scalar};

/// Why the theory does not allow a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal<S> {
    /// Entries (`row`, `column`) and (`column`, `row`) of the matrix differ.
    NotSymmetric {
        /// Which matrix.
        matrix: &'static str,
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// Pivot number `index` of the matrix is not positive.
    NotPositiveDefinite {
        /// Which matrix.
        matrix: &'static str,
        /// Number of the pivot.
        index: usize,
        /// The pivot.
        pivot: S,
    },
    /// ∂φ is not symmetric: Υ is not, and the variation is no variational pH-like system.
    SlopeNotSymmetric {
        /// Largest difference of two entries [1/s].
        difference: S,
    },
    /// ∂φ and Π do not commute, so that ∂φ Π⁻¹ is not symmetric.
    DoesNotCommute {
        /// Largest entry of Π ∂φ − ∂φ Π.
        difference: S,
    },
    /// ∂φ is not Π, so that the closed loop has no error Hamiltonian.
    SlopeIsNotTheMetric {
        /// Largest entry of ∂φ − Π.
        difference: S,
    },
}

impl<S: fmt::Display> fmt::Display for Refusal<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSymmetric { matrix, row, column } => {
                write!(f, "{matrix} is not symmetric: entries ({row}, {column}) and ({column}, {row}) differ")
            }
            Self::NotPositiveDefinite { matrix, index, pivot } => {
                write!(f, "{matrix} is not positive definite: pivot {index} is {pivot}")
            }
            Self::SlopeNotSymmetric { difference } => write!(f, "∂φ is not symmetric, by {difference}"),
            Self::DoesNotCommute { difference } => write!(f, "∂φ and Π do not commute, by {difference}"),
            Self::SlopeIsNotTheMetric { difference } => write!(f, "∂φ is not Π, by {difference}"),
        }
    }
}

impl<S: fmt::Debug + fmt::Display> Error for Refusal<S> {}

/// Refuses a matrix that is not symmetric positive definite; `matrix` is its name.
///
/// # Errors
///
/// [`Refusal::NotSymmetric`], [`Refusal::NotPositiveDefinite`].
pub fn symmetric_positive<S: Float, const N: usize>(
    matrix: &'static str,
    a: &Matrix<S, N, N>,
) -> Result<(), Refusal<S>> {
    let entries = || (0..N).flat_map(|row| (0..row).map(move |column| (row, column)));
    if let Some((row, column)) = entries().find(|(i, j)| a[(*i, *j)] != a[(*j, *i)]) {
        return Err(Refusal::NotSymmetric { matrix, row, column });
    }
    let pivots = *a.ldl().pivots();
    // Also refuses what is not a number.
    match (0..N).find(|i| pivots[*i].partial_cmp(&S::ZERO) != Some(Ordering::Greater)) {
        Some(index) => Err(Refusal::NotPositiveDefinite { matrix, index, pivot: pivots[index] }),
        None => Ok(()),
    }
}

/// Refuses (φ, Π) whose closed loop has no variational pH-like structure at the error: ∂φ has to be symmetric and commute with Π, so that
/// Υ = ∂φ Π⁻¹ is symmetric. Paper, corollary preserving-variational-pH-structure.
///
/// Diagonal ∂φ and Π always do. Entries of ∂φ that differ by `tolerance` [1/s] are equal.
///
/// # Errors
///
/// [`Refusal::SlopeNotSymmetric`], [`Refusal::DoesNotCommute`].
pub fn keeps_variational_structure<C: Scalar, S: Float + Over<C>, const N: usize>(
    shaping: &impl Shaping<C, N>,
    metric: &Matrix<S, N, N>,
    error: &Vector<S, N>,
    tolerance: S,
) -> Result<(), Refusal<S>> {
    let slope = shaping.slope(error);
    let difference = largest(&(slope - slope.transpose()));
    if !is_within(difference, tolerance) {
        return Err(Refusal::SlopeNotSymmetric { difference });
    }
    let difference = largest(&(*metric * slope - slope * *metric));
    if !is_within(difference, tolerance * largest(metric)) {
        return Err(Refusal::DoesNotCommute { difference });
    }
    Ok(())
}

/// Refuses (φ, Π) whose closed loop has no error Hamiltonian: Π = ∂φ is needed. Paper, eq. pH-like-structure-preserving-condition.
///
/// # Errors
///
/// [`Refusal::SlopeIsNotTheMetric`].
pub fn keeps_hamiltonian_structure<C: Scalar, S: Float + Over<C>, const N: usize>(
    shaping: &impl Shaping<C, N>,
    metric: &Matrix<S, N, N>,
    error: &Vector<S, N>,
    tolerance: S,
) -> Result<(), Refusal<S>> {
    let difference = largest(&(shaping.slope(error) - *metric));
    if !is_within(difference, tolerance) {
        return Err(Refusal::SlopeIsNotTheMetric { difference });
    }
    Ok(())
}

/// The largest size of an entry.
fn largest<S: Piecewise, const R: usize, const K: usize>(a: &Matrix<S, R, K>) -> S {
    a.0.as_flattened().iter().fold(S::ZERO, |most, x| most.max(x.abs()))
}

/// Whether `difference` is at most `tolerance`: not where one is not a number.
fn is_within<S: Float>(difference: S, tolerance: S) -> bool {
    matches!(difference.partial_cmp(&tolerance), Some(Ordering::Less | Ordering::Equal))
}

/// (z_2 − z_1)ᵀ [χ(z_2) − χ(z_1)] − β (z_2 − z_1)ᵀ Π (z_2 − z_1) of the map χ = Π φ: not negative for all pairs if and only if the inequality of
/// [`slope_inequality`] holds at every error. Paper, eq. incrementalpassivity-static with β = 0, and
/// eq. necessarycondition-incrementalpassicity-link, as corrected in `docs/errata.md`.
#[inline]
pub fn incremental_passivity<C: Scalar, T: Over<C>, const N: usize>(
    shaping: &impl Shaping<C, N>,
    metric: &Matrix<C, N, N>,
    beta: T,
    [z_1, z_2]: [&Vector<T, N>; 2],
) -> T {
    let (Pi, chord) = (metric.map(T::constant), *z_2 - *z_1);
    let chi = Pi * (shaping.eval(z_2) - shaping.eval(z_1));
    chord.dot(&chi) - beta * chord.dot(&(Pi * chord))
}

/// Π ∂φ + ∂φᵀ Π − 2β Π at an error, Π constant: positive semidefinite where the contraction inequality holds. Paper, eq.
/// controllaw-positionmetricinquality.
#[inline]
pub fn slope_inequality<C: Scalar, T: Over<C>, const N: usize>(
    shaping: &impl Shaping<C, N>,
    metric: &Matrix<C, N, N>,
    beta: T,
    error: &Vector<T, N>,
) -> Matrix<T, N, N> {
    let Pi = metric.map(T::constant);
    let product = Pi * shaping.slope(error);
    product + product.transpose() - Pi.scaled(beta + beta)
}
