//! How far tuning is, counted in runs of the loop one after the other.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::files::Problems;
use crate::progress::Progress;
use crate::scenario::Scenario;

/// What the count resolves \[runs\].
const GRAIN: f64 = 1e-6;

/// Who watches the work: told how far it is, and asked whether to go on.
pub(super) struct Watch<'a> {
    progress: Progress<'a>,
    /// What all of the work takes about \[runs\].
    total: f64,
    /// Grains that are done.
    done: AtomicU64,
}

impl<'a> Watch<'a> {
    /// Of work that takes as long as `total` runs.
    pub fn new(progress: Progress<'a>, total: f64) -> Self {
        Self { progress, total, done: AtomicU64::new(0) }
    }

    /// Tells that work of so many runs more is done.
    pub fn add(&self, runs: f64) {
        self.done.fetch_add(grains(runs), Ordering::Relaxed);
        let _ = self.go_on();
    }

    /// Tells that all is done up to so many runs of the whole: parts may take less than was thought.
    pub fn reach(&self, runs: f64) {
        self.done.fetch_max(grains(runs), Ordering::Relaxed);
        let _ = self.go_on();
    }

    /// # Errors
    /// [`Problems::interrupted`] if it is time to end.
    pub fn check(&self) -> Result<(), Problems> {
        if self.go_on().is_break() { Err(Problems::interrupted()) } else { Ok(()) }
    }

    /// Whether to go on.
    pub fn go_on(&self) -> ControlFlow<()> {
        let done = GRAIN * self.done.load(Ordering::Relaxed) as f64;
        (self.progress)((done / self.total).min(1.0))
    }
}

/// How long pieces of the work take, in runs of the loop: as measured with arms of one to seven joints, so as to tell the time that
/// remains, no more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// A first idea of the sampled loop.
    pub idea: f64,
    /// A run with a look at the sampled loop and at what it shall bear.
    pub trial: f64,
    /// A tube of the sampled loop.
    pub tube: f64,
}

impl Effort {
    /// For loops such as `scenario`: a run takes its control periods, and the sampled loop is looked at in the same places however
    /// many these are.
    pub fn of(scenario: &Scenario) -> Self {
        let periods = scenario.duration / scenario.control_period;
        let joints = scenario.robot.joint_count() as f64;
        Self {
            idea: 140.0 * joints.powf(1.5) / periods,
            trial: 1.0 + 5000.0 * joints / periods,
            tube: 3000.0 * joints.powf(1.75),
        }
    }
}

/// How long `runs` side by side take, in runs.
pub(super) fn side_by_side(runs: usize) -> f64 {
    runs.div_ceil(rayon::current_num_threads()) as f64
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few thousand runs, none below zero"
)]
fn grains(runs: f64) -> u64 {
    (runs / GRAIN) as u64
}
