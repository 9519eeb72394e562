//! A scenario's motion inside an error tube: bounds of errors, speeds, deflections and torques, and whether they keep the
//! robot's limits.
//!
//! What is bounded is every state with W ≤ c at every time of the run, whatever led there. That a run stays in the tube is
//! said by its certificate, and by [`start_level`] of where it begins.

mod exceeding;

use flexure_core::scalar::{Interval, Scalar};
use serde::Serialize;

use crate::files::number::short;
use crate::files::{Problem, Problems};
use crate::progress::Progress;
use crate::prove::closed_loop::along_reference;
use crate::prove::engine::envelope::closed_loop::{Place, Slope, TrackingLoop};
use crate::prove::engine::envelope::slab::QUANTITIES;
use crate::prove::engine::envelope::tube::{ErrorTube, Tube};
use crate::prove::engine::envelope::witness::candidates;
use crate::prove::engine::envelope::{AlongRequest, Course, course};
use crate::prove::engine::number::Number;
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::scenario::Scenario;

pub use exceeding::Exceeding;

/// What a robot may do along its reference inside a tube: upper bounds, one per joint.
#[derive(Clone, Debug, Serialize)]
pub struct Along {
    /// Level c of W that the run never leaves, in J.
    pub level: f64,
    /// Link position errors |q̃_l| in rad.
    pub error: Vec<f64>,
    /// Link speeds |q̇_l| [rad/s].
    pub velocity: Peaks,
    /// Deflections of the springs |q_m − q_l| in rad.
    pub deflection: Peaks,
    /// Motor torques |u_m| [N m].
    pub torque: Peaks,
    /// Verdicts on the limits in the robot's file, joint by joint.
    pub limits: Vec<Limit>,
    /// Slabs of time that were looked at.
    pub slabs: usize,
}

/// The largest absolute value of a quantity over the run, per joint.
#[derive(Clone, Debug, Serialize)]
pub struct Peaks {
    /// Never exceeded; infinite where none was found.
    pub bound: Vec<f64>,
    /// When it may come closest to that, in s.
    pub time: Vec<f64>,
    /// About the largest value on the reference itself.
    pub nominal: Vec<f64>,
}

/// A limit in the robot's file.
#[derive(Clone, Debug, Serialize)]
pub struct Limit {
    /// Index of the joint, from 0.
    pub joint: usize,
    /// Its key in robot files: `velocity_limit`, `deflection_limit`, `torque_limit`, or of a funnel `torque_rate_limit`.
    pub key: &'static str,
    /// The limit from the robot file, in the unit of the quantity.
    pub limit: f64,
    /// Proved: never exceeded in the tube, with the bound. Refuted: a state in the tube that exceeds it.
    pub verdict: Verdict<f64, Exceeding>,
}

/// Bounds along the reference of `scenario` in the tube {W ≤ `level`}, `level` in J, looking at `budget` slabs of time at
/// most. Where `progress` breaks it off they are those of the slabs so far, which hold and are less tight; none if not all of the
/// run was looked at yet.
///
/// # Errors
/// If the robot has too many joints, the samples of the reference make no path, Π_l is not constant, or the reference's
/// third derivative jumps, which no tube outlives.
pub fn along(
    scenario: &Scenario,
    level: &Number,
    budget: usize,
    progress: Progress<'_>,
) -> Result<Option<Along>, Problems> {
    let level = level.bounds().hi();
    Ok(bounds(scenario, &*enclosed(scenario)?, level, budget, progress))
}

/// An upper bound of W in J at the scenario's initial state: 0 where the robot starts on its reference, but for rounding.
///
/// # Errors
/// As [`along`].
pub fn start_level(scenario: &Scenario) -> Result<f64, Problems> {
    Ok(storage(scenario, &*enclosed(scenario)?))
}

/// The scenario's closed loop over intervals, if bounds can be found for it.
pub(crate) fn enclosed(scenario: &Scenario) -> Result<Box<dyn TrackingLoop>, Problems> {
    suitable(scenario)?;
    along_reference(scenario)
}

/// Whether W is what the bounds take it to be, and continuous.
pub(crate) fn suitable(scenario: &Scenario) -> Result<(), Problems> {
    scenario.vcbc()?;
    if let Some(problem) = uneven_metric(scenario) {
        return Err(problem.into());
    }
    if let Some(jump) = scenario.reference.jump().filter(|jump| jump.derivative <= 3) {
        let message = format!(
            "the third derivative of a {} jumps, and the errors with it: no tube holds them",
            jump.of
        );
        let help = "take septic or nonic";
        return Err(scenario.places.problem("reference.kind", "reference", message, help).into());
    }
    Ok(())
}

/// What to say of a metric that depends on the error, if it does.
pub(crate) fn uneven_metric(scenario: &Scenario) -> Option<Problem> {
    let link = &scenario.vcbc().ok()?.link;
    link.hardens()?;
    let message = "controller.link.metric_hardening is not 0: this needs a constant metric";
    let help = "with a Π_l that depends on the error the rate depends on the speed of the error too: certify with --velocity-error, or \
                leave it out";
    Some(scenario.places.problem("controller.link.metric_hardening", "metric", message, help))
}

/// The limits of `robot` in the order of what is bounded; infinite for none.
pub(crate) fn all_limits(robot: &crate::Robot) -> Vec<Interval> {
    let given = [&robot.limits.velocity, &robot.limits.deflection, &robot.limits.torque];
    given.into_iter().flatten().map(|&limit| robot.bounds(limit)).collect()
}

/// Part of the work that slabs take, about, where states beyond limits are looked for, too.
const COURSE: f64 = 0.6;

