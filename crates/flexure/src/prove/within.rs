//! What is true of every robot within the tolerances of the robot file, under the law that knows the numbers of the file.
//!
//! The statement: along the scenario's reference, until its end, from every start with W ≤ c,
//!
//! √(2 W(t)) ≤ ν + e^(−μ t) max(√(2 W(0)) − ν, 0),
//!
//! for every robot whose springs, motors and dampers are within their tolerances, springs and dampers even where they change
//! meanwhile. W is made with the numbers of the file. [`Deviation`] has μ and ν for the states with W ≤ c, and c is such that no
//! motion leaves them: ν² ≤ 2 c.

use std::sync::atomic::{AtomicUsize, Ordering};

use flexure_core::scalar::{Interval, Scalar};
use rayon::prelude::*;
use serde::Serialize;

use crate::files::Problems;
use crate::files::number::{engineering, short};
use crate::progress::Progress;
use crate::prove::along::enclosed;
use crate::prove::engine::certificate::{BlockName, Certificate};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::{Bound, Deviation, Spread};
use crate::prove::engine::number::Number;
use crate::robot::Robot;
use crate::scenario::Scenario;

/// What holds of every robot within the tolerances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Within {
    /// μ [1/s]: errors come down at this rate.
    pub rate: f64,
    /// Level of W in J that a run from the scenario's start never leaves.
    pub level: f64,
    /// Level of W in J that it comes to: below every one above this, if the run is long enough.
    pub settles: f64,
    /// Bounds of |q̃_i| in rad at that level, links then motors.
    pub error: Vec<f64>,
    /// Slabs of time that were looked at, at all levels together.
    pub slabs: usize,
}

/// Why nothing was shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Open {
    /// In words with numbers.
    pub at: String,
    /// Slabs of time that were looked at.
    pub slabs: usize,
    /// Whether the accelerations have no finite bounds where the run begins, so that smaller tolerances do not help.
    pub unbounded: bool,
    /// Smaller tolerances of which something was shown.
    pub closer: Option<Closer>,
}

/// What holds of robots within smaller tolerances, and what counts most among them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Closer {
    /// All tolerances times this, a power of one half.
    pub factor: f64,
    /// μ [1/s] there.
    pub rate: f64,
    /// Key in `[tolerances]` of the one that alone makes the largest errors.
    pub key: &'static str,
    /// Its joint, from 0.
    pub joint: usize,
    /// √W that it alone makes errors settle at, over that of all together.
    pub share: f64,
}

/// Tolerances are halved as often as this to find some of which something is shown.
const HALVINGS: i32 = 10;

/// Levels to try, one after the other.
const LEVELS: usize = 24;

/// How far above the level that is needed the next one is.
const ROOM: f64 = 1.2;

/// A level of W in J where a run begins that begins without errors: rounding is more.
const LEAST: f64 = 1e-12;

/// Slabs to begin with.
const FIRST: usize = 32;

/// Slabs that need this share of what the worst one needs are cut with it.
const NEAR: f64 = 0.9;

/// Cutting goes on while it makes the tube this much narrower.
const GAIN: f64 = 0.01;

/// The tolerances of `robot`, and unknown torques on its motors and links.
pub(crate) fn spread(
    robot: &Robot,
    motor_torque: Option<&[Number]>,
    link_torque: Option<&[Number]>,
) -> Spread {
    let enclosed = |values: &[f64]| values.iter().map(|&x| robot.bounds(x)).collect();
    let torque = |torques: Option<&[Number]>| {
        torques.map_or_else(
            || vec![Interval::ZERO; robot.joint_count()],
            |torques| torques.iter().map(Number::bounds).collect(),
        )
    };
    let tolerances = &robot.tolerances;
    Spread {
        stiffness: enclosed(&tolerances.stiffness),
        motor_inertia: enclosed(&tolerances.motor_inertia),
        link_damping: enclosed(&tolerances.link_damping),
        motor_damping: enclosed(&tolerances.motor_damping),
        link_mass: enclosed(&tolerances.link_mass),
        motor_torque: torque(motor_torque),
        link_torque: torque(link_torque),
    }
}

