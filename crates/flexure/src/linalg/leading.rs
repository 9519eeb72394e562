//! The leading square block of a matrix that is stored somewhere else.

use std::ops::{Index, IndexMut};

use super::Dense;

/// The leading `size` × `size` block of a matrix stored row by row, in place: no copy, no allocation. What lies outside the
/// block is not touched, so that storage may be larger than the matrix in it.
#[derive(Debug)]
pub struct Leading<'a> {
    entries: &'a mut [f64],
    stride: usize,
    size: usize,
}

impl<'a> Leading<'a> {
    /// The leading block of rows of `N` numbers.
    ///
    /// # Panics
    /// If there are fewer than `size` rows or columns.
    pub fn of<const N: usize>(rows: &'a mut [[f64; N]], size: usize) -> Self {
        assert!(size <= N && size <= rows.len(), "a block of {size} in {} rows of {N}", rows.len());
        Self { entries: rows.as_flattened_mut(), stride: N, size }
    }

    /// All of a square matrix.
    pub fn whole(matrix: &'a mut Dense<f64>) -> Self {
        let size = matrix.columns();
        Self { entries: matrix.entries_mut(), stride: size, size }
    }

    /// Number of rows, and of columns.
    pub fn size(&self) -> usize {
        self.size
    }
}

impl Index<(usize, usize)> for Leading<'_> {
    type Output = f64;

    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.entries[i * self.stride + j]
    }
}

impl IndexMut<(usize, usize)> for Leading<'_> {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.entries[i * self.stride + j]
    }
}
