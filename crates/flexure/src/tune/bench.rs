//! Gains on trial in searches that go on side by side: what is known already is not run again.

use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::feasible;
use crate::files::Problems;
use crate::laws::Controller;
use crate::progress::{PartProgress, Parts};
use crate::scenario::Scenario;
use crate::simulate::{Asking, Criteria, Job, Run, measure_together};
use crate::tune::local::Local;
use crate::tune::{judged, penalised_error};

/// Scenarios that are tuned side by side, and what is known of their gains.
pub(super) struct Bench<'a> {
    trials: Vec<Trial>,
    /// Gains that factors are about, and by which power each grows with the speed of the loop.
    start: Controller,
    gains: Vec<Vec<f64>>,
    powers: Vec<i32>,
    /// What runs cost, by the seed of the scenario and the exponents of the gains.
    known: Mutex<HashMap<Key, f64>>,
    progress: PartProgress<'a>,
}

type Key = (u64, Vec<u64>);

/// A scenario that is tuned.
struct Trial {
    scenario: Scenario,
    criteria: Criteria,
    /// How far each of the runs is that its search may ask for, and how many it has asked for.
    parts: Parts,
    asked: AtomicUsize,
    budget: usize,
}

impl Trial {
    /// The next run of the search.
    fn next(&self) -> usize {
        self.asked.fetch_add(1, Ordering::Relaxed).min(self.budget - 1)
    }
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        starts: &[(Scenario, u64)],
        budget: usize,
        progress: PartProgress<'a>,
    ) -> Result<Self, Problems> {
        let budget = budget.max(1);
        let trial = |(scenario, _): &(Scenario, u64)| {
            let scenario = feasible::pinned(&scenario.by_collocation())?;
            let criteria = Criteria::of(&scenario)?;
            Ok(Trial { scenario, criteria, parts: Parts::new(budget), asked: AtomicUsize::new(0), budget })
        };
        let start = starts[0].0.controller.clone();
        Ok(Self {
            trials: starts.iter().map(trial).collect::<Result<_, Problems>>()?,
            gains: start.gains().into_iter().map(|(_, values)| values.to_vec()).collect(),
            powers: start.speed_powers(),
            start,
            known: Mutex::default(),
            progress,
        })
    }

    /// Exponents that gains have: that of the speed of the loop, and one each.
    pub(super) fn dimension(&self) -> usize {
        1 + self.gains.len()
    }

    /// Cost and penalised error of each scenario as it is. Whatever is wrong with one of them is so for all gains.
    pub(super) fn started(&self) -> Result<Vec<(f64, f64)>, Problems> {
        let jobs: Vec<Job<'_>> = self.trials.iter().map(|trial| (&trial.scenario, &trial.criteria)).collect();
        let runs = measure_together(&jobs, &|place, _| (self.progress)(place, 0.0));
        let origin = vec![0.0; self.dimension()];
        let started = |(trial, run): (&Trial, Result<Run, Problems>)| {
            let run = run?;
            let cost = judged(&trial.scenario, &run);
            self.note(trial, &origin, cost);
            Ok((cost, penalised_error(&run.summary)))
        };
        self.trials.iter().zip(runs).map(started).collect()
    }

    /// What each scenario, by its place, costs with the gains that have these exponents.
    pub(super) fn costs(&self, asked: &[(usize, &Vec<f64>)]) -> Result<Vec<f64>, Problems> {
        let parts: Vec<usize> = asked.iter().map(|(place, _)| self.trials[*place].next()).collect();
        let mut seen = HashSet::new();
        let new = asked.iter().zip(&parts).filter(|((place, at), _)| {
            let key = key(&self.trials[*place], at);
            !self.known().contains_key(&key) && seen.insert(key)
        });
        let new: Vec<_> = new.map(|(&(place, at), &part)| (place, at, part, self.with(place, at))).collect();
        let jobs: Vec<Job<'_>> =
            new.iter().map(|(place, _, _, scenario)| (scenario, &self.trials[*place].criteria)).collect();
        let runs = measure_together(&jobs, &|i, fraction| self.tell(new[i].0, new[i].2, fraction));
        let judge = |((place, at, _, scenario), run): (&(usize, &Vec<f64>, usize, Scenario), _)| {
            self.judge(*place, at, scenario, run)
        };
        new.par_iter().zip(runs).map(judge).collect::<Result<Vec<f64>, _>>()?;
        for ((place, _), part) in asked.iter().zip(parts) {
            // What is known already or ended early is done, too.
            let _ = self.tell(*place, part, 1.0);
        }
        let found = asked.iter().map(|(place, at)| self.known().get(&key(&self.trials[*place], at)).copied());
        Ok(found.map(|cost| cost.unwrap_or(f64::INFINITY)).collect())
    }

    /// Notes what a run of `scenario`, that at the place with the exponents `at`, costs; infinitely much if it cannot be run.
    fn judge(
        &self,
        place: usize,
        at: &[f64],
        scenario: &Scenario,
        run: Result<Run, Problems>,
    ) -> Result<f64, Problems> {
        let cost = match run {
            Ok(run) => judged(scenario, &run),
            Err(problems) if problems.is_interrupted() => return Err(problems),
            Err(_) => f64::INFINITY,
        };
        self.note(&self.trials[place], at, cost);
        Ok(cost)
    }

    fn note(&self, trial: &Trial, at: &[f64], cost: f64) {
        self.known().insert(key(trial, at), cost);
    }

    fn known(&self) -> std::sync::MutexGuard<'_, HashMap<Key, f64>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, place: usize, part: usize, fraction: f64) -> ControlFlow<()> {
        (self.progress)(place, self.trials[place].parts.with(part, fraction))
    }

    /// The law with the gains that have these exponents.
    pub(super) fn scaled(&self, exponents: &[f64]) -> Controller {
        let (speed, own) = exponents.split_first().unwrap_or((&0.0, &[]));
        let factors =
            own.iter().zip(&self.powers).map(|(own, &power)| (own + f64::from(power) * speed).exp());
        let scaled = self.gains.iter().zip(factors).map(|(gain, x)| gain.iter().map(|g| g * x).collect());
        self.start.with_gains(&scaled.collect::<Vec<Vec<f64>>>())
    }

    fn with(&self, place: usize, exponents: &[f64]) -> Scenario {
        self.trials[place].scenario.under(&self.scaled(exponents))
    }
}