/// What holds of every robot within the tolerances of the scenario's, `certificate` being about the robot of the file and `start`
/// W at the scenario's start, from above. Looks at `budget` slabs of time a level. None where `progress` breaks it off.
///
/// # Errors
/// As [`along`](crate::prove::along::along).
pub fn within(
    scenario: &Scenario,
    certificate: &Certificate,
    start: Option<f64>,
    budget: usize,
    progress: Progress<'_>,
) -> Result<Option<Result<Within, Open>>, Problems> {
    let system = enclosed(scenario)?;
    if !scenario.robot.tolerances.masses_are_none() {
        let at = "masses have tolerances: of those only a funnel says something".to_owned();
        return Ok(Some(Err(Open { at, slabs: 0, unbounded: false, closer: None })));
    }
    let disturbance = certificate.tube.as_ref().map(|tube| &*tube.disturbance);
    let search = Search {
        system: &*system,
        spread: spread(&scenario.robot, disturbance, None),
        rates: rates(certificate),
        duration: scenario.bounds(scenario.duration).hi(),
        budget,
    };
    let largest = certificate.region.level.as_ref().map_or(f64::INFINITY, |level| level.bounds().lo());
    let Some(start) = start.filter(|&start| start <= largest) else {
        let at = "the start is not known to lie in the certificate's invariant set".to_owned();
        return Ok(Some(Err(Open { at, slabs: 0, unbounded: false, closer: None })));
    };
    // Most of it if it succeeds; what is smaller is looked at only where it does not.
    let Some(found) = search.from(start, largest, &|fraction| progress(0.5 * fraction)) else {
        return Ok(None);
    };
    let mut open = match found {
        Err(open) if !open.unbounded => open,
        found => return Ok(Some(found)),
    };
    for halved in 1..=HALVINGS {
        let closer = Search { spread: search.spread.times(0.5_f64.powi(halved)), ..search };
        let watched =
            |fraction: f64| progress(0.5 + 0.5 * (f64::from(halved - 1) + fraction) / f64::from(HALVINGS));
        // Broken off: what was not shown stands without it.
        let Some(found) = closer.from(start, largest, &watched) else { break };
        match found {
            Ok(within) => {
                open.slabs += within.slabs;
                open.closer = closer.counts_most(within.level, &watched).map(|(key, joint, share)| Closer {
                    factor: 0.5_f64.powi(halved),
                    rate: within.rate,
                    key,
                    joint,
                    share,
                });
                break;
            }
            Err(still) => {
                open.slabs += still.slabs;
                if halved == HALVINGS {
                    open.at += "; nor was it of a thousandth of these tolerances";
                }
            }
        }
    }
    Ok(Some(Err(open)))
}

/// Convergence rates of the blocks of W in the order of the errors [1/s].
fn rates(certificate: &Certificate) -> [Interval; 4] {
    [BlockName::PhiL, BlockName::PhiM, BlockName::SigmaL, BlockName::SigmaM].map(|name| {
        let block = certificate.blocks.iter().find(|block| block.block == name);
        block.map_or(Interval::ZERO, |block| Interval::point(block.convergence.bounds().lo()))
    })
}

/// What was found over {W ≤ c} and the whole run.
struct Looked {
    /// None if there is none with a rate above 0.
    bound: Option<Bound>,
    /// A slab over which the accelerations have no finite bounds, whatever the tolerances.
    unbounded: Option<Interval>,
    /// Slabs that were looked at.
    slabs: usize,
}

/// What stays the same from level to level.
#[derive(Clone)]
struct Search<'a> {
    system: &'a dyn TrackingLoop,
    spread: Spread,
    rates: [Interval; 4],
    duration: f64,
    budget: usize,
}

