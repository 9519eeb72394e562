//! The largest rate for which matrices stay positive definite, and the decimal that claims it.

use flexure_core::scalar::Interval;

use crate::linalg::Symmetric;
use crate::prove::engine::number::Number;

/// A − β W has to be positive definite.
#[derive(Clone, Debug)]
pub struct Inequality {
    /// A: what the block dissipates.
    pub form: Symmetric<Interval>,
    /// W: the metric that the rate is relative to.
    pub weight: Symmetric<Interval>,
}

impl Inequality {
    /// Smallest pivot at the rate `beta`, from below.
    pub fn margin(&self, beta: Interval) -> f64 {
        self.form.minus(&self.weight, beta).smallest_pivot()
    }
}

/// A rate that is proved, with the margin that each inequality keeps at it.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimedRate {
    /// The largest rate β that was proved [1/s].
    pub rate: Number,
    /// Smallest pivots, one an inequality, positive.
    pub margins: Vec<f64>,
}

/// Rates are looked for in this range [1/s].
const SLOWEST: f64 = 1e-30;
const FASTEST: f64 = 1e30;

/// A rate that holds, and another not more than `tolerance` of it above that does not; none if no positive one does.
pub fn greatest(holds: impl Fn(f64) -> bool, tolerance: f64) -> Option<f64> {
    // Between a rate that holds and one that does not: by factors first, then by halves.
    let mut low = if holds(1.0) {
        1.0
    } else {
        std::iter::successors(Some(0.5), |beta| Some(0.5 * beta))
            .take_while(|&beta| beta > SLOWEST)
            .find(|&beta| holds(beta))?
    };
    let mut high = 2.0 * low;
    while holds(high) && high < FASTEST {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > tolerance * low {
        let middle = 0.5 * (low + high);
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    Some(low)
}

/// The largest rate at which all the inequalities hold, less `reserve` of it; none if no positive one can be shown.
pub fn largest(inequalities: &[Inequality], reserve: f64) -> Option<ClaimedRate> {
    let holds = |beta: f64| inequalities.iter().all(|one| one.margin(Interval::point(beta)) > 0.0);
    let low = greatest(holds, 0.1 * reserve)?;
    claim(low * (1.0 - reserve), inequalities, reserve)
}

/// The claim of the rate `beta`, or of one slightly below it, by `reserve` of it at first.
fn claim(beta: f64, inequalities: &[Inequality], reserve: f64) -> Option<ClaimedRate> {
    let below = std::iter::successors(Some(reserve), |step| Some(4.0 * step))
        .take_while(|&step| step < 1e7 * reserve);
    std::iter::once(0.0).chain(below).find_map(|step| {
        let rate = Number::rate(beta * (1.0 - step));
        let margins: Vec<f64> = inequalities.iter().map(|one| one.margin(rate.bounds())).collect();
        margins.iter().all(|&margin| margin > 0.0).then_some(ClaimedRate { rate, margins })
    })
}

#[cfg(test)]
mod tests {
    use super::{Inequality, Interval, Symmetric, largest};

    /// diag(4, 9) against diag(2, 3): the smaller ratio is 2.
    #[test]
    fn the_smallest_ratio_is_the_rate() {
        let diagonal = |d: [f64; 2]| {
            Symmetric::from_fn(2, |i, j| if i == j { Interval::point(d[i]) } else { Interval::point(0.0) })
        };
        let one = Inequality { form: diagonal([4.0, 9.0]), weight: diagonal([2.0, 3.0]) };
        let claim = largest(std::slice::from_ref(&one), 1e-13).unwrap();
        let rate = claim.rate.bounds();
        assert!(rate.hi() < 2.0 && rate.lo() > 2.0 * (1.0 - 1e-12), "{rate:?}");
        assert!(claim.margins[0] > 0.0);
        let none = Inequality { form: diagonal([4.0, -1.0]), ..one };
        assert!(largest(&[none], 1e-13).is_none());
    }
}
