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
use crate::prove::engine::envelope::{Course, refined};
use crate::scenario::Scenario;

/// Slabs of the funnel that are cut, to see what the robot may do: a part of all, and some.
const CUT: [usize; 2] = [8, 32];

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
    let budget = count + 2 * (count / CUT[0] + CUT[1]);
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
    Some(refined(slabs, limits, budget, &half, &goes_on))
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
        let torque_rate = torque_rates(system, spread, &course, &between(RANGES, 1.0))?;
        Some(Self { course, torque_rate })
    }
}

/// How fast motor torques change in the slabs of `course`.
fn torque_rates(
    system: &dyn TrackingLoop,
    spread: &Spread,
    course: &Course,
    progress: Progress<'_>,
) -> Option<Peaks> {
    let (done, count, n) = (AtomicUsize::new(0), course.slabs.len(), system.joints());
    let goes_on = || progress((done.load(Ordering::Relaxed) as f64 / count as f64).min(1.0)).is_continue();
    let torque = |i: usize| 2 * n + i;
    let fastest = |slab: &Slab| {
        let flow = Flow::over(system, spread, &*slab.tube, slab.time, &goes_on)?;
        done.fetch_add(1, Ordering::Relaxed);
        Some((0..n).map(|i| slab.fastest(torque(i), &flow)).collect::<Vec<_>>())
    };
    let all: Vec<_> = course.slabs.par_iter().map(fastest).collect::<Option<_>>()?;
    let peak = |value: &dyn Fn(usize) -> f64| {
        (0..count).map(|k| (value(k), course.slabs[k].time.midpoint())).fold((0.0, 0.0), |best, next| {
            // What is not a number is no bound.
            if next.0 <= best.0 { best } else { next }
        })
    };
    let bounds: Vec<_> = (0..n).map(|i| peak(&|k| all[k][i])).collect();
    let nominal = |i: usize| peak(&|k| course.slabs[k].nominal_drifts[torque(i)].midpoint().abs()).0;
    Some(Peaks {
        bound: bounds.iter().map(|(bound, _)| *bound).collect(),
        time: bounds.iter().map(|(_, time)| *time).collect(),
        nominal: (0..n).map(nominal).collect(),
    })
}
