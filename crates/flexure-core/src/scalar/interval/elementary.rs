//! Enclosures of the elementary functions at a float, and the range of sine and cosine over an interval.
//!
//! `core_math` returns the float nearest to the exact value (its tests compare with mpmath), so one step down and one step up enclose it. The values that are
//! floats exactly (0 ↦ 0 and the like; by Lindemann there are no others) are given as points.
#![expect(clippy::float_cmp, reason = "the arguments with exact values are exact")]

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, LN_2, TAU};

use super::{Interval, Scalar, rounding};

/// One step each way from a correctly rounded value.
#[inline]
fn around(nearest: f64) -> Interval {
    Interval { lo: nearest.next_down(), hi: nearest.next_up() }
}

/// Limits the enclosure to a range that the function never leaves.
#[inline]
fn clip(x: Interval, lo: f64, hi: f64) -> Interval {
    Interval { lo: x.lo.max(lo), hi: x.hi.min(hi) }
}

/// Encloses `eˣ`, which is positive.
#[inline]
pub(super) fn exp(x: f64) -> Interval {
    if x == 0.0 { Interval::ONE } else { clip(around(core_math::exp(x)), 0.0, f64::INFINITY) }
}

/// Encloses `ln x` for `x ≥ 0`; −∞ at 0.
#[inline]
pub(super) fn ln(x: f64) -> Interval {
    if x == 1.0 { Interval::ZERO } else { around(core_math::log(x)) }
}

/// Encloses `tanh x`, which stays within ±1.
#[inline]
pub(super) fn tanh(x: f64) -> Interval {
    if x == 0.0 { Interval::ZERO } else { clip(around(core_math::tanh(x)), -1.0, 1.0) }
}

/// Encloses `atan x`.
#[inline]
pub(super) fn atan(x: f64) -> Interval {
    if x == 0.0 { Interval::ZERO } else { around(core_math::atan(x)) }
}

/// Encloses `ln cosh x` for `x ≥ 0`, from functions that increase on enclosures of their arguments.
pub(super) fn ln_cosh(x: f64) -> Interval {
    let log1p = |y: f64| if y == 0.0 { Interval::ZERO } else { around(core_math::log1p(y)) };
    if x == 0.0 {
        Interval::ZERO
    } else if x < 1.0 {
        // ln(1 + 2 sinh² (x/2)): nothing cancels. Half of a subnormal may round: below, sinh and its square enclose.
        let half = rounding::product(0.5, x);
        let sinh = clip(half.increasing(|h| around(core_math::sinh(h))), 0.0, f64::INFINITY);
        let twice = sinh.square() * Interval::point(2.0);
        clip(twice.increasing(log1p), 0.0, f64::INFINITY)
    } else {
        // x − ln 2 + ln(1 + e^(−2x)): x − ln 2 > 0, nothing cancels. The float nearest to ln 2 is below it.
        const LN_TWO: Interval = Interval { lo: LN_2, hi: LN_2.next_up() };
        let tail = (Interval::point(x) * Interval::point(-2.0)).exp().increasing(log1p);
        (Interval::point(x) - LN_TWO) + tail
    }
}

/// The range of sine and cosine.
///
/// Between consecutive multiples of π/2 both are monotone: the range is the hull of the values at the ends and of the
/// extremes at the multiples inside. A multiple that cannot be decided by its enclosure counts as inside, which is safe.
pub(super) fn sin_cos(x: Interval) -> (Interval, Interval) {
    const UNIT: Interval = Interval { lo: -1.0, hi: 1.0 };
    const FAR: f64 = 1_073_741_824.0; // 2³⁰ rad
    // The float nearest to π/2 is below it.
    const QUARTER: Interval = Interval { lo: FRAC_PI_2, hi: FRAC_PI_2.next_up() };

    if !(x.magnitude() <= FAR && x.hi - x.lo < TAU) {
        return (UNIT, UNIT);
    }
    let ends = |f: fn(f64) -> Interval| {
        let lower = f(x.lo);
        if x.lo < x.hi { lower.hull(f(x.hi)) } else { lower }
    };
    let (mut sin, mut cos) = (ends(sin), ends(cos));
    // One multiple earlier than rounding could make the first inside; at most five lie inside.
    let first = libm::floor(x.lo * FRAC_2_PI) - 1.0;
    for step in 0..8_i32 {
        let multiple = first + f64::from(step);
        let angle = Interval::point(multiple) * QUARTER;
        if angle.lo > x.hi {
            break;
        }
        if angle.hi < x.lo {
            continue;
        }
        // multiple mod 4, exactly: these are integers below 2³¹.
        match multiple - 4.0 * libm::floor(multiple / 4.0) {
            0.0 => cos.hi = 1.0,
            1.0 => sin.hi = 1.0,
            2.0 => cos.lo = -1.0,
            _ => sin.lo = -1.0,
        }
    }
    (clip(sin, -1.0, 1.0), clip(cos, -1.0, 1.0))
}

fn sin(x: f64) -> Interval {
    if x == 0.0 { Interval::ZERO } else { around(core_math::sin(x)) }
}

fn cos(x: f64) -> Interval {
    if x == 0.0 { Interval::ONE } else { around(core_math::cos(x)) }
}
