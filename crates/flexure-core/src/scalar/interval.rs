//! Outward-rounded intervals: bounds that hold in floating point.
//!
//! An [`Interval`] is a closed set of reals `[lo, hi]`, possibly unbounded, never NaN. Every operation returns a set that
//! contains the exact real result for all choices of reals in its arguments. This file and its two neighbours are the
//! trusted base of every proof, together with IEEE 754 arithmetic in round-to-nearest and core-math's correct rounding:
//!
//! * [`rounding`] encloses `+ − × ÷ √` of two floats. The exact rounding error says which side to step to, so exact
//!   results stay points.
//! * [`elementary`] encloses `sin`, `exp`, … by one step each way from a correctly rounded value.
//! * Here, the sets: which end points matter, by monotonicity alone.

mod decimal;
mod elementary;
mod rounding;

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Piecewise, Scalar, assign_ops, leaf};

/// A closed interval of reals with `f64` ends, rounded outwards: what a proof over a whole region computes with.
///
/// Where a function is not defined on part of the interval ([`ln`](Scalar::ln), [`sqrt`](Scalar::sqrt)) the result bounds
/// it on the rest; where it is defined nowhere, and for NaN, the result is [`ENTIRE`](Self::ENTIRE). An infinite end means
/// "no bound", and zero times unbounded is zero.
///
/// ```
/// use flexure_core::scalar::{Interval, Scalar};
/// let x = Interval::from_decimal("0.1").unwrap();
/// assert!(x.lo() < x.hi(), "one tenth is not a float");
/// let tilt = Interval::new(0.0, 2.0).unwrap();
/// assert_eq!(tilt.sin().hi(), 1.0); // π/2 lies inside
/// assert!((x / tilt) == Interval::ENTIRE);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    /// All reals: what is known when nothing is.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// `[lo, hi]`, or `None` unless `lo ≤ hi`.
    #[inline]
    pub fn new(lo: f64, hi: f64) -> Option<Self> {
        (lo <= hi).then_some(Self { lo, hi })
    }

    /// The single number `x`; everything if `x` is NaN.
    #[inline]
    pub const fn point(x: f64) -> Self {
        if x.is_nan() { Self::ENTIRE } else { Self { lo: x, hi: x } }
    }

    /// Lower end.
    #[inline]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// Upper end.
    #[inline]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// The smallest interval that contains both.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// What both contain, `None` where they are disjoint.
    #[inline]
    pub fn intersection(self, other: Self) -> Option<Self> {
        Self::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }

    /// Whether `x` lies inside.
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether all of `other` lies inside.
    #[inline]
    pub fn contains_interval(self, other: Self) -> bool {
        self.lo <= other.lo && other.hi <= self.hi
    }

    /// `hi − lo`, rounded up.
    #[inline]
    pub fn width(self) -> f64 {
        rounding::sum(self.hi, -self.lo).hi
    }

    /// A finite number inside, half way within rounding; 0 for [`ENTIRE`](Self::ENTIRE).
    #[inline]
    pub fn midpoint(self) -> f64 {
        // Halving before adding cannot overflow. Rounding may leave the interval: back to its ends.
        let middle = 0.5 * self.lo.max(f64::MIN) + 0.5 * self.hi.min(f64::MAX);
        middle.max(self.lo).min(self.hi).clamp(f64::MIN, f64::MAX)
    }

    /// The largest absolute value inside.
    #[inline]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest absolute value inside.
    #[inline]
    fn mignitude(self) -> f64 {
        // At most one of lo, −hi is positive; neither where 0 lies inside.
        self.lo.max(-self.hi).max(0.0)
    }

    /// Both halves, sharing the [`midpoint`](Self::midpoint).
    #[inline]
    pub fn split(self) -> (Self, Self) {
        let middle = self.midpoint();
        (Self { lo: self.lo, hi: middle }, Self { lo: middle, hi: self.hi })
    }

    /// `[lower.lo, upper.hi]`: the range of an increasing function from enclosures of its values at both ends.
    #[inline]
    fn between(lower: Self, upper: Self) -> Self {
        Self { lo: lower.lo, hi: upper.hi }
    }

    /// The range of an increasing function from the enclosure of its value at a float.
    #[inline]
    fn increasing(self, f: impl Fn(f64) -> Self) -> Self {
        let lower = f(self.lo);
        Self::between(lower, if self.lo < self.hi { f(self.hi) } else { lower })
    }
}

