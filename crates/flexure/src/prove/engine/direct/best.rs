//! The best rate that can be proved, next to the best that samples allow.

use crate::progress::unwatched;
use crate::prove::engine::direct::bisection::{Proved, bisect};
use crate::prove::engine::direct::flow::Flow;
use crate::prove::engine::direct::samples;
use crate::prove::engine::direct::witness::{DirectWitness, NamedState, Sample};
use crate::prove::engine::verdict::{Undecided, Verdict};

/// A rate that holds over the region, and a state that no larger one survives.
#[derive(Clone, Debug, PartialEq)]
pub struct BestRate {
    /// β [1/s], proved.
    pub rate: f64,
    /// An upper bound of the rate at the weakest state that was seen [1/s], by intervals: the true rate is at most this.
    pub upper: f64,
    /// The state that has this upper bound.
    pub at: NamedState,
    /// Boxes looked at, attempts that failed included.
    pub boxes: usize,
}

/// What is left of the sampled rate, in the order of attempts.
const FACTORS: [f64; 13] = [
    1.0 - 1e-13,
    1.0 - 1e-12,
    1.0 - 1e-10,
    1.0 - 1e-8,
    1.0 - 1e-6,
    1.0 - 1e-4,
    1.0 - 1e-3,
    1.0 - 1e-2,
    0.9,
    0.75,
    0.5,
    0.25,
    0.1,
];

/// The largest rate that `budget` boxes prove, of a few just below the weakest that samples show.
///
/// Attempts share the budget: each has its part of what those before it left. Refuted where some state shows that W grows, or
/// does not shrink, in some direction.
pub fn best_rate(flow: &dyn Flow, budget: usize) -> Verdict<BestRate, DirectWitness> {
    let undecided = |at: String, spent| Verdict::Undecided(Undecided { at, spent });
    let Some(mut weakest) = samples::weakest(flow, &|| true) else {
        return undecided("the metric is positive definite at no sample".to_owned(), 0);
    };
    let Some((mut upper, _)) = weakest.bounds(flow, 0.0) else {
        return undecided(format!("no bound of the rate at {}", weakest.state(flow)), 0);
    };
    if let Some(witness) = weakest.refutes(flow, 0.0) {
        return Verdict::Refuted(witness);
    }
    let (mut spent, mut last) = (0, String::from("no budget"));
    for (done, factor) in FACTORS.iter().enumerate() {
        let end = spent + (budget - spent) / (FACTORS.len() - done);
        // A witness lowers what is possible: the same part of less.
        while spent < end && upper > 0.0 {
            let (verdict, boxes) = bisect(flow, upper * factor, end - spent, &unwatched);
            spent += boxes;
            match verdict {
                Verdict::Proved(Proved { rate, .. }) => {
                    return Verdict::Proved(BestRate { rate, upper, at: weakest.state(flow), boxes: spent });
                }
                Verdict::Refuted(witness) => {
                    let sample = Sample::new(flow, witness.at.values()).filter(|_| witness.rate < upper);
                    let Some(sample) = sample else { break };
                    (weakest, upper) = (sample, witness.rate);
                    if let Some(witness) = weakest.refutes(flow, 0.0) {
                        return Verdict::Refuted(witness);
                    }
                }
                Verdict::Undecided(Undecided { at, .. }) => {
                    last = at;
                    break;
                }
            }
        }
    }
    undecided(last, spent)
}
