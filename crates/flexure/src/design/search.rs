//! The search for the numbers that gains follow from.
//!
//! It begins with the sampled loop alone, which costs no run: for each speed and damping of the motors, their metric at which small
//! errors shrink fastest. Then the loop is run with the fastest of these, and the search moves all numbers from the best of them.

use std::cell::{Cell, RefCell};

use rayon::prelude::*;

use crate::design::bench::{Bench, Outlooks, Trial};
use crate::design::family::{Family, Pace};
use crate::design::watch::{Effort, Watch, side_by_side};
use crate::files::Problems;
use crate::laws::Controller;
use crate::tune::{search, together};

/// Loops that are run in the search for gains.
pub const BUDGET: usize = 40;

/// Logarithms of the speeds that are looked at first; and, of v-CBC, those of the factors on damping and metric of the motors, and the
/// powers of the balance.
const SPEEDS: [f64; 9] = [-3.0, -2.4, -1.8, -1.2, -0.8, -0.4, 0.0, 0.4, 0.8];
const METRICS: [f64; 5] = [-1.4, -0.7, 0.0, 0.7, 1.4];
const DAMPINGS: [f64; 3] = [0.0, 0.8, 1.6];
const BALANCES: [f64; 3] = [0.0, 0.5, 1.0];

/// Loops that are run before the search moves on from the best of them, at most.
const FIRST: usize = 12;

/// How far the search goes from the best of these, as a logarithm.
const HALF_WIDTH: f64 = 1.2;

/// A search for gains.
pub(super) struct Search<'a> {
    pub bench: &'a Bench,
    pub outlooks: &'a Outlooks<'a>,
    pub family: &'a Family,
    pub pace: Pace,
    pub watch: &'a Watch<'a>,
    pub effort: Effort,
}

/// What a search found.
pub(super) struct Found {
    /// The best that was tried.
    pub best: Trial,
    /// All that keep every constraint, the best first, where a rate of the sampled loop is asked.
    pub kept: Vec<Trial>,
    /// Loops that were run.
    pub runs: usize,
    /// Whether it was broken off.
    pub broken_off: bool,
}

impl Search<'_> {
    /// The best of at most `budget` gains that are tried, `given` ones among them, and the starting ones, slower where these do not hold:
    /// they are tried first, so that there is something to keep.
    ///
    /// # Errors
    /// As [`Scenario::open`](crate::Scenario::open), and [`Problems::interrupted`] if it was broken off before anything was tried.
    pub fn run(&self, given: &[Controller], budget: usize, seed: u64) -> Result<Found, Problems> {
        let start = self.at(&self.slowed(), f64::INFINITY, 1)?;
        let state = State { collects: self.bench.sampled_rate.is_some(), ..State::default() };
        note(&state, vec![Ok(start)]);
        // It is beside the budget.
        state.runs.set(0);
        let own = |controller: &Controller| {
            let trial =
                self.bench.try_out(self.outlooks, controller.clone(), f64::ln, f64::INFINITY, self.watch);
            self.watch.add(self.effort.trial);
            trial
        };
        note(&state, given.iter().take(budget).map(own).collect::<Vec<_>>());
        let ridge = self.ridge(first_runs(budget));
        let first: Vec<&Vec<f64>> = ridge.iter().take(budget.saturating_sub(state.runs.get())).collect();
        let costs = note(&state, first.par_iter().map(|x| self.at(x, f64::INFINITY, first.len())).collect());
        let center = costs.iter().zip(&first).min_by(|(a, _), (b, _)| a.total_cmp(b));
        let center = center.map_or_else(|| vec![0.0; self.family.dimension()], |(_, x)| (*x).clone());
        let costs = |steps: &[Vec<f64>]| {
            if state.failed.borrow().is_some() {
                return vec![f64::INFINITY; steps.len()];
            }
            let least = state.best.borrow().as_ref().map_or(f64::INFINITY, |best| best.cost);
            let at = |step: &Vec<f64>| {
                let x: Vec<f64> = center.iter().zip(step).map(|(x, step)| x + step).collect();
                self.at(&x, least, steps.len())
            };
            note(&state, steps.par_iter().map(at).collect())
        };
        let left = budget.saturating_sub(state.runs.get());
        if left > 0 {
            search(self.family.dimension(), HALF_WIDTH, left, seed, &costs);
        }
        let runs = state.runs.get();
        match (state.best.into_inner(), state.failed.into_inner()) {
            (Some(best), failed) if failed.as_ref().is_none_or(Problems::is_interrupted) => {
                let mut kept = state.kept.into_inner();
                kept.sort_by(|a, b| a.cost.total_cmp(&b.cost));
                Ok(Found { best, kept, runs, broken_off: failed.is_some() })
            }
            (_, failed) => Err(failed.unwrap_or_else(Problems::interrupted)),
        }
    }

    /// The member at `x` on trial, one of so many that are tried side by side.
    fn at(&self, x: &[f64], best: f64, tried: usize) -> Result<Trial, Problems> {
        let controller = self.family.at(x, self.pace);
        let cost = |error: f64| if self.pace == Pace::Proved { -x[0] } else { error.ln() };
        let trial = self.bench.try_out(self.outlooks, controller, cost, best, self.watch);
        self.watch.add(self.effort.trial * side_by_side(tried) / tried as f64);
        trial
    }

    /// Numbers of the fastest member with starting gains, or slower ones in the same proportions, of whose sampled loop a first
    /// idea is that small errors shrink in it; of the starting gains if there is none.
    fn slowed(&self) -> Vec<f64> {
        let at = |speed: &f64| {
            let mut numbers = self.start();
            numbers[0] += speed;
            numbers
        };
        let slower: Vec<Vec<f64>> = SPEEDS.iter().rev().filter(|speed| **speed <= 0.0).map(at).collect();
        let shrinks = |x: &&Vec<f64>| self.outlooks.first_idea(&self.family.at(x, self.pace)) < 1.0;
        let first = slower.par_iter().find_first(shrinks);
        first.cloned().unwrap_or_else(|| self.start())
    }

    /// Numbers of the member with the starting gains, or with the least ones that prove their rate.
    fn start(&self) -> Vec<f64> {
        let mut numbers = vec![0.0; self.family.dimension()];
        if self.pace == Pace::Proved {
            numbers[0] = self.family.base_rate();
        }
        numbers
    }

    /// For each speed and damping of the motors the member whose sampled loop makes small errors shrink fastest, from fast to slow: at
    /// most `most` of the stable ones, or else the one that is closest.
    fn ridge(&self, most: usize) -> Vec<Vec<f64>> {
        let origin = self.start()[0];
        let (dampings, scales) = looks(self.family);
        let mut paces: Vec<[f64; 2]> =
            SPEEDS.iter().flat_map(|speed| dampings.iter().map(|damping| [*speed, *damping])).collect();
        // Errors are the smaller the faster the loop and the stiffer its motors.
        paces.sort_by(|a, b| (b[0] + b[1]).total_cmp(&(a[0] + a[1])));
        let members = |[speed, damping]: &[f64; 2]| {
            let at = |[metric, balance]: &[f64; 2]| {
                self.family.numbers(origin + speed, [*metric, *damping, *balance])
            };
            scales.iter().map(at).collect::<Vec<_>>()
        };
        let members: Vec<Vec<f64>> = paces.iter().flat_map(members).collect();
        let each = self.effort.idea * side_by_side(members.len()) / members.len() as f64;
        let idea = |x: &Vec<f64>| {
            if self.watch.go_on().is_break() {
                return f64::INFINITY;
            }
            let growth = self.outlooks.first_idea(&self.family.at(x, self.pace));
            self.watch.add(each);
            growth
        };
        let growths: Vec<f64> = members.par_iter().map(idea).collect();
        let best = |(members, growths): (&[Vec<f64>], &[f64])| {
            let least = members.iter().zip(growths).min_by(|(_, a), (_, b)| a.total_cmp(b));
            least.map(|(x, growth)| (x.clone(), *growth))
        };
        let each = scales.len();
        let ridge: Vec<(Vec<f64>, f64)> =
            members.chunks(each).zip(growths.chunks(each)).filter_map(best).collect();
        let stable = ridge.iter().filter(|(_, growth)| *growth < 1.0).map(|(x, _)| x.clone());
        let stable: Vec<Vec<f64>> = stable.take(most).collect();
        if !stable.is_empty() {
            return stable;
        }
        let closest = ridge.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b));
        closest.map(|(x, _)| x).into_iter().collect()
    }
}

