//! What a stretched metric of one joint does to its inequality.

use crate::control::{Metric, Shaping};
use crate::linalg::Vector;
use crate::scalar::{Dual, Over, Piecewise, Scalar};

use super::Stretch;

/// The link, or the motor, of one joint under v-CBC, its position error x measured by P(x) = Π(x) r(x)² while its velocity error moves it by
/// at most `drift`: ẋ = −φ(x) + d, |d| ≤ drift.
///
/// On a link d = s_l, on a motor d = s_m − Π_m⁻¹ K s_l.
#[derive(Clone, Copy, Debug)]
pub struct StretchedSide<'a, C, P> {
    /// Π, the metric of the law [N m/rad].
    pub metric: Metric<C, 1>,
    /// φ.
    pub shaping: &'a P,
    /// r.
    pub stretch: Stretch<C>,
    /// Largest |d| [rad/s].
    pub drift: C,
}

/// What is left of a joint's inequality at one error.
#[derive(Clone, Copy, Debug)]
pub struct Stretched<T> {
    /// a = φ' + (φ − drift) P'/2P [1/s]: √P |δx| alone shrinks at this rate, whichever way the error drifts.
    pub rate: T,
    /// (P − Π)²/P [N m/rad]: how far off the metric is from the one in which the coupling with momenta cancels.
    pub mismatch: T,
}

impl<C: Scalar, P: Shaping<C, 1>> StretchedSide<'_, C, P> {
    /// At the error `x` ≥ 0 in rad; the same at −x, since φ is odd and Π and r are even.
    #[inline]
    pub fn at<T: Over<C> + Piecewise>(&self, x: T) -> Stretched<T> {
        let x = Dual::<T, 1>::variable(x, 0);
        let [own] = self.metric.at(&Vector([x])).0;
        let [phi] = self.shaping.eval(&Vector([x])).0;
        let stretch = self.stretch.at(x);
        let metric = own * stretch.square();
        let growth = metric.gradient[0] / (metric.value + metric.value);
        Stretched {
            rate: phi.gradient[0] + growth * (phi.value - T::constant(self.drift)),
            // (P − Π)²/P = Π (r − 1/r)².
            mismatch: own.value * (stretch.value - stretch.value.recip()).square(),
        }
    }
}
