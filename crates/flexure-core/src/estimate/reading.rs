//! What to do with readings that are no numbers.

use crate::linalg::Vector;
use crate::model::Motion;
use crate::scalar::Float;

/// Whether all of a motion is finite.
#[inline]
pub(super) fn is_finite<C: Float, const N: usize>(x: &Motion<C, N>) -> bool {
    [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|part| part.iter().all(C::is_finite))
}

/// At rest where the encoders say, at 0 where they say nothing.
#[inline]
pub(super) fn at_rest<C: Float, const N: usize>(q_l: &Vector<C, N>, q_m: &Vector<C, N>) -> Motion<C, N> {
    let or_zero = |q: C| if q.is_finite() { q } else { C::ZERO };
    Motion { q_l: q_l.map(or_zero), q_m: q_m.map(or_zero), v_l: Vector::ZERO, v_m: Vector::ZERO }
}

/// `x` where the reading is a number, NaN where it is not.
#[inline]
pub(super) fn where_read<C: Float, const N: usize>(x: &Vector<C, N>, reading: &Vector<C, N>) -> Vector<C, N> {
    Vector::from_fn(|i| if reading[i].is_finite() { x[i] } else { nan() })
}

/// Not a number.
#[inline]
pub(super) fn nan<C: Float>() -> C {
    C::from_f64(f64::NAN)
}
