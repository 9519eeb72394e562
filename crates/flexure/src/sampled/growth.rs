//! What the maps along a reference make of small errors one after the other.

use crate::laws::Controller;
use crate::linalg::{Dense, spectral_radius};
use crate::sampled::{Place, Probe, ROUNDING};

/// Errors that grow a thousandfold within so long in s are lost before the robot has moved on.
const MOMENT: f64 = 0.1;
const LOST: f64 = 1e3;

/// Links that are no farther from one place to the next stand, in rad.
const STANDS: f64 = 1e-9;

impl Probe<'_> {
    /// By what small errors grow a control period on the whole way along the reference, if less than 1 and the place `worst`, at which
    /// they grow with `law`, is one that the robot passes in time.
    pub(super) fn passed(&self, law: &Controller, worst: usize) -> Option<f64> {
        let period = self.scenario.control_period;
        let spot = &self.spots[worst];
        let grows = |radius: f64| (MOMENT / period) * radius.ln() > LOST.ln();
        if spot.place == Place::Start || grows(self.radius(spot, law)) {
            return None;
        }
        let way: Vec<_> = self.spots.iter().filter(|spot| spot.place == Place::Reference).collect();
        let cycle = f64::from(self.devices.cycle);
        let (mut product, mut log, mut cycles) = (None::<Dense<f64>>, 0.0, 0.0);
        for (i, spot) in way.iter().enumerate() {
            let radius = self.radius(spot, law);
            let [before, after] = [i.saturating_sub(1), (i + 1).min(way.len() - 1)].map(|k| way[k].time);
            let stands = || {
                [before, after]
                    .iter()
                    .any(|&t| (t - spot.time).abs() > 0.0 && self.moved(spot.time, t) < STANDS)
            };
            // A comparison with what is not a number is false.
            let passes = radius < 1.0 + ROUNDING || radius > 1.0 && !stands();
            if !passes {
                return None;
            }
            let count = (0.5 * (after - before) / (period * cycle)).round().clamp(1.0, 1e6);
            let (power, more) = power(&self.cycle(spot, law, &spot.around), whole(count));
            let (next, grown) = scaled(match product {
                None => power,
                Some(product) => &power * &product,
            });
            (product, log, cycles) = (Some(next), log + more + grown, cycles + count);
        }
        let growth = ((spectral_radius(&product?).ln() + log) / (cycles * cycle)).exp();
        (growth < 1.0).then_some(growth)
    }
}

/// A count as a whole number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 1e6")]
fn whole(count: f64) -> u32 {
    count as u32
}

/// A matrix to a power ≥ 1, and the logarithm of what it was divided by on the way: neither large nor small.
fn power(a: &Dense<f64>, mut exponent: u32) -> (Dense<f64>, f64) {
    let (mut square, mut square_log) = scaled(a.clone());
    let mut result: Option<(Dense<f64>, f64)> = None;
    loop {
        if exponent % 2 == 1 {
            result = Some(match result {
                None => (square.clone(), square_log),
                Some((product, log)) => {
                    let (product, more) = scaled(&square * &product);
                    (product, log + square_log + more)
                }
            });
        }
        exponent /= 2;
        if exponent == 0 {
            return result.expect("an odd part, as the power is at least 1");
        }
        let more;
        (square, more) = scaled(&square * &square);
        square_log = 2.0 * square_log + more;
    }
}

/// A matrix by its largest entry, and the logarithm of that.
fn scaled(a: Dense<f64>) -> (Dense<f64>, f64) {
    let largest = a.rows().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest > 0.0 { (a.scaled(1.0 / largest), largest.ln()) } else { (a, 0.0) }
}
