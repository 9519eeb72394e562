//! Matrices by rows.

use std::ops::{Index, IndexMut};

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
    pub fn rows(&self) -> impl Iterator<Item = &[T]> {
        self.entries.chunks_exact(self.columns.max(1))
    }

    /// All entries, row by row.
    pub fn entries_mut(&mut self) -> &mut [T] {
        &mut self.entries
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
