//! Searches that ask for one run after the other, side by side.

use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::Scope;

use crate::files::Problems;
use crate::lanes::WIDTH;
use crate::scenario::Scenario;
use crate::simulate::criteria::Criteria;
use crate::simulate::in_step::may_go_together;
use crate::simulate::run::Run;
use crate::simulate::together::{Job, measure_together};

/// What asks for one run after the other: each depends on what came of those before.
pub trait Asking: Send {
    /// The scenario to run next; none once it is done.
    fn ask(&mut self) -> Option<Scenario>;

    /// What its runs are held to.
    fn criteria(&self) -> &Criteria;

    /// Told the fraction done of the run that it has asked for; breaks it off.
    fn watch(&self, fraction: f64) -> ControlFlow<()>;

    /// Takes in what came of the run of the `scenario` that it has asked for; [`Problems::interrupted`] if it was broken off.
    fn tell(&mut self, scenario: &Scenario, run: Result<Run, Problems>);
}

/// Gives each of `searches` what it asks for until all are done, on all cores: whichever wait for a run have it together
/// ([`measure_together`]). What comes of a run does not depend on which others it has beside it, so neither does what comes of a search.
pub fn in_turns<S: Asking + Sync>(searches: Vec<S>) -> Vec<S> {
    let count = searches.len();
    let turns = Turns(Mutex::new(State {
        waiting: Vec::new(),
        done: searches.iter().map(|_| None).collect(),
        left: count,
    }));
    for (place, search) in searches.into_iter().enumerate() {
        turns.state().put(place, search);
    }
    rayon::scope(|scope| turns.go(scope));
    turns.0.into_inner().unwrap_or_else(PoisonError::into_inner).done.into_iter().flatten().collect()
}

struct Turns<S>(Mutex<State<S>>);

struct State<S> {
    /// Searches with their places and the scenarios that they have asked for.
    waiting: Vec<(usize, S, Scenario)>,
    done: Vec<Option<S>>,
    /// Searches that are not done.
    left: usize,
}

impl<S: Asking> State<S> {
    /// Has `search` ask for its next run.
    fn put(&mut self, place: usize, mut search: S) {
        if let Some(scenario) = search.ask() {
            // The first goes first: who begins with the longest is not left with it alone.
            let at = self.waiting.partition_point(|(other, ..)| *other < place);
            self.waiting.insert(at, (place, search, scenario));
        } else {
            self.done[place] = Some(search);
            self.left -= 1;
        }
    }

    /// Searches whose runs go together: as many as leave some for the other cores.
    fn take(&mut self) -> Vec<(usize, S, Scenario)> {
        let most = self.left.div_ceil(rayon::current_num_threads()).clamp(1, WIDTH);
        let mut taken: Vec<(usize, S, Scenario)> = Vec::new();
        let mut i = 0;
        while i < self.waiting.len() && taken.len() < most {
            if taken.first().is_none_or(|(_, _, first)| may_go_together(first, &self.waiting[i].2)) {
                taken.push(self.waiting.remove(i));
            } else {
                i += 1;
            }
        }
        taken
    }
}

impl<S: Asking + Sync> Turns<S> {
    fn state(&self) -> MutexGuard<'_, State<S>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs what is waited for until nothing is. Never waits: what is asked for while others run, they run next.
    fn go<'a>(&'a self, scope: &Scope<'a>) {
        loop {
            let (mut taken, more) = {
                let mut state = self.state();
                (state.take(), !state.waiting.is_empty())
            };
            if taken.is_empty() {
                return;
            }
            if more {
                scope.spawn(|scope| self.go(scope));
            }
            let jobs: Vec<Job<'_>> =
                taken.iter().map(|(_, search, scenario)| (scenario, search.criteria())).collect();
            let runs = measure_together(&jobs, &|i, fraction| taken[i].1.watch(fraction));
            for ((place, mut search, scenario), run) in taken.drain(..).zip(runs) {
                search.tell(&scenario, run);
                self.state().put(place, search);
            }
        }
    }
}
