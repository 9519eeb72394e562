//! How far a scenario's motion can be from its reference, by a funnel: for every robot within the tolerances of its file, under any torque up to
//! given ones on links and motors.
//!
//! The statement: of the law in continuous time with true states, from the scenario's start until its end, the errors are in the ellipsoids
//! of the funnel, and so within the bounds here; see [`Funnel`].

pub mod check;
mod file;
mod inside;

use std::sync::Arc;

use flexure_core::scalar::Interval;
use serde::Serialize;

use crate::files::Problems;
use crate::files::number::{engineering, short};
use crate::progress::Progress;
use crate::prove::along::{Exceeding, Limit, Peaks, beyond, enclosed, limits, peaks, start_errors};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::followed::Given;
use crate::prove::engine::envelope::funnel::{Funnel, FunnelRequest, Open, extents};
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::prove::robust::inside::Inside;
use crate::scenario::Scenario;

/// Bounds over the whole run, one per joint.
#[derive(Clone, Debug, Serialize)]
pub struct Robust {
    /// The torques are so many times those that were asked about.
    pub times: f64,
    /// The largest unknown torques on links \[N m\].
    pub link_torque: Vec<f64>,
    /// The largest unknown torques on motors \[N m\].
    pub motor_torque: Vec<f64>,
    /// What is in the way of larger ones, where the largest were looked for.
    pub binding: Option<Binding>,
    /// |q̃_i| in rad, links then motors.
    pub error: Vec<f64>,
    /// |s_i| \[rad/s\], links then motors.
    pub velocity_error: Vec<f64>,
    /// Errors up to so many times those of the funnel come back into it: V − 1 decays for V = zᵀ X⁻¹ z > 1.
    pub room: f64,
    /// Rate of that, at the slowest time of the run \[1/s\].
    pub rate: f64,
    /// Link speeds |q̇_l| \[rad/s\].
    pub velocity: Peaks,
    /// Deflections of the springs |q_m − q_l| in rad.
    pub deflection: Peaks,
    /// Motor torques |u_m| \[N m\].
    pub torque: Peaks,
    /// How fast they change, |u̇_m| \[N m/s\].
    pub torque_rate: Peaks,
    /// Verdicts on the limits in the robot's file, joint by joint: proved that they are not reached, or undecided.
    pub limits: Vec<Limit>,
    /// Slabs of time that the funnel has.
    pub slabs: usize,
    /// The errors over time.
    pub profile: Profile,
    /// What is left open of the robot, and what it feels.
    #[serde(skip)]
    pub spread: Spread,
    /// The funnel, slab by slab.
    #[serde(skip)]
    pub funnel: Arc<Vec<Given>>,
}

impl Robust {
    /// Whether the robot has limits, and all of them were proved not to be reached.
    pub fn keeps_limits(&self) -> bool {
        !self.limits.is_empty() && self.limits.iter().all(|limit| limit.verdict.proved().is_some())
    }
}

/// Bounds of position errors, part by part of the run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Profile {
    /// Where each part ends in s; the first begins at 0.
    pub end: Vec<f64>,
    /// |q̃_i| in rad in each part, links then motors: a list for each i.
    pub error: Vec<Vec<f64>>,
}

/// What is in the way of a funnel in which no limit acts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Binding {
    /// Under so many times the torques that were asked about.
    pub times: f64,
    /// Index of the joint from 0 whose limit may act; none where there is no funnel.
    pub joint: Option<usize>,
    /// The key of its limit in robot files.
    pub key: Option<&'static str>,
    /// When, and how far, in words with numbers.
    pub at: String,
}

/// Why there is no funnel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoFunnel {
    /// In words with numbers.
    pub at: String,
}

/// Length of a slab in s where nothing asks for shorter ones, and how many there are at least.
const SLAB: f64 = 0.02;
const FEWEST: f64 = 64.0;

/// Slabs of a funnel of `joints` joints where nobody says how many: about half a minute.
fn usual_slabs(joints: usize) -> usize {
    (100_000 / joints.pow(3)).max(1)
}

/// Errors so much larger than the funnel's are to come back into it.
const ROOM: f64 = 1.2;

/// Link errors from which on a number says nothing, in rad.
const FAR: f64 = 1e3;

/// How often the torques are doubled or halved at most, to a funnel in which no limit acts and one in which one may.
const DOUBLED: usize = 8;

/// How often what lies between is halved then: to within 1.6 %.
const HALVED: usize = 6;