/// The sum increases in both arguments. It stays a function: where it is not, programs are an eighth larger and a tenth slower.
impl Add for Interval {
    type Output = Self;
    #[inline(never)]
    fn add(self, rhs: Self) -> Self {
        Self::between(rounding::sum(self.lo, rhs.lo), rounding::sum(self.hi, rhs.hi))
    }
}

/// `x − y = x + (−y)`, and negation is exact.
impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

/// Exact.
impl Neg for Interval {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

/// The product is monotone in each argument separately: its extremes are products of ends, the signs say which.
impl Mul for Interval {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: Self) -> Self {
        let (a, b) = (self, rhs);
        if a.magnitude() == 0.0 || b.magnitude() == 0.0 {
            return Self::ZERO;
        }
        // Ends of one sign, not both 0: negating gives a positive upper end.
        if a.hi <= 0.0 {
            return -((-a) * b);
        }
        if b.hi <= 0.0 {
            return -(a * -b);
        }
        // Both have positive parts now. Where a reaches below 0, b's largest value goes with a's smallest.
        let upper = rounding::product(a.hi, b.hi);
        match (a.lo < 0.0, b.lo < 0.0) {
            (false, false) => Self::between(rounding::product(a.lo, b.lo), upper),
            (true, false) => Self::between(rounding::product(a.lo, b.hi), upper),
            (false, true) => Self::between(rounding::product(a.hi, b.lo), upper),
            (true, true) => Self {
                lo: rounding::product(a.lo, b.hi).lo.min(rounding::product(a.hi, b.lo).lo),
                hi: upper.hi.max(rounding::product(a.lo, b.lo).hi),
            },
        }
    }
}

/// Everything where the divisor contains 0; otherwise monotone in each argument separately.
impl Div for Interval {
    type Output = Self;
    #[inline]
    fn div(self, rhs: Self) -> Self {
        let (a, b) = (self, rhs);
        if b.hi < 0.0 {
            return -(a / -b);
        }
        if b.lo <= 0.0 {
            return Self::ENTIRE;
        }
        // A positive divisor: the least quotient has the numerator's lower end over whichever end makes it least.
        let lower = rounding::quotient(a.lo, if a.lo < 0.0 { b.lo } else { b.hi });
        let upper = rounding::quotient(a.hi, if a.hi < 0.0 { b.hi } else { b.lo });
        Self::between(lower, upper)
    }
}

assign_ops!([] Interval);
leaf!([] Interval);

impl Scalar for Interval {
    const ZERO: Self = Self { lo: 0.0, hi: 0.0 };
    const ONE: Self = Self { lo: 1.0, hi: 1.0 };

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::point(x)
    }
    /// The square increases in `|x|`.
    #[inline]
    fn square(self) -> Self {
        let (small, large) = (self.mignitude(), self.magnitude());
        Self::between(rounding::product(small, small), rounding::product(large, large))
    }
    /// Bounds `√x` on the part with `x ≥ 0`; everything where there is none.
    #[inline]
    fn sqrt(self) -> Self {
        if self.hi < 0.0 {
            return Self::ENTIRE;
        }
        Self { lo: self.lo.max(0.0), hi: self.hi }.increasing(rounding::root)
    }
    #[inline]
    fn exp(self) -> Self {
        self.increasing(elementary::exp)
    }
    /// Bounds `ln x` on the part with `x > 0` (no lower bound if that reaches 0); everything where there is none.
    #[inline]
    fn ln(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ENTIRE;
        }
        Self { lo: self.lo.max(0.0), hi: self.hi }.increasing(elementary::ln)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        self.increasing(elementary::tanh)
    }
    /// `ln cosh` is even and increases in `|x|`; at most 16 ulp wide on a point, below 1.
    #[inline]
    fn ln_cosh(self) -> Self {
        Self { lo: self.mignitude(), hi: self.magnitude() }.increasing(elementary::ln_cosh)
    }
    #[inline]
    fn atan(self) -> Self {
        self.increasing(elementary::atan)
    }
}

/// Where the sign is not known, both pieces count.
impl Piecewise for Interval {
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        if self.lo >= 0.0 {
            then
        } else if self.hi < 0.0 {
            otherwise
        } else {
            then.hull(otherwise)
        }
    }
    #[inline]
    fn lowest(self) -> f64 {
        self.lo
    }
    #[inline]
    fn highest(self) -> f64 {
        self.hi
    }
    #[inline]
    fn abs(self) -> Self {
        Self { lo: self.mignitude(), hi: self.magnitude() }
    }
    /// Increases in both arguments.
    #[inline]
    fn min(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
    }
    /// Increases in both arguments.
    #[inline]
    fn max(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }
}
