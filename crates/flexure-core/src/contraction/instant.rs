//! The real motion about one instant.

use crate::linalg::Vector;
use crate::model::Motion;
use crate::scalar::{Over, Scalar};

/// The motion `t` in s after the instant when it is `motion`: q + q̇ t, right to first order.
#[inline]
pub(super) fn after<C: Scalar, T: Over<C>, const N: usize>(motion: &Motion<C, N>, t: T) -> Motion<T, N> {
    let on = |q: &Vector<C, N>, v: &Vector<C, N>| Vector::from_fn(|i| T::constant(q[i]) + t.scale(v[i]));
    let Motion { q_l, q_m, v_l, v_m } = motion;
    Motion { q_l: on(q_l, v_l), q_m: on(q_m, v_m), v_l: v_l.lift(), v_m: v_m.lift() }
}
