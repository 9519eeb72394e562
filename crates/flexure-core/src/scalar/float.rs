//! `f64` and `f32`: elementary functions from `libm`, the same bits on every platform.

use super::{Over, Piecewise, Scalar, leaf};

/// A plain number that code may decide on: what estimators and guards run on: `f64`, `f32` and
/// [`Tangent`](super::Tangent), on which the value decides.
pub trait Float: Piecewise + Over<Self> + PartialOrd {
    /// ∞.
    const INFINITY: Self;
    /// −∞.
    const NEG_INFINITY: Self;
    /// Not a number.
    const NAN: Self;

    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

macro_rules! float {
    ($t:ident, $from:expr, $sqrt:ident, $exp:ident, $ln:ident, $sincos:ident, $tanh:ident, $sinh:ident, $log1p:ident, $fabs:ident, $atan:ident) => {
        impl Scalar for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;

            #[inline]
            fn from_f64(x: f64) -> Self {
                $from(x)
            }
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }
            #[inline]
            fn exp(self) -> Self {
                libm::$exp(self)
            }
            #[inline]
            fn ln(self) -> Self {
                libm::$ln(self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                libm::$sincos(self)
            }
            #[inline]
            fn tanh(self) -> Self {
                libm::$tanh(self)
            }
            /// `ln(1 + 2 sinh² (x/2))` where `|x| < 1`, `|x| − ln 2 + ln(1 + e^(−2|x|))` beyond, which cannot overflow:
            /// neither cancels in its domain.
            #[inline]
            fn ln_cosh(self) -> Self {
                let a = libm::$fabs(self);
                if a < 1.0 {
                    let sinh = libm::$sinh(0.5 * a);
                    libm::$log1p(2.0 * sinh * sinh)
                } else {
                    (a - core::$t::consts::LN_2) + libm::$log1p(libm::$exp(-2.0 * a))
                }
            }
            #[inline]
            fn atan(self) -> Self {
                libm::$atan(self)
            }
        }

        impl Piecewise for $t {
            #[inline]
            fn select(self, then: Self, otherwise: Self) -> Self {
                if self >= 0.0 {
                    then
                } else if self < 0.0 {
                    otherwise
                } else {
                    self // NaN
                }
            }
            #[inline]
            fn select_of<R>(
                self,
                then: impl FnOnce() -> R,
                otherwise: impl FnOnce() -> R,
                merge: impl FnOnce(Self, R, R) -> R,
            ) -> R {
                if self >= 0.0 {
                    then()
                } else if self < 0.0 {
                    otherwise()
                } else {
                    merge(self, then(), otherwise())
                }
            }
            #[inline]
            fn lowest(self) -> f64 {
                self.into()
            }
            #[inline]
            fn highest(self) -> f64 {
                self.into()
            }
            // Comparing, not subtracting: ∞ − ∞ is not a number, yet equals itself.
            #[inline]
            fn min(self, other: Self) -> Self {
                if self <= other { self } else if other < self { other } else { self + other }
            }
            #[inline]
            fn max(self, other: Self) -> Self {
                if self >= other { self } else if other > self { other } else { self + other }
            }
        }

        impl Float for $t {
            const INFINITY: Self = Self::INFINITY;
            const NEG_INFINITY: Self = Self::NEG_INFINITY;
            const NAN: Self = Self::NAN;

            #[inline]
            fn is_finite(self) -> bool {
                Self::is_finite(self)
            }
        }

        leaf!([] $t);
    };
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to the narrower type is the documented meaning"
)]
#[inline]
fn narrow(x: f64) -> f32 {
    x as f32
}

float!(f64, core::convert::identity, sqrt, exp, log, sincos, tanh, sinh, log1p, fabs, atan);
float!(f32, narrow, sqrtf, expf, logf, sincosf, tanhf, sinhf, log1pf, fabsf, atanf);
