//! What an axis shows: the whole signal where that is legible, else its bulk, saying so.

use super::curve::Curve;

/// Bounds of an axis, `low < high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    pub(crate) fn span(self) -> f64 {
        self.high - self.low
    }

    pub(crate) fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Room on both sides, as a fraction of the span; a point becomes an interval of its own size.
    fn padded(self, fraction: f64) -> Self {
        let span = if self.span() > 0.0 { self.span() } else { self.high.abs().max(1e-3) };
        Self { low: self.low - fraction * span, high: self.high + fraction * span }
    }
}

/// A linear axis for `values`: everything, or 99 % of the samples where a few excursions would flatten all the rest.
pub(crate) struct Linear {
    pub range: Range,
    /// Whether some values lie outside.
    pub clipped: bool,
}

/// How much taller than its bulk a signal may be before the axis is cut.
const FLATTENED: f64 = 2.5;

impl Linear {
    /// Everything, whatever it does to the scale.
    pub(crate) fn whole(values: impl Iterator<Item = f64>) -> Range {
        let values = sorted(values);
        Range { low: quantile(&values, 0.0), high: quantile(&values, 1.0) }.padded(0.06)
    }

    pub(crate) fn of(values: &mut dyn Iterator<Item = f64>) -> Self {
        Self::but(0.005, 0.25, values)
    }

    /// The same for a run that diverged: what it did most of the time, not where it ended.
    pub(crate) fn of_diverged(values: &mut dyn Iterator<Item = f64>) -> Self {
        Self::but(0.15, 0.5, values)
    }

    /// Leaves this fraction of the samples out at either end, if that makes the rest legible, and leaves room around it.
    fn but(tail: f64, room: f64, values: impl Iterator<Item = f64>) -> Self {
        let values = sorted(values);
        let whole = Range { low: quantile(&values, 0.0), high: quantile(&values, 1.0) };
        let bulk = Range { low: quantile(&values, tail), high: quantile(&values, 1.0 - tail) };
        if whole.span() <= FLATTENED * bulk.span() || bulk.span() == 0.0 {
            Self { range: whole.padded(0.06), clipped: false }
        } else {
            Self { range: bulk.padded(room), clipped: true }
        }
    }
}

/// Exponents of ten for curves that carry exponents: the largest on top, the smallest percent cut.
pub(crate) fn decades(curves: &[Curve]) -> Range {
    const MOST: f64 = 40.0;
    // Zero has no exponent: `Curve::exponents` gives it that of the smallest f64.
    let zero = f64::MIN_POSITIVE.log10();
    let exponents =
        sorted(curves.iter().flat_map(|curve| curve.values.iter().copied()).filter(|&value| value > zero));
    if exponents.is_empty() {
        return Range { low: -1.0, high: 1.0 };
    }
    let high = quantile(&exponents, 1.0) + 0.25;
    let low = (quantile(&exponents, 0.01) - 0.25).max(high - MOST).floor();
    Range { low: low.min(high.floor() - 1.0), high }
}

/// Decades between labels so that at most seven fit.
pub(crate) fn decade_step(range: Range) -> f64 {
    [1.0, 2.0, 3.0, 5.0].into_iter().find(|step| range.span() <= 7.0 * step).unwrap_or(10.0)
}

/// A step of 1, 2 or 5 times a power of ten that gives at most `most` intervals.
pub(crate) fn round_step(range: Range, most: f64) -> f64 {
    let coarse = range.span() / most;
    let power = 10f64.powf(coarse.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * power).find(|&step| step >= coarse).unwrap_or(10.0 * power)
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// The sample at `fraction` of the way through `sorted`; 0 of nothing.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an index into a slice, from a fraction in [0, 1]"
)]
fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((fraction * last as f64).round() as usize).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::{Linear, decade_step, decades, round_step};
    use crate::report::draw::curve::Curve;
    use crate::report::draw::style::Stroke;

    #[test]
    fn a_short_spike_is_cut_and_a_sine_is_not() {
        let sine = || (0..10_000).map(|k| (f64::from(k) * 1e-3).sin());
        let plain = Linear::of(&mut sine());
        assert!(!plain.clipped && sine().all(|value| plain.range.contains(value)));
        let spiked = Linear::of(&mut sine().enumerate().map(|(k, value)| if k < 5 { 1e3 } else { value }));
        assert!(spiked.clipped && spiked.range.high < 2.0);
    }

    #[test]
    fn a_constant_and_nothing_still_have_an_axis() {
        for linear in [
            Linear::of(&mut [0.0; 5].into_iter()),
            Linear::of(&mut [3.0; 5].into_iter()),
            Linear::of(&mut std::iter::empty()),
        ] {
            assert!(linear.range.span() > 0.0);
        }
        let constant = |value| [Curve::new(&[0.0, 1.0], &[value; 2], Stroke::reference()).exponents(9)];
        assert!(decades(&[]).span() > 0.0 && decades(&constant(0.0)).span() > 0.0);
        assert!(decades(&constant(1e-9)).contains(-9.0));
    }

    #[test]
    fn steps_give_few_labels() {
        for exponent in -5..5 {
            let range = super::Range { low: 0.0, high: 3.3 * 10f64.powi(exponent) };
            let count = range.span() / round_step(range, 6.0);
            assert!((2.0..=6.0).contains(&count), "{count}");
        }
        let range = super::Range { low: -12.0, high: 3.0 };
        assert!(range.span() / decade_step(range) <= 7.0);
    }
}
