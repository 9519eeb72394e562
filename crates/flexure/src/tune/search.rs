//! A search for the smallest value of a function that is expensive, has no derivatives and may be cliffs.

use std::cell::RefCell;
use std::iter;

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

/// The best of at most `budget` points within ±`half_width` of zero in each of `dimension` directions: zero itself and a quarter
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
    let mut search = Search::new(dimension, half_width, budget, seed);
    let first = search.first();
    search.consider_all(&first, &costs(&first));
    let scattered = search.scattered();
    search.consider_all(&scattered, &costs(&scattered));
    search.local(|x| costs(&[x.to_vec()])[0])
}

/// A search as [`search`] does it, part by part: several of them may go on side by side.
#[derive(Clone, Debug)]
pub(super) struct Search {
    half_width: f64,
    budget: usize,
    seed: u64,
    best: BestPoint,
}

impl Search {
    /// One that has seen nothing yet.
    pub(super) fn new(dimension: usize, half_width: f64, budget: usize, seed: u64) -> Self {
        let best = BestPoint { cost: f64::INFINITY, at: vec![0.0; dimension], evaluations: 0 };
        Self { half_width, budget, seed, best }
    }

    /// Points to look at before anything is known: zero, and those along the first direction.
    pub(super) fn first(&self) -> Vec<Vec<f64>> {
        let origin = vec![0.0; self.best.at.len()];
        let along = along(origin.len(), self.budget);
        let line = (0..along).map(|i| {
            let mut at = origin.clone();
            at[0] = self.half_width * (2.0 * (i as f64 + 0.5) / along as f64 - 1.0);
            at
        });
        iter::once(origin.clone()).chain(line).collect()
    }

    /// Points at random around the best so far.
    ///
    /// # Panics
    /// Unless the half width is a number above zero.
    pub(super) fn scattered(&self) -> Vec<Vec<f64>> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed);
        let half = 0.5 * self.half_width;
        let around = Uniform::new_inclusive(-half, half).expect("a half width above zero");
        let [_, scattered] = together(self.best.at.len(), self.budget);
        let point = |_| {
            let step = |x: &f64| (x + around.sample(&mut random)).clamp(-self.half_width, self.half_width);
            self.best.at.iter().map(step).collect()
        };
        (0..scattered).map(point).collect()
    }

    /// Takes in what `points` cost.
    pub(super) fn consider_all(&mut self, points: &[Vec<f64>], costs: &[f64]) {
        for (at, cost) in points.iter().zip(costs) {
            self.best.consider(at, *cost);
        }
    }

    /// The best point after the rest of the budget, spent one point after the other from the best so far.
    pub(super) fn local(self, mut cost: impl FnMut(&[f64]) -> f64) -> BestPoint {
        let Self { half_width, budget, best, .. } = self;
        let dimension = best.at.len();
        let left = budget.saturating_sub(best.evaluations);
        if left == 0 || dimension == 0 {
            return best;
        }
        let start = best.at.clone();
        let state = RefCell::new((best, &mut cost));
        let objective = |x: &[f64], (): &mut ()| {
            let (best, cost) = &mut *state.borrow_mut();
            let cost = best.consider(x, cost(x));
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
        state.into_inner().0
    }
}

/// How many points lie along the first direction.
fn along(dimension: usize, budget: usize) -> usize {
    if dimension == 0 { 0 } else { budget / 4 }
}

/// How many points a search asks for together: at first, and at random. The rest come one by one.
pub(crate) fn together(dimension: usize, budget: usize) -> [usize; 2] {
    let first = 1 + along(dimension, budget);
    [first, if dimension == 0 { 0 } else { budget.div_ceil(2).saturating_sub(first) }]
}

/// Whether a search with this budget tries points at random.
pub fn has_random_points(budget: usize) -> bool {
    1 + budget / 4 < budget.div_ceil(2)
}

impl BestPoint {
    /// Takes in a point; gives its cost, infinite where it is not a number.
    fn consider(&mut self, at: &[f64], cost: f64) -> f64 {
        let cost = if cost.is_nan() { f64::INFINITY } else { cost };
        self.evaluations += 1;
        if cost < self.cost {
            self.cost = cost;
            self.at = at.to_vec();
        }
        cost
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
