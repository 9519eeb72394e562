//! Slopes and chords of the shaping function over the region.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::document::{Certificate, Phi, Side};
use crate::verify::number::Number;

/// Which of the two rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rate {
    /// Between any two motions: slopes of tanh count.
    Contraction,
    /// Towards the reference: chords of tanh from 0 count.
    Convergence,
}

pub(super) const RATES: [(&str, Rate); 2] =
    [("contraction", Rate::Contraction), ("convergence", Rate::Convergence)];

/// The law of one side.
#[derive(Clone, Copy)]
pub(super) struct Law<'a> {
    pub phi: Phi,
    pub n: usize,
    pub metric: &'a [Number],
    shaping: &'a [Number],
    kappa: &'a [Number],
    /// The largest errors of this side.
    pub error: &'a [Option<Number>],
}

impl<'a> Law<'a> {
    pub(super) fn of(certificate: &'a Certificate, side: Side) -> Self {
        let gains = certificate.controller.gains(side);
        let n = certificate.robot.joints;
        let (link, motor) = certificate.region.error.split_at(n);
        Self {
            phi: certificate.controller.phi,
            n,
            metric: &gains.metric,
            shaping: &gains.shaping,
            kappa: &gains.kappa,
            error: if side == Side::Link { link } else { motor },
        }
    }

    /// The lower ends of the slopes, or chords, of tanh over the region. The upper ends are 1.
    pub(super) fn lower_ends(&self, rate: Rate) -> Vec<Interval> {
        let lower = |bound: &Option<Number>| match bound {
            None => Interval::ZERO,
            // Both decrease in the error: the largest counts.
            Some(bound) => {
                let largest = Interval::point(bound.value.hi());
                let end = match rate {
                    Rate::Contraction => slope(largest),
                    Rate::Convergence => largest.tanh() / largest,
                };
                Interval::point(end.lo().max(0.0))
            }
        };
        self.error.iter().map(lower).collect()
    }

    /// √weight · ∂φ_ij where tanh has the slope, or chord, `a` at e_j. The weight stands under the root of the gains'
    /// ratio, so that ratios that cancel do so exactly; on the diagonal it is 1.
    pub(super) fn entry(&self, i: usize, j: usize, a: Interval, weight: Interval) -> Interval {
        let gain = |k: usize| self.shaping[k].value;
        match self.phi {
            Phi::Tanh if i == j => gain(i) * a,
            Phi::Linear if i == j => gain(i),
            Phi::CoupledTanh if i == j => Interval::ONE + self.kappa[i].value,
            Phi::CoupledTanh => {
                let others = Interval::from_f64((self.n - 1) as f64);
                (weight * gain(j) / gain(i)).sqrt() * a / others
            }
            _ => Interval::ZERO,
        }
    }
}

/// sech² x.
pub(super) fn slope(x: Interval) -> Interval {
    // 1 − tanh² would lose digits.
    (Interval::from_f64(2.0) / (x.exp() + (-x).exp())).square()
}