fn key(trial: &Trial, exponents: &[f64]) -> Key {
    (trial.scenario.seed, exponents.iter().map(|x| x.to_bits()).collect())
}

/// The local search for the gains of one of the scenarios.
pub(super) struct Climb<'a> {
    pub bench: &'a Bench<'a>,
    pub place: usize,
    pub local: Local,
    /// Exponents of the gains that are on trial, and the number of the run.
    pub at: Option<(Vec<f64>, usize)>,
    /// Whether it was broken off.
    pub broken: bool,
}

impl Asking for Climb<'_> {
    /// One: where the method of Powell goes from there nobody knows.
    fn ask(&mut self, _: usize) -> Vec<Scenario> {
        let Self { bench, place, .. } = *self;
        let trial = &bench.trials[place];
        while !self.broken {
            let Some(at) = self.local.next() else { break };
            let part = trial.next();
            let known = bench.known().get(&key(trial, &at)).copied();
            if let Some(cost) = known {
                let _ = bench.tell(place, part, 1.0);
                self.local.tell(cost);
            } else {
                let scenario = bench.with(place, &at);
                self.at = Some((at, part));
                return vec![scenario];
            }
        }
        Vec::new()
    }

    fn criteria(&self) -> &Criteria {
        &self.bench.trials[self.place].criteria
    }

    fn watch(&self, fraction: f64) -> ControlFlow<()> {
        let part = self.at.as_ref().map_or(0, |(_, part)| *part);
        self.bench.tell(self.place, part, fraction)
    }

    fn tell(&mut self, runs: Vec<(Scenario, Result<Run, Problems>)>) {
        for (scenario, run) in runs {
            let Some((at, part)) = self.at.take() else { return };
            let _ = self.bench.tell(self.place, part, 1.0);
            match self.bench.judge(self.place, &at, &scenario, run) {
                Ok(cost) => self.local.tell(cost),
                Err(_) => self.broken = true,
            }
        }
    }
}
