//! Truncated Taylor series in time: exact time derivatives of any order, by arithmetic.
//!
//! Griewank & Walther, *Evaluating Derivatives*, 2nd ed., chapter 13.
#![expect(clippy::indexing_slicing, reason = "loops over the K coefficients; the no-panic check covers them")]

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Over, Piecewise, Scalar, assign_ops};
use crate::array::filled;

/// A truncated Taylor series: `K` coefficients, orders 0 to K − 1.
///
/// Coefficient `k` is `x⁽ᵏ⁾(t) / k!`. Every operation is exact to order K − 1.
///
/// ```
/// use flexure_core::scalar::{Jet, Scalar};
/// // sin t at t = 0 and its first three derivatives
/// let t = Jet::<f64, 4>::variable(0.0);
/// let s = t.sin();
/// assert_eq!([s.derivative(0), s.derivative(1), s.derivative(2), s.derivative(3)], [0.0, 1.0, 0.0, -1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S, const K: usize> {
    coefficients: [S; K],
}

impl<S: Scalar, const K: usize> Jet<S, K> {
    /// A jet from its Taylor coefficients `x⁽ᵏ⁾ / k!`.
    #[inline]
    pub const fn new(coefficients: [S; K]) -> Self {
        Self { coefficients }
    }

    /// The constant `x`.
    #[inline]
    pub fn value(x: S) -> Self {
        Self::from_fn(|k| if k == 0 { x } else { S::ZERO })
    }

    /// The independent variable at `t`: value `t`, first derivative 1.
    #[inline]
    pub fn variable(t: S) -> Self {
        Self::from_fn(|k| match k {
            0 => t,
            1 => S::ONE,
            _ => S::ZERO,
        })
    }

    /// A jet from its derivatives `x, ẋ, ẍ, …`.
    #[inline]
    pub fn from_derivatives(derivatives: [S; K]) -> Self {
        let mut factorial = 1;
        Self::from_fn(|k| {
            if k > 1 {
                factorial *= i32::try_from(k).unwrap_or(i32::MAX);
            }
            derivatives[k] * S::from_ratio(1, factorial)
        })
    }

    /// A jet whose coefficient `k` is `f(k)`.
    #[inline]
    pub fn from_fn(f: impl FnMut(usize) -> S) -> Self {
        Self { coefficients: filled(f) }
    }

    /// Taylor coefficient `k`, zero beyond the truncation order.
    #[inline]
    pub fn coefficient(&self, k: usize) -> S {
        self.coefficients.get(k).copied().unwrap_or(S::ZERO)
    }

    /// Time derivative of order `k`, zero beyond the truncation order.
    #[inline]
    pub fn derivative(&self, k: usize) -> S {
        let mut factorial = 1.0;
        for i in 2..=k {
            factorial *= i as f64;
        }
        self.coefficient(k) * S::from_f64(factorial)
    }

    /// The first `J ≤ K` coefficients.
    #[inline]
    pub fn truncate<const J: usize>(&self) -> Jet<S, J> {
        const { assert!(J <= K, "a jet cannot be truncated to a higher order") }
        Jet::from_fn(|k| self.coefficients[k])
    }

    /// The time derivative as a jet of `J < K` coefficients: differentiation costs one order.
    #[inline]
    pub fn differentiate<const J: usize>(&self) -> Jet<S, J> {
        const { assert!(J < K, "differentiation costs one order") }
        Jet::from_fn(|k| self.coefficients[k + 1] * S::from_f64((k + 1) as f64))
    }

    /// The second time derivative as a jet of `J < K − 1` coefficients.
    #[inline]
    pub fn differentiate_twice<const J: usize>(&self) -> Jet<S, J> {
        const { assert!(J + 1 < K, "differentiation costs one order each time") }
        Jet::from_fn(|k| self.coefficients[k + 2] * S::from_f64(((k + 1) * (k + 2)) as f64))
    }

    /// f(x(t)), where `self` is f as a series about x(t) and `x` is x(t): the chain rule of every order, by Horner's scheme.
    #[inline]
    pub fn compose(&self, x: &Self) -> Self {
        let change = Self::from_fn(|k| if k == 0 { S::ZERO } else { x.coefficients[k] });
        let mut sum = Self::ZERO;
        for &coefficient in self.coefficients.iter().rev() {
            sum = sum * change + Self::value(coefficient);
        }
        sum
    }

    /// Solves `y' = f x'` order by order, where `f` may depend on lower orders of `y`: the recurrence behind
    /// `exp`, `tanh`, … `f(k, y)` returns coefficient `k` of `f` given `y` up to order `k`.
    #[inline]
    fn integrate(&self, y0: S, mut f: impl FnMut(usize, &[S; K]) -> S) -> Self {
        let mut y = [S::ZERO; K];
        let mut df = [S::ZERO; K];
        if K > 0 {
            y[0] = y0;
        }
        for k in 1..K {
            df[k - 1] = f(k - 1, &y);
            let mut sum = S::ZERO;
            for j in 1..=k {
                sum += self.coefficients[j] * df[k - j] * S::from_ratio(narrow(j), narrow(k));
            }
            y[k] = sum;
        }
        Self { coefficients: y }
    }

