//! The polynomials that go from 0 to 1 and are at rest at both ends.

use super::argument::Argument;
use crate::linalg::Vector;
use crate::scalar::Piecewise;

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
        let [blended] = self.blend_all(&Vector([from]), &Vector([to]), tau).0;
        blended
    }

    /// [`blend`](Self::blend) of many numbers at once, at any argument.
    ///
    /// Beyond τ = ½ it counts from the other end: there the polynomial would cancel, its last derivative by five digits. Numbers
    /// that cannot tell the first half from the second see the hull of two enclosures of the same polynomial, not the polynomial at
    /// the hull of τ and 1 − τ, which would not know whether it goes up or down.
    #[inline]
    pub(super) fn blend_all<T: Piecewise, X: Argument<T>, const N: usize>(
        self,
        from: &Vector<T, N>,
        to: &Vector<T, N>,
        tau: X,
    ) -> Vector<T, N> {
        let tau = tau.within_unit();
        let remaining = tau.rest_to_one();
        let way = *to - *from;
        let is_early = remaining.number() - tau.number();
        is_early.select_of(
            || {
                let done = self.polynomial(tau);
                Vector::from_fn(|i| from[i] + way[i] * done)
            },
            || {
                let left = self.polynomial(remaining);
                Vector::from_fn(|i| to[i] - way[i] * left)
            },
            |is_early, early, late| Vector::from_fn(|i| is_early.select(early[i], late[i])),
        )
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
    fn antiderivative<T: Piecewise>(self, tau: T) -> T {
        match self {
            Self::Quintic => tau.polynomial(const { &integrated::<3, 7>() }),
            Self::Septic => tau.polynomial(const { &integrated::<4, 9>() }),
            Self::Nonic => tau.polynomial(const { &integrated::<5, 11>() }),
        }
    }

    /// The polynomial itself.
    #[inline]
    fn polynomial<T: Piecewise, X: Argument<T>>(self, tau: X) -> T {
        match self {
            Self::Quintic => tau.polynomial(const { &coefficients::<3, 6>() }),
            Self::Septic => tau.polynomial(const { &coefficients::<4, 8>() }),
            Self::Nonic => tau.polynomial(const { &coefficients::<5, 10>() }),
        }
    }
}

/// Coefficients of τᴹ Σ_k C(m+k, k) C(2m+1, m−k) (−τ)ᵏ, lowest order first, where M = m + 1 and D = 2 M.
#[expect(
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, where a wrong index is a build error"
)]
const fn coefficients<const M: usize, const D: usize>() -> [f64; D] {
    let m = M - 1;
    let mut c = [0.0; D];
    let mut k = 0;
    while k < M {
        let size = (binomial(m + k, k) * binomial(2 * m + 1, m - k)) as f64;
        c[M + k] = if k % 2 == 0 { size } else { -size };
        k += 1;
    }
    c
}

/// Coefficients of its integral, where D = 2 M + 1; binary fractions all of them, so exact.
#[expect(
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, where a wrong index is a build error"
)]
const fn integrated<const M: usize, const D: usize>() -> [f64; D] {
    let step = coefficients::<M, D>();
    let mut c = [0.0; D];
    let mut k = 1;
    while k < D {
        c[k] = step[k - 1] / k as f64;
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
