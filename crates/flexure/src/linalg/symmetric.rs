//! Symmetric matrices, and whether all matrices inside one of intervals are positive definite.

use flexure_core::scalar::{Interval, Scalar};

/// A symmetric matrix, or the quadratic form that it makes: its lower triangle, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetric<T> {
    size: usize,
    lower: Vec<T>,
}

impl<T: Copy> Symmetric<T> {
    /// The matrix whose entries on and below the diagonal are `entry(i, j)`, `j ≤ i`.
    pub fn from_fn(size: usize, mut entry: impl FnMut(usize, usize) -> T) -> Self {
        let lower = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        Self { size, lower }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Entry (i, j), whichever triangle it is in.
    pub fn at(&self, i: usize, j: usize) -> T {
        let (i, j) = if i < j { (j, i) } else { (i, j) };
        self.lower[i * (i + 1) / 2 + j]
    }

    /// Every entry through `f`.
    #[must_use]
    pub fn map<U>(&self, f: impl FnMut(T) -> U) -> Symmetric<U> {
        Symmetric { size: self.size, lower: self.lower.iter().copied().map(f).collect() }
    }
}

impl<T: Scalar> Symmetric<T> {
    /// diag(`d`).
    pub fn diagonal(d: &[T]) -> Self {
        Self::from_fn(d.len(), |i, j| if i == j { d[i] } else { T::ZERO })
    }

    /// `self − other · scale`, entry by entry.
    #[must_use]
    pub fn minus(&self, other: &Self, scale: T) -> Self {
        let lower = self.lower.iter().zip(&other.lower).map(|(&a, &b)| a - b * scale).collect();
        Self { size: self.size, lower }
    }

    /// xᵀ A x.
    pub fn value(&self, x: &[T]) -> T {
        let mut sum = T::ZERO;
        for i in 0..self.size {
            sum += self.at(i, i) * x[i].square();
            for j in 0..i {
                let product = self.at(i, j) * x[i] * x[j];
                sum += product + product;
            }
        }
        sum
    }
}

impl Symmetric<Interval> {
    /// A lower bound of the smallest pivot of L D Lᵀ, without pivoting: the matrix is positive definite if it is
    /// positive, whichever reals of the intervals are its entries. Elimination ends at the first pivot that may not be
    /// positive.
    pub fn smallest_pivot(&self) -> f64 {
        let n = self.size;
        let mut a = self.lower.clone();
        let at = |i: usize, j: usize| i * (i + 1) / 2 + j;
        let mut smallest = f64::INFINITY;
        for k in 0..n {
            let pivot = a[at(k, k)];
            smallest = smallest.min(pivot.lo());
            if smallest.is_nan() || smallest <= 0.0 {
                return smallest;
            }
            for i in k + 1..n {
                let factor = a[at(i, k)] / pivot;
                // The diagonal by a square: a product of an interval with itself is not as tight.
                let square = a[at(i, k)].square() / pivot;
                a[at(i, i)] -= square;
                for j in k + 1..i {
                    let update = factor * a[at(j, k)];
                    a[at(i, j)] -= update;
                }
            }
        }
        smallest
    }
}

#[cfg(test)]
mod tests {
    use super::{Interval, Symmetric};

    fn second_difference(size: usize, shift: f64) -> Symmetric<Interval> {
        Symmetric::from_fn(size, |i, j| {
            Interval::point(match i - j {
                0 => 2.0 - shift,
                1 => -1.0,
                _ => 0.0,
            })
        })
    }

    /// Eigenvalues 2 − 2 cos(kπ/(n + 1)): positive definite up to the smallest, and not beyond.
    #[test]
    fn definite_up_to_the_smallest_eigenvalue() {
        for n in [1, 2, 7, 28] {
            let smallest = 2.0 - 2.0 * (std::f64::consts::PI / (n as f64 + 1.0)).cos();
            assert!(second_difference(n, smallest * (1.0 - 1e-9)).smallest_pivot() > 0.0, "{n}");
            assert!(second_difference(n, smallest * (1.0 + 1e-9)).smallest_pivot() < 0.0, "{n}");
        }
    }

    /// Entries that are not known to a definite matrix are not taken for one.
    #[test]
    fn what_is_unknown_is_not_definite() {
        let wide = Interval::new(-1.5, 1.5).unwrap();
        let entry = |i, j| if i == j { Interval::point(1.0) } else { wide };
        assert!(Symmetric::from_fn(2, entry).smallest_pivot() <= 0.0);
        assert!(Symmetric::from_fn(1, |_, _| Interval::ENTIRE).smallest_pivot() <= 0.0);
    }
}
