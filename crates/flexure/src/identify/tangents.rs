//! How the predicted motion moves with what is identified: a row a state, a column an unknown.

/// Derivatives of 4n states (q_l, q_m, q̇_l, q̇_m) by the unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Tangents {
    width: usize,
    entries: Vec<f64>,
}

impl Tangents {
    pub fn zeros(rows: usize, width: usize) -> Self {
        Self { width, entries: vec![0.0; rows * width] }
    }

    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.width..(i + 1) * self.width]
    }

    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.entries[i * self.width..(i + 1) * self.width]
    }

    /// Rows `i` and `j`, `i` < `j`.
    pub fn two_rows(&mut self, i: usize, j: usize) -> (&mut [f64], &mut [f64]) {
        let (before, from) = self.entries.split_at_mut(j * self.width);
        (&mut before[i * self.width..(i + 1) * self.width], &mut from[..self.width])
    }

    pub fn entries(&self) -> &[f64] {
        &self.entries
    }

    pub fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Copies what `other`, of the same size, has.
    pub fn copy(&mut self, other: &Self) {
        self.entries.copy_from_slice(&other.entries);
    }
}

/// `to` += `factor` `row`.
#[inline]
pub(crate) fn add(to: &mut [f64], factor: f64, row: &[f64]) {
    for (to, x) in to.iter_mut().zip(row) {
        *to += factor * x;
    }
}
