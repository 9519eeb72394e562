//! Gains from a specification: what is behind `flexure tune`.
//!
//! Gains follow from a few numbers (`family.rs`): how fast the loop is, and, of v-CBC, the scale of either metric; shaping and damping
//! are then what the speed asks for, and at least what proves the rate that is wanted (`least.rs`, closed form). A search moves these
//! numbers. Gains are good that keep every constraint (`constraint.rs`): the sampled loop stable, with its delays and with what it
//! shall bear; torque, speed, deflection and error of a run with every imperfection of the scenario inside their limits; no instant at
//! a torque limit. Of those the ones are best that track best without chatter, or that prove the largest rate.
//!
//! The search begins with the sampled loop alone, which costs no run: for each speed the metric of the motors at which small errors
//! shrink fastest. Then the loop is run at each speed, and what follows moves all numbers from the best of these. Everything follows
//! from scenario, SPEC, budget and seed, on any number of threads.

mod bench;
mod constraint;
mod evidence;
mod family;
mod least;
mod spec;
mod specified;
mod trade;

use std::cell::{Cell, RefCell};

use rayon::prelude::*;

use crate::design::bench::{Bench, Outlooks, Trial};
use crate::design::family::{Family, Pace};
use crate::files::{Problem, Problems};
use crate::laws::Controller;
use crate::progress::{Progress, tell};
use crate::tune::search;

pub use constraint::{Constraint, Kind};
pub use evidence::{Design, Evidence, Feasible, design};
pub use spec::{AskedMargins, Rate, Spec, SpecFile, Uncertainty};
pub use specified::Specified;
pub use trade::{Effect, Trade};

/// Loops that are run in the search for gains.
pub const BUDGET: usize = 60;

/// Logarithms of the speeds that are looked at first, and of the factors on the metric of the motors.
const SPEEDS: [f64; 9] = [-3.0, -2.4, -1.8, -1.2, -0.8, -0.4, 0.0, 0.4, 0.8];
const EXCHANGES: [(f64, f64); 15] = [
    (-1.4, 0.0),
    (-0.7, 0.0),
    (0.0, 0.0),
    (0.7, 0.0),
    (1.4, 0.0),
    (-1.4, 0.5),
    (-0.7, 0.5),
    (0.0, 0.5),
    (0.7, 0.5),
    (1.4, 0.5),
    (-1.4, 1.0),
    (-0.7, 1.0),
    (0.0, 1.0),
    (0.7, 1.0),
    (1.4, 1.0),
];

/// How far the search goes from the best of these, as a logarithm.
const HALF_WIDTH: f64 = 1.2;

/// A search for gains.
struct Search<'a> {
    bench: &'a Bench,
    outlooks: &'a Outlooks<'a>,
    family: &'a Family,
    pace: Pace,
}

/// What a search found.
struct Found {
    /// The best that was tried.
    best: Trial,
    /// Loops that were run.
    runs: usize,
    /// Whether it was broken off.
    interrupted: bool,
}

