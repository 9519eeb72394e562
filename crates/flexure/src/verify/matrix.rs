//! Symmetric matrices of intervals and the pivots of L D Lᵀ.

use flexure_core::scalar::{Interval, Scalar};

/// A symmetric matrix: row i holds the columns 0 to i.
#[derive(Clone, Debug)]
pub(super) struct Symmetric(Vec<Vec<Interval>>);

impl Symmetric {
    /// Entries below and on the diagonal from a function of row and column.
    pub(super) fn from_fn(n: usize, entry: impl Fn(usize, usize) -> Interval) -> Self {
        Self((0..n).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect())
    }

    /// A lower bound of the smallest pivot of L D Lᵀ without pivoting, for every real matrix inside.
    ///
    /// Where it is > 0, each is positive definite: the product of the first k pivots is the k-th leading minor. Where it
    /// is 0, each is positive semidefinite: a pivot that may be 0 is only let pass with zeros below it.
    pub(super) fn smallest_pivot(self) -> f64 {
        let Self(mut rest) = self;
        let mut smallest = f64::INFINITY;
        while let Some(pivot) = rest.first().and_then(|row| row.first()).copied() {
            smallest = smallest.min(pivot.lo());
            let below: Vec<_> = rest.iter().skip(1).filter_map(|row| row.first().copied()).collect();
            rest = Self::from_fn(below.len(), |i, j| {
                let product = if i == j { below[i].square() } else { below[i] * below[j] };
                let entry = rest[i + 1][j + 1];
                // Division by an interval around 0 gives everything, and later a pivot without a lower bound.
                if product == Interval::ZERO { entry } else { entry - product / pivot }
            })
            .0;
        }
        smallest
    }
}

#[cfg(test)]
mod tests {
    use super::Symmetric;
    use flexure_core::scalar::{Interval, Scalar};

    fn smallest(rows: &[&[f64]]) -> f64 {
        Symmetric::from_fn(rows.len(), |i, j| Interval::point(rows[i][j])).smallest_pivot()
    }

    #[test]
    fn pivots_are_those_of_the_factorisation() {
        assert!((smallest(&[&[4.0], &[2.0, 3.0]]) - 2.0).abs() < 1e-15);
        assert!((smallest(&[&[4.0], &[2.0, 3.0], &[2.0, 0.0, 1.5]]) - 0.0).abs() < 1e-15);
        assert!(smallest(&[&[1.0], &[2.0, 1.0]]) < 0.0 && smallest(&[&[-1.0], &[2.0, 9.0]]) < 0.0);
    }

    #[test]
    fn a_pivot_of_zero_passes_with_zeros_below_it_only() {
        assert_eq!(smallest(&[&[0.0], &[0.0, 1.0]]).to_bits(), 0);
        assert!(
            smallest(&[&[0.0], &[1e-9, 1.0]]) < 0.0
                && smallest(&[&[0.0], &[0.0, 1.0], &[1e-9, 0.0, 1.0]]) < 0.0
        );
    }

    #[test]
    fn every_matrix_inside_counts() {
        let wide = |x: f64, y: f64| Interval::new(x, y).unwrap();
        let matrix =
            |upper| Symmetric::from_fn(2, |i, j| if i == j { Interval::ONE } else { wide(-1.0, upper) });
        assert!(matrix(0.5).smallest_pivot() <= 0.0 && matrix(1.1).smallest_pivot() < -0.2);
        let unbounded = Symmetric::from_fn(2, |i, j| if i == j { Interval::ONE } else { Interval::ENTIRE });
        assert!(unbounded.smallest_pivot() < 0.0);
    }
}
