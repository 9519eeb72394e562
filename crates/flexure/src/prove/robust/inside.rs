//! What the robot may do in a funnel: how fast its links move, how far its springs give, what its motors are asked for and how fast that changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use flexure_core::scalar::Interval;
use rayon::prelude::*;

use crate::progress::Progress;
use crate::prove::along::{Peaks, all_limits};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::flow::Flow;
use crate::prove::engine::envelope::followed::Given;
use crate::prove::engine::envelope::slab::Slab;
use crate::prove::engine::envelope::tube::Tube;
use crate::prove::engine::envelope::{Bounded, Course, largest, refined};
use crate::scenario::Scenario;

/// Slabs of the funnel that are cut, to see what the robot may do: a part of all, and some.
const CUT: [usize; 2] = [8, 32];

/// How many slabs are looked at of a funnel of `count`.
fn cuts(count: usize) -> usize {
    count + 2 * (count / CUT[0] + CUT[1])
}

/// Part of the work that ranges take, about; how fast torques change takes the rest.
const RANGES: f64 = 0.7;

/// Ranges of what the robot may do in the funnel, against `limits` in the order of what is bounded.
fn course(
    system: &dyn TrackingLoop,
    funnel: &[Given],
    limits: &[Interval],
    progress: Progress<'_>,
) -> Option<Course> {
    let (done, count) = (AtomicUsize::new(0), funnel.len());
    let budget = cuts(count);
    let goes_on = || progress((done.load(Ordering::Relaxed) as f64 / budget as f64).min(1.0)).is_continue();
    let looked = |tube: Arc<dyn Tube>, time: Interval| {
        let slab = Slab::of(system, tube, time, &goes_on);
        done.fetch_add(1, Ordering::Relaxed);
        slab
    };
    let slab = |given: &Given| looked(Arc::new(given.passage.clone()), given.time());
    let slabs = funnel.par_iter().map(slab).collect::<Option<_>>()?;
    // All of its errors, for a part of its times.
    let half = |slab: &Slab, time: Interval| looked(slab.tube.clone(), time);
    let (slabs, spent) = refined(slabs, limits, budget, &half, &goes_on);
    Some(Course { slabs, spent })
}

/// What the robot may do in a funnel.
pub(super) struct Inside {
    /// Slabs with the ranges of speeds, deflections and torques.
    pub course: Course,
    /// How fast motor torques change, |u̇_m| \[N m/s\].
    pub torque_rate: Peaks,
}

impl Inside {
    /// None where `progress` breaks it off.
    pub fn of(
        scenario: &Scenario,
        system: &dyn TrackingLoop,
        spread: &Spread,
        funnel: &[Given],
        progress: Progress<'_>,
    ) -> Option<Self> {
        let between = |from: f64, to: f64| move |fraction: f64| progress(from + (to - from) * fraction);
        let course = course(system, funnel, &all_limits(&scenario.robot), &between(0.0, RANGES))?;
        let limits: Vec<_> =
            scenario.robot.limits.torque_rate.iter().map(|&limit| scenario.robot.bounds(limit)).collect();
        let torque_rate = torque_rates(system, spread, &course, &limits, &between(RANGES, 1.0))?;
        Some(Self { course, torque_rate })
    }
}

/// How fast torques change over a slab.
struct Rated {
    slab: Slab,
    /// Of each motor [N m/s].
    bounds: Vec<f64>,
    /// About how fast they do.
    seen: Vec<f64>,
}

impl Rated {
    /// None if it no longer `goes_on`.
    fn of(
        slab: Slab,
        system: &dyn TrackingLoop,
        spread: &Spread,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let n = system.joints();
        let flow = Flow::over(system, spread, &*slab.tube, slab.time, goes_on)?;
        let (mut bounds, mut seen) = (Vec::new(), Vec::new());
        for torque in 2 * n..3 * n {
            let [drift, moved] = slab.rates(torque, &flow);
            bounds.push((drift + moved).magnitude());
            seen.push(slab.nominal_drifts[torque].midpoint().abs() + moved.magnitude());
        }
        Some(Self { slab, bounds, seen })
    }
}

impl Bounded for Rated {
    fn time(&self) -> Interval {
        self.slab.time
    }

    fn quantities(&self) -> usize {
        self.bounds.len()
    }

    fn bound(&self, k: usize) -> f64 {
        self.bounds[k]
    }

    fn seen(&self, k: usize) -> f64 {
        self.seen[k]
    }
}

/// How fast motor torques change in the slabs of `course`, against `limits`.
fn torque_rates(
    system: &dyn TrackingLoop,
    spread: &Spread,
    course: &Course,
    limits: &[Interval],
    progress: Progress<'_>,
) -> Option<Peaks> {
    let (count, n) = (course.slabs.len(), system.joints());
    let (done, budget) = (AtomicUsize::new(0), cuts(count));
    let goes_on = || progress((done.load(Ordering::Relaxed) as f64 / budget as f64).min(1.0)).is_continue();
    let rated = |slab: Slab| {
        let rated = Rated::of(slab, system, spread, &goes_on);
        done.fetch_add(1, Ordering::Relaxed);
        rated
    };
    let all = course.slabs.par_iter().cloned().map(rated).collect::<Option<_>>()?;
    let half =
        |whole: &Rated, time: Interval| rated(Slab::of(system, whole.slab.tube.clone(), time, &goes_on)?);
    let (all, _) = refined(all, limits, budget, &half, &goes_on);
    let peak = |i: usize| largest(&all, |rated| rated.bound(i));
    Some(Peaks {
        bound: (0..n).map(|i| peak(i).0).collect(),
        time: (0..n).map(|i| peak(i).1).collect(),
        nominal: (0..n)
            .map(|i| largest(&all, |rated| rated.slab.nominal_drifts[2 * n + i].midpoint().abs()).0)
            .collect(),
    })
}
