//! The search for the numbers that gains follow from.
//!
//! It begins with the sampled loop alone, which costs no run: for each speed and damping of the motors, their metric at which small
//! errors shrink fastest. Then the loop is run with the fastest of these, and the search moves all numbers from the best of them.

use std::cell::{Cell, RefCell};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::design::bench::{Bench, Outlooks, Trial};
use crate::design::family::{Family, Pace};
use crate::files::Problems;
use crate::laws::Controller;
use crate::progress::Progress;
use crate::tune::search;

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

/// Who watches a search: told how far it is, and asked whether to go on.
pub(super) struct Watch<'a> {
    progress: Progress<'a>,
    at: AtomicU64,
}

impl<'a> Watch<'a> {
    pub fn new(progress: Progress<'a>) -> Self {
        Self { progress, at: AtomicU64::new(0.0_f64.to_bits()) }
    }

    /// Tells that `fraction` is done.
    pub fn tell(&self, fraction: f64) {
        self.at.store(fraction.to_bits(), Ordering::Relaxed);
        let _ = self.go_on();
    }

    /// # Errors
    /// [`Problems::interrupted`] if it is time to end.
    pub fn check(&self) -> Result<(), Problems> {
        if self.go_on().is_break() { Err(Problems::interrupted()) } else { Ok(()) }
    }

    /// Whether to go on.
    pub fn go_on(&self) -> ControlFlow<()> {
        (self.progress)(f64::from_bits(self.at.load(Ordering::Relaxed)))
    }
}

/// A search for gains.
pub(super) struct Search<'a> {
    pub bench: &'a Bench,
    pub outlooks: &'a Outlooks<'a>,
    pub family: &'a Family,
    pub pace: Pace,
    pub watch: &'a Watch<'a>,
    /// Which part of the whole job it is, from and to.
    pub part: [f64; 2],
}

/// What a search found.
pub(super) struct Found {
    /// The best that was tried.
    pub best: Trial,
    /// Loops that were run.
    pub runs: usize,
    /// Whether it was broken off.
    pub broken_off: bool,
}

impl Search<'_> {
    /// The best gains among those of at most `budget` runs, and `given` ones.
    ///
    /// # Errors
    /// As [`Scenario::open`](crate::Scenario::open), and [`Problems::interrupted`] if it was broken off before anything was tried.
    pub fn run(&self, given: &[Controller], budget: usize, seed: u64) -> Result<Found, Problems> {
        let state = State::default();
        let own = |controller: &Controller| {
            self.bench.try_out(self.outlooks, controller.clone(), f64::ln, f64::INFINITY, self.watch)
        };
        self.note(&state, budget, given.iter().take(budget).map(own).collect::<Vec<_>>());
        let ridge = self.ridge(FIRST.min(budget.div_ceil(2)));
        let first: Vec<&Vec<f64>> = ridge.iter().take(budget.saturating_sub(state.runs.get())).collect();
        let costs = self.note(&state, budget, first.par_iter().map(|x| self.at(x, f64::INFINITY)).collect());
        let center = costs.iter().zip(&first).min_by(|(a, _), (b, _)| a.total_cmp(b));
        let center = center.map_or_else(|| vec![0.0; self.family.dimension()], |(_, x)| (*x).clone());
        let costs = |steps: &[Vec<f64>]| {
            if state.failed.borrow().is_some() {
                return vec![f64::INFINITY; steps.len()];
            }
            let least = state.best.borrow().as_ref().map_or(f64::INFINITY, |best| best.cost);
            let at = |step: &Vec<f64>| {
                let x: Vec<f64> = center.iter().zip(step).map(|(x, step)| x + step).collect();
                self.at(&x, least)
            };
            self.note(&state, budget, steps.par_iter().map(at).collect())
        };
        let left = budget.saturating_sub(state.runs.get());
        if left > 0 {
            search(self.family.dimension(), HALF_WIDTH, left, seed, &costs);
        }
        let runs = state.runs.get();
        match (state.best.into_inner(), state.failed.into_inner()) {
            (Some(best), failed) if failed.as_ref().is_none_or(Problems::is_interrupted) => {
                Ok(Found { best, runs, broken_off: failed.is_some() })
            }
            (_, failed) => Err(failed.unwrap_or_else(Problems::interrupted)),
        }
    }

    /// The member at `x` on trial.
    fn at(&self, x: &[f64], best: f64) -> Result<Trial, Problems> {
        let controller = self.family.at(x, self.pace);
        let cost = |error: f64| if self.pace == Pace::Proved { -x[0] } else { error.ln() };
        self.bench.try_out(self.outlooks, controller, cost, best, self.watch)
    }

    /// Takes in trials, and gives what they cost: infinitely much where one failed.
    fn note(&self, state: &State, budget: usize, trials: Vec<Result<Trial, Problems>>) -> Vec<f64> {
        let note = |trial: Result<Trial, Problems>| match trial {
            Ok(trial) => {
                state.runs.set(state.runs.get() + 1);
                let cost = trial.cost;
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
        let costs = trials.into_iter().map(note).collect();
        let [from, to] = self.part;
        self.watch.tell(from + (to - from) * state.runs.get() as f64 / budget as f64);
        costs
    }

    /// For each speed and damping of the motors the member whose sampled loop makes small errors shrink fastest, from fast to slow: at
    /// most `most` of the stable ones, or else the one that is closest.
    fn ridge(&self, most: usize) -> Vec<Vec<f64>> {
        let origin = if self.pace == Pace::Proved { self.family.base_rate() } else { 0.0 };
        let (dampings, scales): (&[f64], Vec<[f64; 2]>) = if self.family.is_vcbc() {
            let scales = METRICS.iter().flat_map(|metric| BALANCES.map(|balance| [*metric, balance]));
            (&DAMPINGS, scales.collect())
        } else {
            (&[0.0], vec![[0.0; 2]])
        };
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
        let idea = |x: &Vec<f64>| match self.watch.go_on() {
            ControlFlow::Continue(()) => self.outlooks.first_idea(&self.family.at(x, self.pace)),
            ControlFlow::Break(()) => f64::INFINITY,
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
    runs: Cell<usize>,
    failed: RefCell<Option<Problems>>,
}
