//! The largest shares of limits over a run.

use flexure_core::reference::Clock;
use flexure_core::scalar::Interval;

use crate::feasible::bounds::{Bound, LimitKind};
use crate::feasible::track::{Demand, Demands, Track};
use crate::references::{Jump, when};
use crate::scenario::Scenario;

/// The reference of a scenario at a speed.
pub struct PacedReference<'a> {
    scenario: &'a Scenario,
    speed: f64,
    demands: Box<Demands<'a>>,
}

impl<'a> PacedReference<'a> {
    /// The reference of `scenario`, which is that of `track`, at `speed`.
    pub fn new(scenario: &'a Scenario, track: &'a dyn Track, speed: f64) -> Self {
        Self { scenario, speed, demands: track.at_speed(speed) }
    }
}

/// What comes closest to a limit.
#[derive(Clone, Copy, Debug)]
pub struct Peak {
    /// Largest absolute value, in the unit of the quantity.
    pub value: f64,
    /// Time at which it is reached in s.
    pub time: f64,
}

/// For each bound what comes closest, among `samples` intervals of the run and the tops of the humps between them.
pub fn peaks(course: &PacedReference<'_>, bounds: &[Bound], samples: usize) -> Vec<Peak> {
    let mut best: Vec<Option<Peak>> = bounds.iter().map(|_| None).collect();
    visit(course, bounds, samples, &mut |i, peak| {
        let share = |peak: Peak| bounds[i].share(peak.value);
        if best[i].is_none_or(|best| share(best) < share(peak) || share(peak).is_nan()) {
            best[i] = Some(peak);
        }
        true
    });
    best.into_iter().flatten().collect()
}

/// Whether every share stays within what `margin` allows.
pub fn fits(course: &PacedReference<'_>, bounds: &[Bound], samples: usize, margin: f64) -> bool {
    visit(course, bounds, samples, &mut |i, peak| bounds[i].share(peak.value) <= bounds[i].allowed(margin))
}

/// Shows `look` what each bound (by index) is about at each time, until it has seen enough; whether it never had.
fn visit(
    course: &PacedReference<'_>,
    bounds: &[Bound],
    samples: usize,
    look: &mut dyn FnMut(usize, Peak) -> bool,
) -> bool {
    if let Some((time, without_torque)) = jumps(course) {
        for (i, bound) in bounds.iter().enumerate() {
            let infinite = bound.quantity == LimitKind::TorqueRate
                || (without_torque && bound.quantity == LimitKind::Torque);
            if infinite && !look(i, Peak { value: f64::INFINITY, time }) {
                return false;
            }
        }
    }
    let PacedReference { scenario, demands, .. } = course;
    let instant = |k: usize| scenario.duration * k as f64 / samples as f64;
    let mut show = |time: f64, demand: &Demand| {
        bounds.iter().enumerate().all(|(i, bound)| look(i, Peak { value: demand.of(bound), time }))
    };
    let mut window: Vec<Demand> = Vec::with_capacity(3);
    for k in 0..=samples {
        let demand = demands(instant(k));
        if !show(instant(k), &demand) {
            return false;
        }
        window.push(demand);
        let [a, b, c] = &window[..] else { continue };
        for top in tops(bounds, [a, b, c]) {
            let time = scenario.duration * ((k - 1) as f64 + top) / samples as f64;
            if !show(time, &demands(time)) {
                return false;
            }
        }
        window.remove(0);
    }
    true
}

/// Least share at which the top of a hump is looked for.
const NOTABLE: f64 = 0.1;

/// Where the parabolas through three shares have their tops, in samples from the middle one: of each bound whose middle
/// share is the largest of three.
fn tops(bounds: &[Bound], [a, b, c]: [&Demand; 3]) -> Vec<f64> {
    let top = |bound: &Bound| {
        let [a, b, c] = [a, b, c].map(|demand| bound.share(demand.of(bound)));
        let is_hump = b >= a && b >= c && a + c < 2.0 * b && b > NOTABLE && b.is_finite();
        is_hump.then(|| 0.5 * (a - c) / (a - 2.0 * b + c))
    };
    bounds.iter().filter_map(top).collect()
}

/// When the reference asks for a torque that jumps, in s, and whether it even asks for an infinite one.
fn jumps(course: &PacedReference<'_>) -> Option<(f64, bool)> {
    let Jump { derivative, time, .. } = course.scenario.reference.jump()?;
    let speed = Interval::point(course.speed);
    let clock = match course.scenario.time_scaling.and_then(|scaling| scaling.rise) {
        Some(rise) => Clock::FromRest { speed, rise: Interval::point(rise) },
        None => Clock::Steady { speed },
    };
    Some((when(&clock, Interval::point(time)).midpoint(), derivative < 4))
}
