//! What the polynomials of the references are evaluated at.

use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// The number x that a polynomial over `T` is evaluated at: any `T`, or one that is known to be a straight line in time.
pub(super) trait Argument<T>: Copy {
    /// The nearest number in [0, 1].
    fn within_unit(self) -> Self;
    /// 1 − x.
    fn rest_to_one(self) -> Self;
    /// x.
    fn number(self) -> T;
    /// Σ_k c_k xᵏ.
    fn polynomial<const M: usize>(self, coefficients: &[f64; M]) -> T;
}

impl<T: Piecewise> Argument<T> for T {
    #[inline]
    fn within_unit(self) -> Self {
        self.clamp(T::ZERO, T::ONE)
    }
    #[inline]
    fn rest_to_one(self) -> Self {
        T::ONE - self
    }
    #[inline]
    fn number(self) -> T {
        self
    }
    #[inline]
    fn polynomial<const M: usize>(self, coefficients: &[f64; M]) -> T {
        coefficients.iter().rev().fold(T::ZERO, |sum, c| sum * self + T::from_f64(*c))
    }
}

/// x = a + b t, as a jet. A polynomial of it is a polynomial of t, whose Taylor coefficients take no products of jets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<S>(Jet<S, 2>);

impl<S: Over<S>> Line<S> {
    /// The [`fraction`] of its time that a motion has behind it at `t`, all in s.
    #[inline]
    pub(super) fn fraction(t: S, start: S, duration: S) -> Self {
        Self(fraction(Jet::variable(t), start, duration))
    }
}

impl<S: Piecewise, const K: usize> Argument<Jet<S, K>> for Line<S> {
    #[inline]
    fn within_unit(self) -> Self {
        Self(self.0.clamp(Jet::ZERO, Jet::ONE))
    }
    #[inline]
    fn rest_to_one(self) -> Self {
        Self(Jet::ONE - self.0)
    }
    #[inline]
    fn number(self) -> Jet<S, K> {
        Jet::from_fn(|k| self.0.coefficient(k))
    }
    /// By synthetic division, again and again: Horner's scheme for a + b t without the products that are 0.
    #[inline]
    fn polynomial<const M: usize>(self, coefficients: &[f64; M]) -> Jet<S, K> {
        let [value, rate] = [0, 1].map(|k| self.0.coefficient(k));
        let mut quotient = coefficients.map(S::from_f64);
        let mut power = S::ONE;
        Jet::from_fn(|k| {
            let mut above = S::ZERO;
            for coefficient in quotient.iter_mut().skip(k).rev() {
                above = above * value + *coefficient;
                *coefficient = above;
            }
            let coefficient = above * power;
            power *= rate;
            coefficient
        })
    }
}

/// (t − start) / duration.
#[inline]
pub(super) fn fraction<C: Scalar, T: Over<C>>(t: T, start: C, duration: C) -> T {
    (t - T::constant(start)).scale(duration.recip())
}
