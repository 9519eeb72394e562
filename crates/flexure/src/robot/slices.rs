//! Between slices, whose lengths are known when the program runs, and vectors, whose capacities are known when it is built.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::Motion;
use flexure_core::scalar::{Jet, Scalar};

/// A slice that has another length than it must have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} has {found} numbers, must have {expected} ({rule})")]
pub struct Mismatch {
    /// Name of the argument.
    pub name: &'static str,
    /// Numbers that it has.
    pub found: usize,
    /// Numbers that it must have.
    pub expected: usize,
    /// How many that is in terms of the joint count n.
    pub rule: &'static str,
}

/// # Errors
/// If `found` is not `expected`.
pub(crate) fn check(
    name: &'static str,
    rule: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), Mismatch> {
    if found == expected { Ok(()) } else { Err(Mismatch { name, found, expected, rule }) }
}

/// A vector of `n` numbers; zero for joints that only fill the capacity.
pub(crate) fn read<C: Scalar, const N: usize>(
    name: &'static str,
    values: &[C],
    n: usize,
) -> Result<Vector<C, N>, Mismatch> {
    check(name, "n", values.len(), n)?;
    Ok(fill(values))
}

/// Series, one array per joint; zero for joints that only fill the capacity.
pub(crate) fn read_rows<C: Scalar, const K: usize, const N: usize>(
    name: &'static str,
    values: &[[C; K]],
    n: usize,
) -> Result<Vector<Jet<C, K>, N>, Mismatch> {
    check(name, "n", values.len(), n)?;
    Ok(Vector::from_fn(|i| values.get(i).map_or(Jet::value(C::ZERO), |row| Jet::new(*row))))
}

/// A motion from (q_l, q_m, q̇_l, q̇_m), 4n numbers.
pub(crate) fn read_motion<C: Scalar, const N: usize>(
    values: &[C],
    n: usize,
) -> Result<Motion<C, N>, Mismatch> {
    check("motion", "4n: q_l, q_m, dq_l, dq_m", values.len(), 4 * n)?;
    let part = |k: usize| fill(&values[k * n..(k + 1) * n]);
    Ok(Motion { q_l: part(0), q_m: part(1), v_l: part(2), v_m: part(3) })
}

/// The first numbers of `vector`.
pub(crate) fn write<T: Copy, const N: usize>(vector: &Vector<T, N>, values: &mut [T]) {
    for (slot, value) in values.iter_mut().zip(vector.iter()) {
        *slot = value;
    }
}

/// (q_l, q_m, q̇_l, q̇_m), `n` numbers each.
pub(crate) fn write_motion<T: Copy, const N: usize>(x: &Motion<T, N>, n: usize, values: &mut [T]) {
    for (part, slot) in [&x.q_l, &x.q_m, &x.v_l, &x.v_m].into_iter().zip(values.chunks_exact_mut(n)) {
        write(part, slot);
    }
}

/// The leading `n` × `n` entries of `matrix`, row by row.
pub(crate) fn write_rows<T: Copy, const N: usize>(matrix: &Matrix<T, N, N>, n: usize, values: &mut [T]) {
    for (row, slot) in matrix.0.iter().zip(values.chunks_exact_mut(n)) {
        for (slot, &value) in slot.iter_mut().zip(row) {
            *slot = value;
        }
    }
}

fn fill<C: Scalar, const N: usize>(values: &[C]) -> Vector<C, N> {
    Vector::from_fn(|i| values.get(i).copied().unwrap_or(C::ZERO))
}
