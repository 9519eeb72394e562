//! Dual numbers: a value and its gradient with respect to `M` variables.
//!
//! [`Tangent`], a value with one derivative, is a [`Float`] too: estimators run on it as they are and say how what they
//! remember and estimate moves with what they read.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Float, Over, Piecewise, Scalar, assign_ops, leaf};
use crate::array::{filled, mapped};

/// A value and its `M` partial derivatives: running code on it gives the exact Jacobian.
///
/// ```
/// use flexure_core::scalar::{Dual, Scalar};
/// let x = Dual::<f64, 2>::variable(3.0, 0);
/// let y = Dual::<f64, 2>::variable(2.0, 1);
/// let z = x * x * y;
/// assert_eq!((z.value, z.gradient), (18.0, [12.0, 9.0]));
/// ```
///
/// Ordered as numbers with infinitesimal parts: by value, equal values by gradient.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Dual<S, const M: usize> {
    /// The value of the function.
    pub value: S,
    /// Partial derivatives of the value.
    pub gradient: [S; M],
}

impl<S: Scalar, const M: usize> Dual<S, M> {
    /// The constant `value`: zero gradient.
    #[inline]
    pub const fn constant(value: S) -> Self {
        Self { value, gradient: [S::ZERO; M] }
    }

    /// Variable number `index` at `value`: its gradient is the unit vector `index`.
    #[inline]
    pub fn variable(value: S, index: usize) -> Self {
        Self { value, gradient: filled(|j| if j == index { S::ONE } else { S::ZERO }) }
    }

    /// `f(self)` from `f` and `f'` at the value.
    #[inline]
    fn chain(self, f: S, slope: S) -> Self {
        Self { value: f, gradient: mapped(&self.gradient, |g| g * slope) }
    }

    #[inline]
    fn zip(self, rhs: Self, value: S, f: impl Fn(S, S) -> S) -> Self {
        let mut gradient = self.gradient;
        for (g, h) in gradient.iter_mut().zip(rhs.gradient) {
            *g = f(*g, h);
        }
        Self { value, gradient }
    }
}

impl<S: Scalar, const M: usize> Add for Dual<S, M> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        self.zip(rhs, self.value + rhs.value, |a, b| a + b)
    }
}

impl<S: Scalar, const M: usize> Sub for Dual<S, M> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        self.zip(rhs, self.value - rhs.value, |a, b| a - b)
    }
}

impl<S: Scalar, const M: usize> Neg for Dual<S, M> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, gradient: mapped(&self.gradient, |g| -g) }
    }
}

impl<S: Scalar, const M: usize> Mul for Dual<S, M> {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: Self) -> Self {
        self.zip(rhs, self.value * rhs.value, |a, b| a * rhs.value + self.value * b)
    }
}

impl<S: Scalar, const M: usize> Div for Dual<S, M> {
    type Output = Self;
    #[inline]
    fn div(self, rhs: Self) -> Self {
        let quotient = self.value / rhs.value;
        let reciprocal = rhs.value.recip();
        self.zip(rhs, quotient, |a, b| (a - quotient * b) * reciprocal)
    }
}

assign_ops!([S: Scalar, const M: usize] Dual<S, M>);

impl<C: Copy, S: Over<C>, const M: usize> Over<C> for Dual<S, M> {
    #[inline]
    fn constant(c: C) -> Self {
        Self::constant(S::constant(c))
    }
    #[inline]
    fn scale(self, c: C) -> Self {
        Self { value: self.value.scale(c), gradient: mapped(&self.gradient, |g| g.scale(c)) }
    }
}

impl<S: Scalar, const M: usize> Scalar for Dual<S, M> {
    const ZERO: Self = Self::constant(S::ZERO);
    const ONE: Self = Self::constant(S::ONE);

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::constant(S::from_f64(x))
    }
    #[inline]
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        Self::constant(S::from_ratio(numerator, denominator))
    }
    #[inline]
    fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }
    #[inline]
    fn recip(self) -> Self {
        let r = self.value.recip();
        self.chain(r, -r.square())
    }
    #[inline]
    fn sqrt(self) -> Self {
        let r = self.value.sqrt();
        self.chain(r, (r + r).recip())
    }
    #[inline]
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    #[inline]
    fn tanh(self) -> Self {
        let t = self.value.tanh();
        self.chain(t, S::ONE - t.square())
    }
    #[inline]
    fn ln_cosh(self) -> Self {
        self.chain(self.value.ln_cosh(), self.value.tanh())
    }
    #[inline]
    fn atan(self) -> Self {
        self.chain(self.value.atan(), (S::ONE + self.value.square()).recip())
    }
}

impl<S: Piecewise, const M: usize> Piecewise for Dual<S, M> {
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        then.zip(otherwise, self.value.select(then.value, otherwise.value), |a, b| self.value.select(a, b))
    }
    #[inline]
    fn select_of<R>(
        self,
        then: impl FnOnce() -> R,
        otherwise: impl FnOnce() -> R,
        merge: impl FnOnce(Self, R, R) -> R,
    ) -> R {
        self.value.select_of(then, otherwise, |_, then, otherwise| merge(self, then, otherwise))
    }
    #[inline]
    fn lowest(self) -> f64 {
        self.value.lowest()
    }
    #[inline]
    fn highest(self) -> f64 {
        self.value.highest()
    }
}

/// A value and its derivative in one direction.
pub type Tangent = Dual<f64, 1>;

leaf!([] Tangent);

impl Float for Tangent {
    const INFINITY: Self = Self { value: f64::INFINITY, gradient: [0.0] };
    const NEG_INFINITY: Self = Self { value: f64::NEG_INFINITY, gradient: [0.0] };
    const NAN: Self = Self { value: f64::NAN, gradient: [f64::NAN] };

    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.gradient[0].is_finite()
    }
}