    /// Sine and cosine of the series plus a constant, from those of order 0.
    #[inline]
    pub(crate) fn sin_cos_from(&self, sin: S, cos: S) -> (Self, Self) {
        let a = &self.coefficients;
        let (mut s, mut c) = ([S::ZERO; K], [S::ZERO; K]);
        for k in 0..K {
            if k == 0 {
                (s[0], c[0]) = (sin, cos);
            } else {
                let (mut ds, mut dc) = (S::ZERO, S::ZERO);
                for j in 1..=k {
                    let da = a[j] * S::from_ratio(narrow(j), narrow(k));
                    ds += da * c[k - j];
                    dc += da * s[k - j];
                }
                (s[k], c[k]) = (ds, -dc);
            }
        }
        (Self { coefficients: s }, Self { coefficients: c })
    }

    #[inline]
    fn head(&self) -> S {
        self.coefficient(0)
    }
}

/// Taylor orders are single digits.
#[inline]
fn narrow(k: usize) -> i32 {
    i32::try_from(k).unwrap_or(i32::MAX)
}

/// Coefficient `k` of the product of two series.
#[inline]
fn convolve<S: Scalar, const K: usize>(a: &[S; K], b: &[S; K], k: usize) -> S {
    let mut sum = a[0] * b[k];
    for i in 1..=k {
        sum += a[i] * b[k - i];
    }
    sum
}

impl<S: Scalar, const K: usize> Add for Jet<S, K> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        Self::from_fn(|k| self.coefficients[k] + rhs.coefficients[k])
    }
}

impl<S: Scalar, const K: usize> Sub for Jet<S, K> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        Self::from_fn(|k| self.coefficients[k] - rhs.coefficients[k])
    }
}

impl<S: Scalar, const K: usize> Neg for Jet<S, K> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::from_fn(|k| -self.coefficients[k])
    }
}

impl<S: Scalar, const K: usize> Mul for Jet<S, K> {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: Self) -> Self {
        Self::from_fn(|k| convolve(&self.coefficients, &rhs.coefficients, k))
    }
}

impl<S: Scalar, const K: usize> Div for Jet<S, K> {
    type Output = Self;
    #[inline]
    fn div(self, rhs: Self) -> Self {
        let mut quotient = [S::ZERO; K];
        for k in 0..K {
            let mut sum = self.coefficients[k];
            for j in 1..=k {
                sum -= rhs.coefficients[j] * quotient[k - j];
            }
            quotient[k] = sum / rhs.coefficients[0];
        }
        Self { coefficients: quotient }
    }
}

assign_ops!([S: Scalar, const K: usize] Jet<S, K>);

impl<C, S: Over<C>, const K: usize> Over<C> for Jet<S, K>
where
    C: Copy,
{
    #[inline]
    fn constant(c: C) -> Self {
        Self::value(S::constant(c))
    }
    #[inline]
    fn scale(self, c: C) -> Self {
        Self::from_fn(|k| self.coefficients[k].scale(c))
    }
}

impl<S: Scalar, const K: usize> Scalar for Jet<S, K> {
    const ZERO: Self = Self { coefficients: [S::ZERO; K] };
    const ONE: Self = {
        let mut coefficients = [S::ZERO; K];
        if K > 0 {
            coefficients[0] = S::ONE;
        }
        Self { coefficients }
    };

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::value(S::from_f64(x))
    }
    #[inline]
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        Self::value(S::from_ratio(numerator, denominator))
    }
    #[inline]
    fn square(self) -> Self {
        let a = &self.coefficients;
        Self::from_fn(|k| {
            let mut sum = if k % 2 == 0 { a[k / 2].square() } else { S::ZERO };
            for i in 0..k.div_ceil(2) {
                let product = a[i] * a[k - i];
                sum += product + product;
            }
            sum
        })
    }
    #[inline]
    fn sqrt(self) -> Self {
        let a = &self.coefficients;
        let mut r = [S::ZERO; K];
        for k in 0..K {
            r[k] = if k == 0 {
                a[0].sqrt()
            } else {
                let mut sum = a[k];
                for j in 1..k {
                    sum -= r[j] * r[k - j];
                }
                sum / (r[0] + r[0])
            };
        }
        Self { coefficients: r }
    }
    #[inline]
    fn exp(self) -> Self {
        self.integrate(self.head().exp(), |k, y| y[k])
    }
    #[inline]
    fn ln(self) -> Self {
        let reciprocal = self.recip();
        self.integrate(self.head().ln(), |k, _| reciprocal.coefficients[k])
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.head().sin_cos();
        self.sin_cos_from(sin, cos)
    }
    #[inline]
    fn tanh(self) -> Self {
        self.integrate(self.head().tanh(), |k, y| {
            let one = if k == 0 { S::ONE } else { S::ZERO };
            one - if k == 0 { y[0].square() } else { convolve(y, y, k) }
        })
    }
    #[inline]
    fn ln_cosh(self) -> Self {
        let tanh = self.tanh();
        self.integrate(self.head().ln_cosh(), |k, _| tanh.coefficients[k])
    }
    #[inline]
    fn atan(self) -> Self {
        let slope = (Self::ONE + self.square()).recip();
        self.integrate(self.head().atan(), |k, _| slope.coefficients[k])
    }
}

impl<S: Piecewise, const K: usize> Piecewise for Jet<S, K> {
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        let head = self.head();
        Self::from_fn(|k| head.select(then.coefficients[k], otherwise.coefficients[k]))
    }
    #[inline]
    fn select_of<R>(
        self,
        then: impl FnOnce() -> R,
        otherwise: impl FnOnce() -> R,
        merge: impl FnOnce(Self, R, R) -> R,
    ) -> R {
        self.head().select_of(then, otherwise, |_, then, otherwise| merge(self, then, otherwise))
    }
    #[inline]
    fn lowest(self) -> f64 {
        self.head().lowest()
    }
    #[inline]
    fn highest(self) -> f64 {
        self.head().highest()
    }
}