impl Search<'_> {
    /// The best gains among those of at most `budget` runs, and `given` ones.
    fn run(
        &self,
        given: &[Controller],
        budget: usize,
        seed: u64,
        progress: Progress<'_>,
    ) -> Result<Found, Problems> {
        let dimension = self.family.dimension();
        let mut best: Option<Trial> = None;
        let mut consider = |trial: Trial| {
            if best.as_ref().is_none_or(|best| trial.cost < best.cost) {
                best = Some(trial);
            }
        };
        for controller in given.iter().take(budget) {
            consider(self.bench.try_out(self.outlooks, controller.clone(), f64::ln, f64::INFINITY)?);
        }
        tell(progress, 0.02)?;
        let ridge = self.ridge();
        let first: Vec<&Vec<f64>> = ridge.iter().take(budget.saturating_sub(given.len())).collect();
        let tried: Vec<Trial> =
            first.par_iter().map(|x| self.at(x, f64::INFINITY)).collect::<Result<_, Problems>>()?;
        let center = tried.iter().zip(&first).min_by(|(a, _), (b, _)| a.cost.total_cmp(&b.cost));
        let center = center.map_or_else(|| vec![0.0; dimension], |(_, x)| (*x).clone());
        tried.into_iter().for_each(&mut consider);
        let used = given.len() + first.len();
        let left = budget.saturating_sub(used);
        let (best, tried, broken, failed) =
            (RefCell::new(best), Cell::new(0_usize), Cell::new(false), RefCell::new(None));
        let cost = |step: &[f64]| {
            tried.set(tried.get() + 1);
            if progress((used + tried.get()) as f64 / budget as f64).is_break() {
                broken.set(true);
            }
            if broken.get() {
                return f64::INFINITY;
            }
            let x: Vec<f64> = center.iter().zip(step).map(|(x, step)| x + step).collect();
            let least = best.borrow().as_ref().map_or(f64::INFINITY, |best| best.cost);
            match self.at(&x, least) {
                Ok(trial) => {
                    let cost = trial.cost;
                    if cost < least {
                        *best.borrow_mut() = Some(trial);
                    }
                    cost
                }
                Err(problems) => {
                    *failed.borrow_mut() = Some(problems);
                    broken.set(true);
                    f64::INFINITY
                }
            }
        };
        if left > 0 {
            search(dimension, HALF_WIDTH, left, seed, &cost);
        }
        if let Some(problems) = failed.into_inner() {
            return Err(problems);
        }
        let best = best.into_inner().ok_or_else(Problems::interrupted)?;
        Ok(Found { best, runs: used + tried.get(), interrupted: broken.get() })
    }

    /// The member at `x` on trial.
    fn at(&self, x: &[f64], best: f64) -> Result<Trial, Problems> {
        let controller = self.family.at(x, self.pace);
        let cost = |error: f64| if self.pace == Pace::Proved { -x[0] } else { error.ln() };
        self.bench.try_out(self.outlooks, controller, cost, best)
    }

    /// For each speed the member whose sampled loop makes small errors shrink fastest, from slow to fast: the stable ones, or else the
    /// one that is closest.
    fn ridge(&self) -> Vec<Vec<f64>> {
        let origin = if self.pace == Pace::Proved { self.family.base_rate() } else { 0.0 };
        let (exchange, balance) = (self.family.exchange(), self.family.balance());
        let members = SPEEDS.iter().flat_map(|speed| {
            let exchanges = if exchange.is_some() { &EXCHANGES[..] } else { &[(0.0, 0.0)] };
            exchanges.iter().map(move |(factor, balanced)| {
                let mut x = vec![0.0; self.family.dimension()];
                x[0] = origin + speed;
                if let (Some(exchange), Some(balance)) = (exchange, balance) {
                    x[exchange] = *factor;
                    x[balance] = *balanced;
                }
                x
            })
        });
        let members: Vec<Vec<f64>> = members.collect();
        let radii: Vec<f64> =
            members.par_iter().map(|x| self.outlooks.nominal(&self.family.at(x, self.pace))).collect();
        let each = members.len() / SPEEDS.len();
        let best = |(members, radii): (&[Vec<f64>], &[f64])| {
            let least = members.iter().zip(radii).min_by(|(_, a), (_, b)| a.total_cmp(b));
            least.map(|(x, radius)| (x.clone(), *radius))
        };
        let ridge: Vec<(Vec<f64>, f64)> =
            members.chunks(each).zip(radii.chunks(each)).filter_map(best).collect();
        let stable: Vec<Vec<f64>> =
            ridge.iter().filter(|(_, radius)| *radius < 1.0).map(|(x, _)| x.clone()).collect();
        if !stable.is_empty() {
            return stable;
        }
        let closest = ridge.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b));
        closest.map(|(x, _)| x).into_iter().collect()
    }
}

/// What is wrong with asking for no runs.
///
/// # Errors
/// If `budget` is 0.
pub fn check_budget(budget: usize) -> Result<(), Problem> {
    crate::compare::check_budget(budget)
}
