//! A search for the smallest value of a function that is expensive, has no derivatives and may be cliffs.

use cobyla::{RhoBeg, minimize};
use rand_distr::{Distribution, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// A point and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct BestPoint {
    /// Where the cost is smallest of all points that were tried.
    pub at: Vec<f64>,
    /// Cost at the best point.
    pub cost: f64,
    /// Points that were tried.
    pub evaluations: usize,
}

/// First step of the local search, as a part of the half width.
const FIRST_STEP: f64 = 0.25;

/// The best of at most `budget` points within ±`half_width` of zero in each of `dimension` directions: zero itself first, a quarter
/// of the budget evenly along the first direction, a quarter at random around the best of those, and the rest by Powell's
/// COBYLA from the best so far. Random numbers come from `seed` alone.
///
/// `costs` gives those of several points at once, which it may look at side by side. A cost that is not a number counts as infinite. M. J. D. Powell, *A direct search optimization method that models the
/// objective and constraint functions by linear interpolation*, 1994.
///
/// # Panics
/// Unless `half_width` is a number above zero.
pub fn search(
    dimension: usize,
    half_width: f64,
    budget: usize,
    seed: u64,
    costs: &dyn Fn(&[Vec<f64>]) -> Vec<f64>,
) -> BestPoint {
    let finite = |points: &[Vec<f64>]| {
        let numbers = costs(points).into_iter();
        numbers.map(|cost| if cost.is_nan() { f64::INFINITY } else { cost }).collect::<Vec<_>>()
    };
    let origin = vec![0.0; dimension];
    let mut best = BestPoint { cost: f64::INFINITY, at: origin.clone(), evaluations: 0 };
    best.consider_all(std::slice::from_ref(&origin), &finite);
    let [_, along, scattered] = together(dimension, budget);
    let line = (0..along).map(|i| {
        let mut at = origin.clone();
        at[0] = half_width * (2.0 * (i as f64 + 0.5) / along as f64 - 1.0);
        at
    });
    best.consider_all(&line.collect::<Vec<_>>(), &finite);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let around =
        Uniform::new_inclusive(-0.5 * half_width, 0.5 * half_width).expect("a half width above zero");
    let center = best.at.clone();
    let points = (0..scattered).map(|_| {
        let step = |x: &f64| (x + around.sample(&mut random)).clamp(-half_width, half_width);
        center.iter().map(step).collect()
    });
    best.consider_all(&points.collect::<Vec<_>>(), &finite);
    let left = budget.saturating_sub(best.evaluations);
    if left == 0 || dimension == 0 {
        return best;
    }
    let start = best.at.clone();
    let tried = std::cell::RefCell::new(best);
    let objective = |x: &[f64], (): &mut ()| {
        let cost = finite(&[x.to_vec()])[0];
        tried.borrow_mut().consider(x, cost);
        // The method fits planes: infinity has none.
        cost.min(f64::MAX.sqrt())
    };
    let bounds = vec![(-half_width, half_width); dimension];
    let unconstrained: [fn(&[f64], &mut ()) -> f64; 0] = [];
    // However it ends, what counts is the best point that was seen.
    let _ = minimize(
        objective,
        &start,
        &bounds,
        &unconstrained,
        (),
        left,
        RhoBeg::All(FIRST_STEP * half_width),
        None,
    );
    tried.into_inner()
}

/// How many points a search asks for together: the first, those along the first direction, those at random. The rest come one by one.
pub(crate) fn together(dimension: usize, budget: usize) -> [usize; 3] {
    if dimension == 0 {
        return [1, 0, 0];
    }
    let along = budget / 4;
    [1, along, budget.div_ceil(2).saturating_sub(1 + along)]
}

/// Whether a search with this budget tries points at random.
pub fn has_random_points(budget: usize) -> bool {
    1 + budget / 4 < budget.div_ceil(2)
}

impl BestPoint {
    fn consider_all(&mut self, points: &[Vec<f64>], costs: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) {
        for (at, cost) in points.iter().zip(costs(points)) {
            self.consider(at, cost);
        }
    }

    fn consider(&mut self, at: &[f64], cost: f64) {
        self.evaluations += 1;
        if cost < self.cost {
            self.cost = cost;
            self.at = at.to_vec();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::search;

    fn each(cost: impl Fn(&[f64]) -> f64) -> impl Fn(&[Vec<f64>]) -> Vec<f64> {
        move |points| points.iter().map(|x| cost(x)).collect()
    }

    fn bowl(x: &[f64]) -> f64 {
        x.iter().zip([0.7, -1.1, 0.4]).map(|(x, c)| (x - c) * (x - c)).sum()
    }

    /// The bottom of a bowl, to a hundredth of the distance at the start; never more points than allowed.
    #[test]
    fn finds_the_bottom_of_a_bowl_within_the_budget() {
        let best = search(3, 2.0, 80, 1, &each(bowl));
        assert!(best.cost < 1e-4 * bowl(&[0.0; 3]), "{best:?}");
        assert!(best.evaluations <= 80);
        assert_eq!(best.cost.to_bits(), bowl(&best.at).to_bits());
    }

    /// Costs that are infinite or no numbers on most of the region neither stop the search nor win it.
    #[test]
    fn survives_cliffs() {
        let cliff = |x: &[f64]| {
            if x[0] > 1.0 {
                f64::NAN
            } else if x[1] > 0.5 {
                f64::INFINITY
            } else {
                bowl(x)
            }
        };
        let best = search(3, 2.0, 80, 1, &each(cliff));
        assert!(best.cost < 0.01, "{best:?}");
    }

    #[test]
    fn the_same_seed_finds_the_same_point() {
        assert_eq!(search(3, 2.0, 40, 7, &each(bowl)), search(3, 2.0, 40, 7, &each(bowl)));
        assert_ne!(search(3, 2.0, 20, 7, &each(bowl)).at, search(3, 2.0, 20, 8, &each(bowl)).at);
    }
}
