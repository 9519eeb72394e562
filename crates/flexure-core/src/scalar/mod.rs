//! The number tower: one trait, [`Scalar`], and the number types that physics and law are evaluated on.
//!
//! | number | running the code on it gives |
//! | --- | --- |
//! | `f64`, `f32` | simulation, control, firmware |
//! | [`Jet`] | exact time derivatives |
//! | [`Dual`] | Jacobians |
//! | [`Interval`] | bounds that hold in floating point |
//! | [`Lanes`] | batches |
//!
//! They nest: `Jet<Lanes<f64, 4>, 3>`, `Dual<Jet<Interval, 2>, 4>`.

mod dual;
mod float;
#[cfg(feature = "interval")]
mod interval;
mod jet;
#[cfg(feature = "lanes")]
mod lanes;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

pub use dual::{Dual, Tangent};
pub use float::Float;
#[cfg(feature = "interval")]
pub use interval::Interval;
pub use jet::Jet;
#[cfg(feature = "lanes")]
pub use lanes::{Lane, Lanes};

/// A number that physics and control laws are written over.
///
/// There is no ordering and no conversion back to `f64`: an interval cannot answer a comparison, lanes answer it
/// several ways, and derivatives would die in a conversion. Code that must choose uses [`Piecewise`].
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;

    /// The number `x`, exactly (rounded to nearest where the type is narrower than `f64`).
    fn from_f64(x: f64) -> Self;

    /// The rational `numerator / denominator`: enclosed by intervals, folded to a constant by the compiler on floats.
    #[inline]
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        Self::from_f64(f64::from(numerator)) / Self::from_f64(f64::from(denominator))
    }

    /// `x²`: tighter than `x * x` on intervals.
    #[inline]
    fn square(self) -> Self {
        self * self
    }

    /// `1 / x`.
    #[inline]
    fn recip(self) -> Self {
        Self::ONE / self
    }

    /// Square root.
    fn sqrt(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// `ln cosh x`, the integral of [`tanh`](Self::tanh) from 0, without overflow.
    fn ln_cosh(self) -> Self;
    /// Inverse tangent.
    fn atan(self) -> Self;

    /// Sine of an angle in rad.
    #[inline]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine of an angle in rad.
    #[inline]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
}

/// The second bound: numbers that extend a type `C` of constants.
///
/// Robots and gains hold constants of type `C`; states are of a type `S: Over<C>`. A jet over `f64` multiplied by an
/// `f64` costs K products instead of K (K + 1) / 2, and a robot never has to be converted to run on another number.
/// Every leaf type is over itself, and `Jet<S, K>` and `Dual<S, M>` are over whatever `S` is over.
pub trait Over<C>: Scalar {
    /// The constant `c` as a number of this type (all derivatives zero).
    fn constant(c: C) -> Self;
    /// `self · c`.
    fn scale(self, c: C) -> Self;
}

/// The companion for functions defined piece by piece. Smooth code does not need it.
///
/// Where the pieces meet, jets and duals take the derivative of the chosen piece and intervals the hull of both.
/// A NaN argument gives NaN: nothing is swallowed.
pub trait Piecewise: Scalar {
    /// `then` where `self ≥ 0`, `otherwise` where `self < 0`.
    fn select(self, then: Self, otherwise: Self) -> Self;

    /// `then()` where `self ≥ 0`, `otherwise()` where `self < 0`, for pieces that take time: a number that can tell asks for one of them.
    /// Of one that cannot `merge(self, then(), otherwise())` selects, entry by entry.
    #[inline]
    fn select_of<R>(
        self,
        then: impl FnOnce() -> R,
        otherwise: impl FnOnce() -> R,
        merge: impl FnOnce(Self, R, R) -> R,
    ) -> R {
        merge(self, then(), otherwise())
    }

    /// The least number that it may be, whatever its derivatives: to look pieces up by. NaN or not in it, where a number is none.
    fn lowest(self) -> f64;

    /// The largest.
    fn highest(self) -> f64;

    /// Absolute value.
    #[inline]
    fn abs(self) -> Self {
        self.select(self, -self)
    }

    /// The smaller of two numbers.
    #[inline]
    fn min(self, other: Self) -> Self {
        (other - self).select(self, other)
    }

    /// The larger of two numbers.
    #[inline]
    fn max(self, other: Self) -> Self {
        (self - other).select(self, other)
    }

    /// The nearest number in `[low, high]`; `low ≤ high` is the caller's duty.
    #[inline]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

/// Declares that a leaf number type is over itself.
macro_rules! leaf {
    ([$($generics:tt)*] $t:ty) => {
        impl<$($generics)*> $crate::scalar::Over<$t> for $t {
            #[inline]
            fn constant(c: $t) -> Self {
                c
            }
            #[inline]
            fn scale(self, c: $t) -> Self {
                self * c
            }
        }
    };
}

/// Implements the assigning operators and `Scalar`'s operator supertraits from `Add`, `Sub`, `Mul`.
macro_rules! assign_ops {
    ([$($generics:tt)*] $t:ty) => {
        impl<$($generics)*> core::ops::AddAssign for $t {
            #[inline]
            fn add_assign(&mut self, rhs: Self) {
                *self = *self + rhs;
            }
        }
        impl<$($generics)*> core::ops::SubAssign for $t {
            #[inline]
            fn sub_assign(&mut self, rhs: Self) {
                *self = *self - rhs;
            }
        }
        impl<$($generics)*> core::ops::MulAssign for $t {
            #[inline]
            fn mul_assign(&mut self, rhs: Self) {
                *self = *self * rhs;
            }
        }
    };
}

use {assign_ops, leaf};
