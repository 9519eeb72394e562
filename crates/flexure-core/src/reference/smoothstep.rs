//! The polynomials that go from 0 to 1 and are at rest at both ends.

use crate::scalar::{Piecewise, Scalar};

/// The polynomial s of degree 2m + 1 with s(0) = 0, s(1) = 1 and m zero derivatives at both ends.
///
/// s(τ) = τᵐ⁺¹ Σ_k C(m+k, k) C(2m+1, m−k) (−τ)ᵏ, held at 0 before τ = 0 and at 1 after τ = 1, where it is Cᵐ.
/// It obeys s(τ) + s(1 − τ) = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothstep {
    /// Degree 5, m = 2: continuous acceleration, the minimum-jerk motion. Not smooth enough for the laws on flexible
    /// joints, whose torque has the fourth derivative in it.
    Quintic,
    /// Degree 7, m = 3: continuous jerk, so a bounded motor torque with steps at both ends.
    Septic,
    /// Degree 9, m = 4: continuous fourth derivative, so a continuous motor torque.
    Nonic,
}

impl Smoothstep {
    /// m, the number of derivatives that are zero at both ends, and up to which the step is continuous.
    #[inline]
    pub const fn smoothness(self) -> usize {
        match self {
            Self::Quintic => 2,
            Self::Septic => 3,
            Self::Nonic => 4,
        }
    }

    /// s(τ), for any τ: from 0 to 1.
    #[inline]
    pub fn eval<T: Piecewise>(self, tau: T) -> T {
        self.blend(T::ZERO, T::ONE, tau)
    }

    /// from + s(τ) (to − from), for any τ: exactly `from` up to τ = 0 and exactly `to` from τ = 1 on, with all
    /// derivatives up to order m.
    #[inline]
    pub fn blend<T: Piecewise>(self, from: T, to: T, tau: T) -> T {
        self.at(tau).between(from, to)
    }

    /// How far the step is at τ, for any τ: to blend many numbers at once.
    ///
    /// Beyond τ = ½ it counts from the other end: there the polynomial would cancel, its last derivative by five
    /// digits.
    #[inline]
    pub fn at<T: Piecewise>(self, tau: T) -> Progress<T> {
        let tau = tau.clamp(T::ZERO, T::ONE);
        let remaining = T::ONE - tau;
        Progress { done: self.polynomial(tau), left: self.polynomial(remaining), early: remaining - tau }
    }

    /// ∫ s from 0 to τ, for any τ: 0 up to τ = 0, exactly τ − ½ from τ = 1 on.
    ///
    /// Beyond τ = ½ it counts from the other end, by s(τ) + s(1 − τ) = 1.
    #[inline]
    pub fn integral<T: Piecewise>(self, tau: T) -> T {
        let inside = tau.clamp(T::ZERO, T::ONE);
        let remaining = T::ONE - inside;
        let late = tau - T::from_f64(0.5) + self.antiderivative(remaining);
        (remaining - inside).select(self.antiderivative(inside), late)
    }

    /// ∫ s from 0 to τ, for τ from 0 to 1.
    #[inline]
    fn antiderivative<T: Scalar>(self, tau: T) -> T {
        let quotient = match self {
            Self::Quintic => horner(const { &integrated::<3>() }, tau),
            Self::Septic => horner(const { &integrated::<4>() }, tau),
            Self::Nonic => horner(const { &integrated::<5>() }, tau),
        };
        quotient * tau
    }

    /// The polynomial itself.
    #[inline]
    fn polynomial<T: Scalar>(self, tau: T) -> T {
        match self {
            Self::Quintic => horner(const { &coefficients::<3>() }, tau),
            Self::Septic => horner(const { &coefficients::<4>() }, tau),
            Self::Nonic => horner(const { &coefficients::<5>() }, tau),
        }
    }
}

/// Where a step is: s(τ) and s(1 − τ).
///
/// Numbers that cannot tell the first half from the second see the hull of two enclosures of the same polynomial, not the
/// polynomial at the hull of τ and 1 − τ, which would not know whether it goes up or down.
#[derive(Clone, Copy, Debug)]
pub struct Progress<T> {
    done: T,
    left: T,
    /// 1 − 2τ: not negative in the first half.
    early: T,
}

impl<T: Piecewise> Progress<T> {
    /// from + s(τ) (to − from), for any `from` and `to` of one unit.
    #[inline]
    pub fn between(&self, from: T, to: T) -> T {
        let way = to - from;
        self.early.select(from + way * self.done, to - way * self.left)
    }
}

/// τᴹ Σ_k c_k (−τ)ᵏ.
#[inline]
fn horner<T: Scalar, const M: usize>(coefficients: &[f64; M], tau: T) -> T {
    let mut sum = T::ZERO;
    for &c in coefficients.iter().rev() {
        sum = T::from_f64(c) - sum * tau;
    }
    for _ in 0..M {
        sum *= tau;
    }
    sum
}

/// C(m+k, k) C(2m+1, m−k) for k = 0 … m, where M = m + 1.
#[expect(
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, where a wrong index is a build error"
)]
const fn coefficients<const M: usize>() -> [f64; M] {
    let m = M - 1;
    let mut c = [0.0; M];
    let mut k = 0;
    while k < M {
        c[k] = (binomial(m + k, k) * binomial(2 * m + 1, m - k)) as f64;
        k += 1;
    }
    c
}

/// The [`coefficients`] over the exponents of their integrals, M + 1 + k; binary fractions all of them, so exact.
#[expect(
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, where a wrong index is a build error"
)]
const fn integrated<const M: usize>() -> [f64; M] {
    let mut c = coefficients::<M>();
    let mut k = 0;
    while k < M {
        c[k] /= (M + 1 + k) as f64;
        k += 1;
    }
    c
}

/// C(n, k).
const fn binomial(n: usize, k: usize) -> usize {
    let mut product = 1;
    let mut i = 0;
    while i < k {
        // C(n, i + 1) = C(n, i) (n − i) / (i + 1), an integer.
        product = product * (n - i) / (i + 1);
        i += 1;
    }
    product
}