fn bounds(
    scenario: &Scenario,
    system: &dyn TrackingLoop,
    level: f64,
    budget: usize,
    progress: Progress<'_>,
) -> Option<Along> {
    let duration = scenario.bounds(scenario.duration).hi();
    let limits_of = all_limits(&scenario.robot);
    let course = course(system, &AlongRequest { level, duration, limits: limits_of, budget }, &|fraction| {
        progress(COURSE * fraction)
    })?;
    let n = system.joints();
    let limits = limits(scenario, n, &|k, limit| {
        let done = k as f64 / (n * QUANTITIES.len()) as f64;
        let is_watched = || progress(COURSE + (1.0 - COURSE) * done).is_continue();
        verdict(scenario, system, &course, level, k, limit, &is_watched)
    });
    let [velocity, deflection, torque] = peaks(&course, n);
    Some(Along {
        level,
        error: ErrorTube::new(system, level, &vec![Interval::ZERO; n]).errors()[..n]
            .iter()
            .map(|e| e.hi())
            .collect(),
        velocity,
        deflection,
        torque,
        limits,
        slabs: course.spent,
    })
}

/// The largest values of each quantity, of `n` joints.
pub(crate) fn peaks(course: &Course, n: usize) -> [Peaks; 3] {
    [0, 1, 2].map(|quantity| {
        let of = |f: &dyn Fn(usize) -> f64| (quantity * n..(quantity + 1) * n).map(f).collect();
        Peaks {
            bound: of(&|k| course.bound(k).0),
            time: of(&|k| course.bound(k).1),
            nominal: of(&|k| course.nominal(k).0),
        }
    })
}

/// The limits in the file of the scenario's robot, of `n` joints, with what `verdict` says of a quantity, by its place among all, and its
/// limit.
pub(crate) fn limits(
    scenario: &Scenario,
    n: usize,
    verdict: &dyn Fn(usize, f64) -> Verdict<f64, Exceeding>,
) -> Vec<Limit> {
    let given = &scenario.robot.limits;
    let given = [
        ("velocity_limit", &given.velocity),
        ("deflection_limit", &given.deflection),
        ("torque_limit", &given.torque),
    ];
    let limit = |(joint, quantity): (usize, usize)| {
        let (key, limit) = (given[quantity].0, given[quantity].1[joint]);
        limit.is_finite().then(|| Limit { joint, key, limit, verdict: verdict(quantity * n + joint, limit) })
    };
    (0..n).flat_map(|i| (0..QUANTITIES.len()).map(move |k| (i, k))).filter_map(limit).collect()
}

/// Whether quantity `k` keeps `limit`; a state that exceeds it is looked for as long as it `goes_on`.
fn verdict(
    scenario: &Scenario,
    system: &dyn TrackingLoop,
    course: &Course,
    level: f64,
    k: usize,
    limit: f64,
    goes_on: &dyn Fn() -> bool,
) -> Verdict<f64, Exceeding> {
    let exact = scenario.robot.bounds(limit);
    let (bound, time) = course.bound(k);
    if bound <= exact.lo() {
        return Verdict::Proved(bound);
    }
    let (seen, _) = course.seen(k);
    let found = (seen > exact.hi() && goes_on())
        .then(|| exceeding::first(scenario, &candidates(system, level, course, k), level, k, exact.hi()))
        .flatten();
    found.map_or_else(
        || Verdict::Undecided(Undecided { at: beyond(bound, time, limit, seen), spent: course.spent }),
        Verdict::Refuted,
    )
}

/// Why a limit is not decided.
pub(crate) fn beyond(bound: f64, time: f64, limit: f64, seen: f64) -> String {
    if bound.is_finite() {
        format!(
            "near t = {} s the bound is {}, above the limit of {limit}; the largest value seen is {}",
            short(time, 5),
            short(bound, 7),
            short(seen, 7)
        )
    } else {
        format!("no finite bound was found near t = {} s", short(time, 5))
    }
}

/// The errors q̃_l, q̃_m in rad, s_l, s_m [rad/s] at the initial state.
pub(crate) fn start_errors(scenario: &Scenario, system: &dyn TrackingLoop) -> [Vec<Interval>; 4] {
    let initial = &scenario.initial;
    let constant =
        |values: &[f64]| values.iter().map(|&x| Slope::value(scenario.bounds(x))).collect::<Vec<_>>();
    let x = Place {
        q_l: constant(&initial.q_l),
        q_m: constant(&initial.q_m),
        v_l: constant(&initial.dq_l),
        v_m: constant(&initial.dq_m),
    };
    let jets = system.reference(Interval::ZERO);
    let q_ld: Vec<_> = jets.iter().map(|jet| std::array::from_fn(|k| Slope::value(jet[k]))).collect();
    let answer = system.command(&x, &q_ld);
    [answer.e_l, answer.e_m, answer.s_l, answer.s_m]
        .map(|errors| errors.iter().map(|e| e.coefficient(0)).collect())
}

/// W at the initial state, from above.
fn storage(scenario: &Scenario, system: &dyn TrackingLoop) -> f64 {
    let [e_l, e_m, s_l, s_m] = start_errors(scenario, system);
    let q_l: Vec<_> = scenario.initial.q_l.iter().map(|&q| scenario.bounds(q)).collect();
    let [link, motor, inertia] = system.metrics();
    let form = |metric: &[Interval], e: &[Interval]| {
        metric.iter().zip(e).fold(Interval::ZERO, |sum, (&metric, e)| sum + metric * e.square())
    };
    let twice =
        form(&link, &e_l) + form(&motor, &e_m) + form(&inertia, &s_m) + system.link_energy(&q_l, &s_l);
    (twice * Interval::point(0.5)).hi()
}
