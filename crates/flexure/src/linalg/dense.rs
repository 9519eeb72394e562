//! Matrices by rows.

use std::ops::{Add, Index, IndexMut, Mul, Range};

use flexure_core::scalar::Scalar;

use super::Symmetric;

/// A matrix, stored row by row; entry (i, j) is `matrix[(i, j)]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense<T> {
    columns: usize,
    entries: Vec<T>,
}

impl<T> Dense<T> {
    /// The matrix of `rows` rows and `columns` columns whose entry (i, j) is `entry(i, j)`.
    pub fn from_fn(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> T) -> Self {
        let entries =
            (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        Self { columns, entries }
    }

    /// The matrix with these columns, all of one length.
    pub fn from_columns(columns: &[Vec<T>]) -> Self
    where
        T: Copy,
    {
        Self::from_fn(columns.first().map_or(0, Vec::len), columns.len(), |i, j| columns[j][i])
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Row `i`.
    pub fn row(&self, i: usize) -> &[T] {
        &self.entries[i * self.columns..(i + 1) * self.columns]
    }

    /// The rows, from the first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[T]> {
        self.entries.chunks_exact(self.columns.max(1))
    }

    /// The matrix of `f` of each entry.
    pub fn map<U>(&self, f: impl FnMut(T) -> U) -> Dense<U>
    where
        T: Copy,
    {
        Dense { columns: self.columns, entries: self.entries.iter().copied().map(f).collect() }
    }

    /// Rows as columns.
    #[must_use]
    pub fn transposed(&self) -> Self
    where
        T: Copy,
    {
        Self::from_fn(self.columns, self.rows().len(), |i, j| self[(j, i)])
    }

    /// The matrix times the vector `x`.
    pub fn apply(&self, x: &[T]) -> Vec<T>
    where
        T: Scalar,
    {
        self.rows().map(|row| row.iter().zip(x).fold(T::ZERO, |sum, (&a, &x)| sum + a * x)).collect()
    }

    /// All entries, row by row.
    pub fn entries_mut(&mut self) -> &mut [T] {
        &mut self.entries
    }
}

impl Dense<f64> {
    /// All entries 0.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { columns, entries: vec![0.0; rows * columns] }
    }

    /// 1 on the diagonal, 0 elsewhere.
    pub fn identity(n: usize) -> Self {
        Self::from_fn(n, n, |i, j| if i == j { 1.0 } else { 0.0 })
    }

    /// A⁻¹ `b` by elimination without pivoting, for a matrix near enough to the identity, as those of implicit steps are.
    pub fn solved(mut self, mut b: Self) -> Self {
        let n = self.columns();
        for p in 0..n {
            for i in (0..n).filter(|&i| i != p) {
                let factor = self[(i, p)] / self[(p, p)];
                if factor == 0.0 {
                    continue;
                }
                for j in p..n {
                    self[(i, j)] -= factor * self[(p, j)];
                }
                for j in 0..b.columns() {
                    b[(i, j)] -= factor * b[(p, j)];
                }
            }
        }
        Self::from_fn(n, b.columns(), |i, j| b[(i, j)] / self[(i, i)])
    }

    /// Every entry times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { columns: self.columns, entries: self.entries.iter().map(|x| x * factor).collect() }
    }

    /// These rows, in order.
    #[must_use]
    pub fn slice(&self, rows: Range<usize>) -> Self {
        let entries = self.entries[rows.start * self.columns..rows.end * self.columns].to_vec();
        Self { columns: self.columns, entries }
    }

    /// The rows of all `parts`, which have as many columns each, one part below the other.
    pub fn stacked(parts: &[&Self]) -> Self {
        let columns = parts.first().map_or(0, |part| part.columns);
        Self { columns, entries: parts.iter().flat_map(|part| &part.entries).copied().collect() }
    }
}

impl<T: Copy + Add<Output = T>> Add for &Dense<T> {
    type Output = Dense<T>;

    fn add(self, rhs: Self) -> Dense<T> {
        let entries = self.entries.iter().zip(&rhs.entries).map(|(&a, &b)| a + b).collect();
        Dense { columns: self.columns, entries }
    }
}

impl<T: Scalar + PartialEq> Mul for &Dense<T> {
    type Output = Dense<T>;

    fn mul(self, rhs: Self) -> Dense<T> {
        let rows = self.rows().len();
        let mut product = Dense { columns: rhs.columns, entries: vec![T::ZERO; rows * rhs.columns] };
        for (sum, row) in product.entries.chunks_exact_mut(rhs.columns.max(1)).zip(self.rows()) {
            for (&factor, other) in row.iter().zip(rhs.rows()) {
                if factor != T::ZERO {
                    sum.iter_mut().zip(other).for_each(|(sum, &x)| *sum += factor * x);
                }
            }
        }
        product
    }
}

impl<T: Copy> From<&Symmetric<T>> for Dense<T> {
    fn from(symmetric: &Symmetric<T>) -> Self {
        Self::from_fn(symmetric.size(), symmetric.size(), |i, j| symmetric.at(i, j))
    }
}

impl<T> Index<(usize, usize)> for Dense<T> {
    type Output = T;

    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.row(i)[j]
    }
}

impl<T> IndexMut<(usize, usize)> for Dense<T> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        let start = i * self.columns;
        &mut self.entries[start..start + self.columns][j]
    }
}

#[cfg(test)]
mod tests {
    use super::Dense;

    #[test]
    fn rows_and_columns_are_where_they_belong() {
        let mut a = Dense::from_fn(2, 3, |i, j| 10 * i + j);
        assert_eq!(a.row(1), [10, 11, 12]);
        assert_eq!(a.rows().count(), 2);
        assert_eq!(a, Dense::from_columns(&[vec![0, 10], vec![1, 11], vec![2, 12]]));
        a[(0, 2)] = 7;
        assert_eq!((a[(0, 2)], a.row(0)), (7, [0, 1, 7].as_slice()));
    }

    #[test]
    #[should_panic(expected = "out of bounds")]
    fn a_column_too_far_is_not_the_next_row() {
        let _ = Dense::from_fn(2, 2, |i, j| i + j)[(0, 2)];
    }
}
