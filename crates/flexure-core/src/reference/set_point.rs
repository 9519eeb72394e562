//! A set point: the reference that stays where it is.

use super::Reference;
use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

/// The constant posture `self` in rad.
impl<C: Scalar, const N: usize> Reference<C, N> for Vector<C, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, _t: T) -> Vector<T, N> {
        self.lift()
    }
}