impl Search<'_> {
    /// What holds from W ≤ `start` on, in levels up to `largest`, in J. None where `progress` breaks it off.
    fn from(&self, start: f64, largest: f64, progress: Progress<'_>) -> Option<Result<Within, Open>> {
        let open = |at: String, slabs: usize, unbounded: bool| {
            Some(Err(Open { at, slabs, unbounded, closer: None }))
        };
        let (mut level, mut slabs) = (start.next_up().max(LEAST), 0);
        for tried in 0..LEVELS {
            // Nobody knows how many it takes: each is half of what is left.
            let watched = |fraction: f64| progress(1.0 - 0.5_f64.powf(tried as f64 + fraction));
            let looked = self.at(level, &watched)?;
            slabs += looked.slabs;
            if let Some(time) = looked.unbounded.filter(|_| tried == 0) {
                let at = format!(
                    "where W ≤ {} J the accelerations that the law asks for were not bounded over {} s from t = {} s: no tolerances are \
                     small enough for that",
                    engineering(level),
                    short(time.width(), 3),
                    short(time.lo(), 4)
                );
                return open(at, slabs, true);
            }
            let Some(Bound { rate, length }) = looked.bound else {
                let at = format!(
                    "where W ≤ {} J it was not shown that every robot within the tolerances comes back to the reference",
                    engineering(level)
                );
                return open(at, slabs, false);
            };
            let needed = Interval::point(length).square() * Interval::point(0.5);
            if needed.hi() <= level {
                let [link, motor, _] = self.system.metrics();
                let error = |metric: &Interval| (Interval::point(2.0) * needed / *metric).sqrt().hi();
                let error = link.iter().chain(&motor).map(error).collect();
                return Some(Ok(Within { rate, level, settles: needed.hi(), error, slabs }));
            }
            level = (ROOM * needed.hi()).max(level);
            if level > largest {
                let at = format!(
                    "for all that was shown the differences push W to {} J, beyond the region's level of {} J",
                    engineering(needed.hi()),
                    engineering(largest)
                );
                return open(at, slabs, false);
            }
        }
        let at = format!("no level of W up to {} J was found that holds the motion", engineering(level));
        open(at, slabs, false)
    }

    /// Of the tolerances the one that alone makes the largest errors where W ≤ `level` \[J\]: its key, its joint, and √W that errors
    /// settle at with it alone, over that with all. None where `progress` breaks it off.
    fn counts_most(&self, level: f64, progress: Progress<'_>) -> Option<(&'static str, usize, f64)> {
        let length = |spread: Spread| {
            let alone = Search { spread, ..*self };
            Some(alone.at(level, progress)?.bound.map_or(f64::INFINITY, |bound| bound.length))
        };
        let all = length(self.spread.clone())?;
        let mut most: Option<(&'static str, usize, f64)> = None;
        for (key, joint, spread) in self.spread.one_by_one() {
            let share = length(spread)? / all;
            if most.is_none_or(|(_, _, largest)| share > largest) {
                most = Some((key, joint, share));
            }
        }
        most
    }

    /// What is so over {W ≤ `level`} and the whole run. None where `progress` breaks it off.
    fn at(&self, level: f64, progress: Progress<'_>) -> Option<Looked> {
        let looked_at = AtomicUsize::new(0);
        let done = || looked_at.load(Ordering::Relaxed) as f64 / self.budget.max(1) as f64;
        let goes_on = || progress(done().min(1.0)).is_continue();
        let slab = |time: Interval| {
            let found = Deviation::watched(self.system, &self.spread, level, time, &goes_on);
            looked_at.fetch_add(1, Ordering::Relaxed);
            found
        };
        let first = self.budget.clamp(1, FIRST);
        let cut =
            |i: usize| if i == first { self.duration } else { self.duration * (i as f64 / first as f64) };
        let times = (0..first).into_par_iter();
        let times = times.map(|i| slab(Interval::new(cut(i), cut(i + 1)).unwrap_or(Interval::ENTIRE)));
        let mut slabs: Vec<Deviation> = times.collect::<Option<_>>()?;
        let mut spent = first;
        let mut before = f64::INFINITY;
        loop {
            // How much each slab needs, the most first.
            let mut order: Vec<(usize, f64)> =
                slabs.iter().map(|slab| self.needs(slab)).enumerate().collect();
            order.sort_by(|a, b| b.1.total_cmp(&a.1));
            let worst = order[0].1;
            let gains = worst < before * (1.0 - GAIN) || !worst.is_finite();
            let near = order.iter().take_while(|(_, needs)| *needs >= NEAR * worst);
            let most = self.budget.saturating_sub(spent) / 2;
            let chosen: Vec<usize> = near.take(most).map(|(i, _)| *i).collect();
            if chosen.is_empty() || !gains {
                break;
            }
            before = worst;
            let halves: Vec<Deviation> = chosen
                .par_iter()
                .flat_map(|&i| {
                    let (left, right) = slabs[i].time.split();
                    [left, right]
                })
                .map(slab)
                .collect::<Option<_>>()?;
            spent += halves.len();
            let kept =
                slabs.into_iter().enumerate().filter(|(i, _)| !chosen.contains(i)).map(|(_, slab)| slab);
            slabs = kept.chain(halves).collect();
        }
        let slowest = |a: Option<Bound>, b: Option<Bound>| {
            let (a, b) = (a?, b?);
            Some(Bound { rate: a.rate.min(b.rate), length: a.length.max(b.length) })
        };
        Some(Looked {
            bound: slabs.iter().map(|slab| slab.bound(&self.rates)).reduce(slowest).flatten(),
            unbounded: slabs.iter().find(|slab| !slab.is_bounded()).map(|slab| slab.time),
            slabs: spent,
        })
    }

    /// √(2 W) that the errors of a slab come to.
    fn needs(&self, slab: &Deviation) -> f64 {
        slab.bound(&self.rates).map_or(f64::INFINITY, |bound| bound.length)
    }
}
