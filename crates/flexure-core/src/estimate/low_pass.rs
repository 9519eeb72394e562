//! Difference quotients through a low pass, as one recursion.

use super::positive;
use crate::scalar::{Float, Over};

/// Differentiation and low pass in one filter: v_k = a₁ v_{k−1} + a₂ v_{k−2} + b₀ d_k + b₁ d_{k−1} with the increments
/// d_k = q_k − q_{k−1} of the position.
///
/// Both factors are discretised bilinearly, the low pass with its cut-off prewarped. A zero-order hold would be exact for
/// a piecewise constant input, which a position is not, and would delay the derivative by half a period; the trapezoidal
/// rule has no delay of its own, and its pole at z = −1 cancels against a zero of the low pass. The response is exactly
///
/// H(e^{jωT}) = j (2/T) tan(ωT/2) G(j Ω),   Ω = ω_c tan(ωT/2) / tan(ω_c T/2),
///
/// with G the low pass in continuous time: a constant velocity comes out as it is, and at the cut-off the low pass has
/// exactly the gain of G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass<C> {
    pub(super) feedback: [C; 2],
    pub(super) forward: [C; 2],
    pub(super) period: C,
}

impl<C: Float> LowPass<C> {
    /// G = ω_c / (s + ω_c): `cutoff` is the −3 dB point in Hz, `period` the sampling period in s.
    ///
    /// `None` unless both are positive and the cut-off is below half the sampling frequency.
    pub fn first_order(cutoff: C, period: C) -> Option<Self> {
        let tan = prewarped(cutoff, period)?;
        // (2/T) (z − 1) tan / ((z − 1) + tan (z + 1))
        let scale = (C::ONE + tan).recip();
        let two = C::ONE + C::ONE;
        Some(Self {
            feedback: [(C::ONE - tan) * scale, C::ZERO],
            forward: [two * tan * scale / period, C::ZERO],
            period,
        })
    }

    /// a₁, a₂, then b₀, b₁ [1/s].
    pub fn coefficients(&self) -> [[C; 2]; 2] {
        [self.feedback, self.forward]
    }

    /// The same filter over another number.
    pub fn over<T: Over<C>>(self) -> LowPass<T> {
        LowPass {
            feedback: self.feedback.map(T::constant),
            forward: self.forward.map(T::constant),
            period: T::constant(self.period),
        }
    }

    /// G = ω_c² / (s² + 2 ζ ω_c s + ω_c²): `cutoff` is the natural frequency ω_c / 2π in Hz, where the gain is 1 / (2 ζ);
    /// `damping` is ζ; `period` the sampling period in s. Makers of servo drives state it like this: 40 Hz, 0.9.
    ///
    /// `None` unless all are positive and the cut-off is below half the sampling frequency.
    pub fn second_order(cutoff: C, damping: C, period: C) -> Option<Self> {
        let tan = prewarped(cutoff, period)?;
        if !positive(damping) {
            return None;
        }
        // (2/T) (z − 1) (z + 1) tan² / ((z − 1)² + 2 ζ tan (z² − 1) + tan² (z + 1)²)
        let (two, square) = (C::ONE + C::ONE, tan.square());
        let middle = two * damping * tan;
        let scale = (C::ONE + middle + square).recip();
        let gain = two * square * scale / period;
        Some(Self {
            feedback: [two * (C::ONE - square) * scale, (middle - C::ONE - square) * scale],
            forward: [gain, gain],
            period,
        })
    }
}

/// tan(ω_c T / 2), if there is such a filter.
fn prewarped<C: Float>(cutoff: C, period: C) -> Option<C> {
    let turns = cutoff * period;
    let half = C::from_ratio(1, 2);
    if !(positive(cutoff) && positive(period) && turns < half) {
        return None;
    }
    let (sin, cos) = (turns * C::from_f64(core::f64::consts::PI)).sin_cos();
    let tan = sin / cos;
    positive(tan).then_some(tan)
}
