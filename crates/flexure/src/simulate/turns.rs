//! Searches that ask for one run after the other, side by side.

use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::Scope;
use rayon::prelude::*;

use crate::files::Problems;
use crate::lanes::WIDTH;
use crate::scenario::Scenario;
use crate::simulate::criteria::Criteria;
use crate::simulate::in_step::may_go_together;
use crate::simulate::run::Run;
use crate::simulate::together::{Job, measure_together};

/// What asks for one run after the other: each depends on what came of those before.
pub trait Asking: Send {
    /// The scenario to run next, and some that may be asked for after it, at most `most` ≥ 1; none once it is done.
    fn ask(&mut self, most: usize) -> Vec<Scenario>;

    /// What its runs are held to.
    fn criteria(&self) -> &Criteria;

    /// Told the fraction done of a run that it has asked for; breaks it off.
    fn watch(&self, fraction: f64) -> ControlFlow<()>;

    /// Takes in what came of the scenarios that it has asked for; [`Problems::interrupted`] of runs that were broken off.
    fn tell(&mut self, runs: Vec<(Scenario, Result<Run, Problems>)>);
}

/// Gives each of `searches` what it asks for until all are done, on all cores: whichever wait for a run have it together
/// ([`measure_together`]), and once there are more cores than searches each is asked for as many runs as there are cores for it. What comes of a run does
/// not depend on which others it has beside it, so neither does what comes of a search.
pub fn in_turns<S: Asking + Sync>(searches: Vec<S>) -> Vec<S> {
    let turns = Turns(Mutex::new(State {
        waiting: Vec::new(),
        done: searches.iter().map(|_| None).collect(),
        left: searches.len(),
    }));
    for (place, search) in searches.into_iter().enumerate() {
        turns.state().put(place, search);
    }
    rayon::scope(|scope| turns.go(scope));
    turns.0.into_inner().unwrap_or_else(PoisonError::into_inner).done.into_iter().flatten().collect()
}

struct Turns<S>(Mutex<State<S>>);

struct State<S> {
    waiting: Vec<Waiting<S>>,
    done: Vec<Option<S>>,
    /// Searches that are not done.
    left: usize,
}

/// A search with its place and the scenarios that it has asked for.
struct Waiting<S> {
    place: usize,
    search: S,
    asked: Vec<Scenario>,
}

impl<S: Asking> State<S> {
    /// Has `search` ask for its next runs.
    fn put(&mut self, place: usize, mut search: S) {
        let cores = rayon::current_num_threads() / self.left.max(1);
        let asked = search.ask(cores.max(1));
        if asked.is_empty() {
            self.done[place] = Some(search);
            self.left -= 1;
        } else {
            // The first goes first: who begins with the longest is not left with it alone.
            let at = self.waiting.partition_point(|other| other.place < place);
            self.waiting.insert(at, Waiting { place, search, asked });
        }
    }

    /// Searches whose runs go together: as many as leave some for the other cores. One that has several cores goes alone.
    fn take(&mut self) -> Vec<Waiting<S>> {
        let most = self.left.div_ceil(rayon::current_num_threads()).clamp(1, WIDTH);
        let mut taken: Vec<Waiting<S>> = Vec::new();
        let mut i = 0;
        while i < self.waiting.len() && taken.len() < most {
            let fits = |first: &Waiting<S>| may_go_together(&first.asked[0], &self.waiting[i].asked[0]);
            if taken.first().is_none_or(fits) {
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
            let (taken, more) = {
                let mut state = self.state();
                (state.take(), !state.waiting.is_empty())
            };
            if taken.is_empty() {
                return;
            }
            if more {
                scope.spawn(|scope| self.go(scope));
            }
            let runs: Vec<Vec<_>> = match &taken[..] {
                [one] => {
                    vec![one.asked.par_iter().flat_map_iter(|asked| measured(&[(one, asked)])).collect()]
                }
                several => {
                    let first: Vec<_> = several.iter().map(|each| (each, &each.asked[0])).collect();
                    measured(&first).into_iter().map(|run| vec![run]).collect()
                }
            };
            for (Waiting { place, mut search, asked }, runs) in taken.into_iter().zip(runs) {
                search.tell(asked.into_iter().zip(runs).collect());
                self.state().put(place, search);
            }
        }
    }
}

/// Runs scenarios for the searches that have asked for them.
fn measured<S: Asking + Sync>(asked: &[(&Waiting<S>, &Scenario)]) -> Vec<Result<Run, Problems>> {
    let jobs: Vec<Job<'_>> = asked.iter().map(|(by, scenario)| (*scenario, by.search.criteria())).collect();
    measure_together(&jobs, &|i, fraction| asked[i].0.search.watch(fraction))
}
