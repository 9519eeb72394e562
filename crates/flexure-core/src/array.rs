//! Arrays of results.
#![expect(clippy::indexing_slicing, reason = "loops over a const dimension; the no-panic check covers them")]

/// The array whose entry `i` is `f(i)`, at least one.
///
/// What [`core::array::from_fn`] gives, too, through five functions of its own for every `f` and four times the code: with the thousands of them here that
/// was a fifth of all that a compiler had to optimise.
#[inline]
#[expect(clippy::needless_range_loop, reason = "iterators are functions of their own, too")]
pub(crate) fn filled<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    let mut all = [f(0); N];
    for i in 1..N {
        all[i] = f(i);
    }
    all
}

/// Every entry through `f`, likewise.
#[inline]
pub(crate) fn mapped<S: Copy, T: Copy, const N: usize>(all: &[S; N], mut f: impl FnMut(S) -> T) -> [T; N] {
    filled(|i| f(all[i]))
}
