//! The derivative of what only positions are known of.

use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// ϑ = a (y − z) with ż = ϑ: y through a s/(s + a), the rate of y in the units of y per second at frequencies below a [1/s].
#[inline]
pub(super) fn dirty_derivative<C: Scalar, T: Over<C>, const N: usize>(
    cutoff: &Vector<C, N>,
    y: &Vector<T, N>,
    z: &Vector<T, N>,
) -> Vector<T, N> {
    cutoff.diag_mul(&(*y - *z))
}