/// Funnels that are looked for, about, for the largest torques.
const LOOKED_FOR: f64 = 10.0;

/// Parts of the run that errors are told of at most.
const PARTS: usize = 240;

/// Part of the work that the funnel takes, about; what the robot may do in it takes the rest.
const SHARE: f64 = 0.7;

/// The bounds for `scenario` with what `spread` leaves open, by a funnel of at most so many `slabs`, or as many as are usual. None where
/// `progress` breaks it off.
///
/// # Errors
/// As [`along`](crate::prove::along::along).
pub fn robust(
    scenario: &Scenario,
    spread: &Spread,
    slabs: Option<usize>,
    progress: Progress<'_>,
) -> Result<Option<Result<Robust, NoFunnel>>, Problems> {
    let system = enclosed(scenario)?;
    Ok(bounds(scenario, &*system, spread, slabs, progress))
}

/// The bounds under the largest torques under which no limit of the robot acts: torques of `spread` times a number, tolerances as they are.
/// A limiter at exactly those limits then never acts: what is bounded is the motion of the loop with it, too. One with smaller limits of its
/// own is not looked at.
/// None where `progress` breaks it off.
///
/// # Errors
/// As [`robust`].
pub fn up_to_limits(
    scenario: &Scenario,
    spread: &Spread,
    slabs: Option<usize>,
    progress: Progress<'_>,
) -> Result<Option<Result<Robust, NoFunnel>>, Problems> {
    let system = enclosed(scenario)?;
    let mut done = 0.0;
    let at = |times: f64| {
        let spread = spread.with_torques_times(times);
        let part = |part: f64| progress(((done + part) / LOOKED_FOR).min(1.0));
        let found = bounds(scenario, &*system, &spread, slabs, &part);
        done += 1.0;
        found.map(|found| found.map(|found| Robust { times, ..found }))
    };
    Ok(largest(at))
}

/// The largest number that `at` has a funnel for in which no limit acts; where there is none, what it says of the smallest that was tried.
fn largest(mut at: impl FnMut(f64) -> Option<Result<Robust, NoFunnel>>) -> Option<Result<Robust, NoFunnel>> {
    let [mut within, mut beyond] = [None, None];
    let mut look = |times: f64, within: &mut Option<_>, beyond: &mut Option<_>| {
        let found = at(times)?;
        let place = if keeps_limits(&found) { within } else { beyond };
        *place = Some((times, found));
        Some(())
    };
    let mut times = 1.0;
    for _ in 0..DOUBLED {
        look(times, &mut within, &mut beyond)?;
        times *= match (&within, &beyond) {
            (Some(_), Some(_)) => break,
            (Some(_), None) => 2.0,
            _ => 0.5,
        };
    }
    for _ in 0..HALVED {
        let (Some((low, _)), Some((high, _))) = (&within, &beyond) else { break };
        let between = 0.5 * (low + high);
        look(between, &mut within, &mut beyond)?;
    }
    match (within, beyond) {
        (Some((_, Ok(robust))), beyond) => {
            Some(Ok(Robust { binding: beyond.map(|(times, found)| Binding::of(times, &found)), ..robust }))
        }
        (_, beyond) => beyond.map(|(times, found)| {
            found.map_err(|none| NoFunnel {
                at: format!("under {times} times those torques, the smallest that were tried, {}", none.at),
            })
        }),
    }
}

/// Whether there is a funnel, and no limit acts in it.
fn keeps_limits(found: &Result<Robust, NoFunnel>) -> bool {
    found.as_ref().is_ok_and(|found| found.limits.iter().all(|limit| limit.verdict.proved().is_some()))
}

fn bounds(
    scenario: &Scenario,
    system: &dyn TrackingLoop,
    spread: &Spread,
    slabs: Option<usize>,
    progress: Progress<'_>,
) -> Option<Result<Robust, NoFunnel>> {
    let duration = scenario.bounds(scenario.duration).hi();
    let request = FunnelRequest {
        spread: spread.clone(),
        duration,
        start: start_errors(scenario, system).concat(),
        slab: SLAB.min(duration / FEWEST),
        room: ROOM,
        most: slabs.unwrap_or_else(|| usual_slabs(system.joints())),
    };
    let found = Funnel::along(system, &request, &|fraction| progress(SHARE * fraction))?;
    let funnel = match found {
        Ok(funnel) => funnel,
        Err(open) => return Some(Err(no_funnel(&open, &request))),
    };
    let rate = funnel.rate();
    let given: Vec<_> = funnel.pieces.into_iter().map(Given::of).collect();
    let rest = |fraction: f64| progress(SHARE + (1.0 - SHARE) * fraction);
    let seen = Inside::of(scenario, system, spread, &given, &rest)?;
    let about = About { spread, rate, room: ROOM };
    Some(Ok(Robust::new(scenario, system.joints(), given, &about, &seen)))
}