/// What a search has so far.
#[derive(Default)]
struct State {
    best: RefCell<Option<Trial>>,
    /// Those that keep every constraint, if they are collected.
    kept: RefCell<Vec<Trial>>,
    collects: bool,
    runs: Cell<usize>,
    failed: RefCell<Option<Problems>>,
}

/// Takes in trials, and gives what they cost: infinitely much where one failed.
fn note(state: &State, trials: Vec<Result<Trial, Problems>>) -> Vec<f64> {
    let note = |trial: Result<Trial, Problems>| match trial {
        Ok(trial) => {
            state.runs.set(state.runs.get() + 1);
            let cost = trial.cost;
            if state.collects && trial.keeps() {
                state.kept.borrow_mut().push(trial.clone());
            }
            let mut best = state.best.borrow_mut();
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                *best = Some(trial);
            }
            cost
        }
        Err(problems) => {
            state.failed.borrow_mut().get_or_insert(problems);
            f64::INFINITY
        }
    };
    trials.into_iter().map(note).collect()
}

/// Dampings, and metrics with balances, that are looked at for each speed.
fn looks(family: &Family) -> (&'static [f64], Vec<[f64; 2]>) {
    if !family.is_vcbc() {
        return (&[0.0], vec![[0.0; 2]]);
    }
    let scales = METRICS.iter().flat_map(|metric| BALANCES.map(|balance| [*metric, balance]));
    (&DAMPINGS, scales.collect())
}

/// Loops that are run of the ridge.
fn first_runs(budget: usize) -> usize {
    FIRST.min(budget.div_ceil(2))
}

/// How long a search in `family` with `budget` runs takes.
pub(super) fn work(family: &Family, effort: Effort, budget: usize) -> f64 {
    let (dampings, scales) = looks(family);
    let ideas = side_by_side(SPEEDS.len() * dampings.len() * scales.len());
    let first = first_runs(budget);
    let left = budget.saturating_sub(first);
    let together = together(family.dimension(), left);
    let alone = left.saturating_sub(together.iter().sum());
    let trials = 1.0 + side_by_side(first) + together.map(side_by_side).iter().sum::<f64>() + alone as f64;
    effort.idea * ideas + effort.trial * trials
}
