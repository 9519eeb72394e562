//! The tightest intervals around `a + b`, `a · b`, `a / b`, `√a` of floats, in round-to-nearest.
//!
//! Each computes the rounded result and the *sign* of its exact error. A correctly rounded result is within half a step
//! of the exact one, so one step in the direction of the error reaches past it, and no step is needed where the error is
//! zero. Where the error cannot be had (overflow, underflow, infinities) it is NaN, and both sides step.
#![expect(clippy::float_cmp, reason = "factors of exactly one are exact")]

use super::Interval;

/// The interval around `value + error`, where `value` is the float nearest to it, and not 0 unless the error is. NaN: unknown.
#[inline]
fn around(value: f64, error: f64) -> Interval {
    if error.is_nan() {
        return either_way(value);
    }
    // Neighbours of floats other than 0 are neighbours as integers; no branch, since the sign of an error cannot be foretold.
    let bits = value.to_bits().cast_signed();
    let up = (bits >> 63) | 1;
    let [below, above] = [error < 0.0, error > 0.0].map(i64::from);
    let float = |bits: i64| f64::from_bits(bits.cast_unsigned());
    Interval { lo: float(bits - up * below), hi: float(bits + up * above) }
}

/// The interval around what `value` is the nearest float to. An overflow to ∞ steps back down to the largest float.
#[cold]
fn either_way(value: f64) -> Interval {
    if value.is_nan() {
        return Interval::ENTIRE; // ∞ − ∞, ∞ / ∞: end points without a bound
    }
    Interval { lo: value.next_down(), hi: value.next_up() }
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
    let p = a * b;
    let error = product_error(a, b, p);
    if error.is_nan() { far_product(a, b, p) } else { around(p, error) }
}

/// The same where the error of `p = a · b` cannot be had.
#[cold]
fn far_product(a: f64, b: f64, p: f64) -> Interval {
    if a == 0.0 || b == 0.0 {
        return Interval { lo: 0.0, hi: 0.0 };
    }
    if a.abs() == 1.0 || b.abs() == 1.0 {
        return Interval { lo: p, hi: p };
    }
    underflow(p).unwrap_or_else(|| either_way(p))
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

/// The exact `a b − p` for `p = a · b` rounded, NaN where it may not be a float: the same with fused multiplication and by Dekker's products.
///
/// With 53-bit integers times 2ᵏ and 2ˡ for factors, every intermediate is a multiple of 2ᵏ⁺ˡ of at most 53 bits. A `p` of
/// at least 2⁻⁹⁶⁰ makes `k + l ≥ −1066`: nothing underflows. Factors below 2⁹⁶⁰ split without overflow.
#[inline]
fn product_error(a: f64, b: f64, p: f64) -> f64 {
    const LARGE: f64 = f64::from_bits((1023 + 960) << 52);
    if !(is_normal(p) && a.abs() < LARGE && b.abs() < LARGE) {
        return f64::NAN;
    }
    exact_error(a, b, p)
}

/// `a b − p`, which is a float, in one instruction.
#[cfg(all(feature = "std", target_feature = "fma"))]
#[inline]
fn exact_error(a: f64, b: f64, p: f64) -> f64 {
    a.mul_add(b, -p)
}

/// `a b − p`, which is a float.
#[cfg(not(all(feature = "std", target_feature = "fma")))]
#[inline]
fn exact_error(a: f64, b: f64, p: f64) -> f64 {
    dekker(a, b, p)
}

/// `a b − p` without fused multiplication.
#[cfg(any(test, not(all(feature = "std", target_feature = "fma"))))]
#[inline]
fn dekker(a: f64, b: f64, p: f64) -> f64 {
    let ((a1, a0), (b1, b0)) = (halves(a), halves(b));
    (((a1 * b1 - p) + a1 * b0) + a0 * b1) + a0 * b0
}

/// Veltkamp's split: `a = a1 + a0` exactly, both of at most 26 bits, so that their products are exact.
#[cfg(any(test, not(all(feature = "std", target_feature = "fma"))))]
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a; // 2²⁷ + 1
    let a1 = c - (c - a);
    (a1, a - a1)
}

#[cfg(all(test, feature = "std", target_feature = "fma"))]
mod tests {
    use super::{dekker, exact_error, is_normal};

    /// What one instruction says of a product's error is what Dekker's products say, to the bit: proofs are the same on every processor.
    #[test]
    fn fused_and_not_fused_errors_are_the_same() {
        let mut state = 1_u64;
        let mut next = || {
            // Knuth's linear congruential generator, its high bits; exponents from −400 to 400.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mantissa = state >> 12 | 1023 << 52;
            let exponent = i32::try_from(state >> 33 & 1023).unwrap_or(0) % 801 - 400;
            f64::from_bits(mantissa) * 2.0_f64.powi(exponent) * if state >> 11 & 1 == 0 { 1.0 } else { -1.0 }
        };
        for k in 0..1_000_000 {
            // Short factors have exact products.
            let shorten = |x: f64| if k % 4 == 0 { f64::from_bits(x.to_bits() & !0x7fff_ffff) } else { x };
            let (a, b) = (shorten(next()), shorten(next()));
            let p = a * b;
            if is_normal(p) {
                let [fused, products] = [exact_error, dekker].map(|error| error(a, b, p) + 0.0);
                assert_eq!(fused.to_bits(), products.to_bits(), "{a:e} · {b:e}");
            }
        }
    }
}