fn no_funnel(open: &Open, request: &FunnelRequest) -> NoFunnel {
    let largest = open.error.iter().copied().fold(0.0, f64::max);
    let time = short(open.time, 4);
    let at = if open.is_spent {
        format!(
            "at t = {time} s of {} s all {} slabs of time were used up; --slabs allows more",
            short(request.duration, 4),
            request.most
        )
    } else if largest < FAR {
        format!(
            "at t = {time} s link errors beyond {} rad were not shown to stay bounded",
            engineering(largest)
        )
    } else {
        format!("at t = {time} s no bound of the errors was found")
    };
    NoFunnel { at }
}

impl Binding {
    /// What `found` lacks, under so many times the torques.
    fn of(times: f64, found: &Result<Robust, NoFunnel>) -> Self {
        let of = |limit: &Limit| match &limit.verdict {
            Verdict::Undecided(Undecided { at, .. }) => {
                Some((Some(limit.joint), Some(limit.key), at.clone()))
            }
            _ => None,
        };
        let (joint, key, at) = match found {
            Err(none) => (None, None, none.at.clone()),
            Ok(found) => found.limits.iter().find_map(of).unwrap_or_default(),
        };
        Self { times, joint, key, at }
    }
}

impl Profile {
    /// Of the first `count` errors.
    fn of(funnel: &[Given], count: usize) -> Self {
        let each = funnel.len().div_ceil(PARTS).max(1);
        let part = |slabs: &[Given]| {
            Some((slabs.last()?.time().hi(), extents(slabs.iter().map(|slab| &slab.passage))))
        };
        let parts: Vec<_> = funnel.chunks(each).filter_map(part).collect();
        let error = |i: usize| parts.iter().map(|(_, extents)| extents[i]).collect();
        Self { end: parts.iter().map(|(end, _)| *end).collect(), error: (0..count).map(error).collect() }
    }
}

/// What a funnel is of, and how fast errors come back into it.
struct About<'a> {
    spread: &'a Spread,
    rate: f64,
    room: f64,
}

impl Robust {
    fn new(scenario: &Scenario, n: usize, funnel: Vec<Given>, about: &About<'_>, seen: &Inside) -> Self {
        let Inside { course, torque_rate } = seen;
        let extents = extents(funnel.iter().map(|slab| &slab.passage));
        let (error, velocity_error) = extents.split_at(2 * n);
        let kept = |(bound, time): (f64, f64), limit: f64, seen: f64| -> Verdict<f64, Exceeding> {
            let exact: Interval = scenario.robot.bounds(limit);
            if bound <= exact.lo() {
                return Verdict::Proved(bound);
            }
            Verdict::Undecided(Undecided { at: beyond(bound, time, limit, seen), spent: course.spent })
        };
        let verdict = |k: usize, limit: f64| kept(course.bound(k), limit, course.seen(k).0);
        let rate_limit = |(joint, &limit): (usize, &f64)| {
            let found = (torque_rate.bound[joint], torque_rate.time[joint]);
            let verdict = || kept(found, limit, torque_rate.nominal[joint]);
            limit.is_finite().then(|| Limit { joint, key: "torque_rate_limit", limit, verdict: verdict() })
        };
        let mut limits = limits(scenario, n, &verdict);
        limits.extend(scenario.robot.limits.torque_rate.iter().enumerate().filter_map(rate_limit));
        limits.sort_by_key(|limit| limit.joint);
        let [velocity, deflection, torque] = peaks(course, n);
        let largest = |torques: &[Interval]| torques.iter().map(|x| x.magnitude()).collect();
        Self {
            times: 1.0,
            link_torque: largest(&about.spread.link_torque),
            motor_torque: largest(&about.spread.motor_torque),
            binding: None,
            error: error.to_vec(),
            velocity_error: velocity_error.to_vec(),
            room: about.room,
            rate: about.rate,
            velocity,
            deflection,
            torque,
            torque_rate: torque_rate.clone(),
            limits,
            slabs: funnel.len(),
            profile: Profile::of(&funnel, 2 * n),
            spread: about.spread.clone(),
            funnel: Arc::new(funnel),
        }
    }
}
