//! The tightest intervals around `a + b`, `a · b`, `a / b`, `√a` of floats, in round-to-nearest.
//!
//! Each computes the rounded result and the *sign* of its exact error. A correctly rounded result is within half a step
//! of the exact one, so one step in the direction of the error reaches past it, and no step is needed where the error is
//! zero. Where the error cannot be had (overflow, underflow, infinities) it is NaN, and both sides step.
#![expect(clippy::float_cmp, reason = "factors of exactly one are exact")]

use super::Interval;

/// The interval around `value + error`, where `value` is the float nearest to it. NaN: unknown.
#[inline]
fn around(value: f64, error: f64) -> Interval {
    if value.is_nan() {
        return Interval::ENTIRE; // ∞ − ∞, ∞ / ∞: end points without a bound
    }
    // A comparison with NaN is false: an unknown error steps. An overflow to ∞ steps back down to the largest float.
    Interval {
        lo: if error >= 0.0 { value } else { value.next_down() },
        hi: if error <= 0.0 { value } else { value.next_up() },
    }
}

/// Encloses `a + b`: the error of a sum is a float, given by Knuth's TwoSum, also among subnormals.
#[inline]
pub(super) fn sum(a: f64, b: f64) -> Interval {
    let s = a + b;
    let b_kept = s - a;
    let error = (a - (s - b_kept)) + (b - b_kept);
    around(s, error)
}

/// Encloses `a · b`; zero times anything is zero.
#[inline]
pub(super) fn product(a: f64, b: f64) -> Interval {
    if a == 0.0 || b == 0.0 {
        return Interval { lo: 0.0, hi: 0.0 };
    }
    let p = a * b;
    if a.abs() == 1.0 || b.abs() == 1.0 {
        return Interval { lo: p, hi: p };
    }
    underflow(p).unwrap_or_else(|| around(p, product_error(a, b, p)))
}

/// Encloses `a / b` for `b > 0`; anything finite over an unbounded end is 0 in the limit.
#[inline]
pub(super) fn quotient(a: f64, b: f64) -> Interval {
    if a == 0.0 || (b == f64::INFINITY && a.is_finite()) {
        return Interval { lo: 0.0, hi: 0.0 };
    }
    let q = a / b;
    if b == 1.0 {
        return Interval { lo: q, hi: q };
    }
    // The residual a − q b has the sign of the error. With q b = p + e exactly, and p within a few steps
    // of a, a − p is exact (Sterbenz) and the last rounding keeps the sign.
    let p = q * b;
    let residual = (a - p) - if is_normal(q) { product_error(q, b, p) } else { f64::NAN };
    underflow(q).unwrap_or_else(|| around(q, residual))
}

/// Encloses `√a` for `a ≥ 0`: the root is too small exactly where `a − r²` is positive, found as in [`quotient`].
#[inline]
pub(super) fn root(a: f64) -> Interval {
    if a == 0.0 {
        return Interval { lo: 0.0, hi: 0.0 };
    }
    let r = libm::sqrt(a);
    let p = r * r;
    around(r, (a - p) - product_error(r, r, p))
}

/// A product or quotient of nonzero numbers that underflowed to zero keeps the sign of the exact result.
#[inline]
fn underflow(value: f64) -> Option<Interval> {
    const TINY: f64 = f64::from_bits(1);
    (value == 0.0).then_some(if value.is_sign_positive() {
        Interval { lo: 0.0, hi: TINY }
    } else {
        Interval { lo: -TINY, hi: 0.0 }
    })
}

/// Far enough from the ends of the exponent range that neither a split overflows nor an error underflows.
#[inline]
fn is_normal(x: f64) -> bool {
    const SMALL: f64 = f64::from_bits((1023 - 960) << 52); // 2⁻⁹⁶⁰
    const LARGE: f64 = f64::from_bits((1023 + 960) << 52); // 2⁹⁶⁰
    (SMALL..LARGE).contains(&x.abs())
}

/// The exact `a b − p` for `p = a · b` rounded (Dekker), NaN where it may not be a float.
///
/// With 53-bit integers times 2ᵏ and 2ˡ for factors, every intermediate is a multiple of 2ᵏ⁺ˡ of at most 53 bits. A `p` of
/// at least 2⁻⁹⁶⁰ makes `k + l ≥ −1066`: nothing underflows. Factors below 2⁹⁶⁰ split without overflow.
#[inline]
fn product_error(a: f64, b: f64, p: f64) -> f64 {
    const LARGE: f64 = f64::from_bits((1023 + 960) << 52);
    if !(is_normal(p) && a.abs() < LARGE && b.abs() < LARGE) {
        return f64::NAN;
    }
    let ((a1, a0), (b1, b0)) = (halves(a), halves(b));
    (((a1 * b1 - p) + a1 * b0) + a0 * b1) + a0 * b0
}

/// Veltkamp's split: `a = a1 + a0` exactly, both of at most 26 bits, so that their products are exact.
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a; // 2²⁷ + 1
    let a1 = c - (c - a);
    (a1, a - a1)
}
