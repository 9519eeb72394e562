//! How far motions of a scenario's sampled loop can be from its run, and how fast they come closer: the law at its control period, with its delay,
//! its torques held and within limits.

use flexure_core::scalar::{Interval, Scalar};
use serde::Serialize;

use crate::files::number::{engineering, short};
use crate::files::{Problem, Problems};
use crate::imperfections::stages::split;
use crate::imperfections::{Delay, Imperfection, Saturation};
use crate::progress::Progress;
use crate::prove::closed_loop::along_reference;
use crate::prove::engine::sampled_data::ellipsoid::Ellipsoid;
use crate::prove::engine::sampled_data::period::HeldLoop;
use crate::prove::engine::sampled_data::tube::{Ends, TubeRequest, Why, tube};
use crate::sampled;
use crate::scenario::{Hold, Scenario};

/// A tube around the run, in which motions come closer.
#[derive(Clone, Debug, Serialize)]
pub struct SampledTube {
    /// Two motions in the tube come closer at this rate in every control period, in its own norms [1/s].
    pub rate: f64,
    /// On the whole run [1/s].
    pub mean_rate: f64,
    /// How far motions that start in the tube are from the run at any control instant, at most: positions in rad, links then motors.
    pub error: Vec<f64>,
    /// How far positions of links, then motors, may be off at the start each alone, in rad.
    pub alone: Vec<f64>,
    /// How far links are from the reference at the control instants of the last quarter of the run, in rad.
    pub tracking: Vec<f64>,
    /// Largest motor torques |u_m| that the law asks for in the tube [N m].
    pub torque: Vec<f64>,
    /// Control period in s.
    pub period: f64,
    /// How late torques are in s.
    pub delay: f64,
    /// Control periods.
    pub periods: usize,
    /// The tube at the first and the last control instant.
    #[serde(skip)]
    pub ends: [Ellipsoid; 2],
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoTube {
    /// In words with numbers.
    pub at: String,
}

/// The rate that is looked for, as a part of the rate at which small errors decay.
const PART: f64 = 0.6;

/// What is shown of `scenario` in a tube that link positions reach so far in, each its number of `error` in rad. None where `progress` breaks it off.
///
/// # Errors
/// Where nothing can be shown of such a loop: with the place and the reason.
pub fn sampled_tube(
    scenario: &Scenario,
    error: &[f64],
    progress: Progress<'_>,
) -> Result<Option<Result<SampledTube, NoTube>>, Problems> {
    suitable_when_sampled(scenario)?;
    let none = |at: String| Ok(Some(Err(NoTube { at })));
    let rate = match sampled::probe(scenario)? {
        Some(found) if found.stable => PART * found.rate,
        Some(_) => return none("small errors do not shrink in it".to_owned()),
        None => return none(sampled::not_looked_at(scenario).unwrap_or_default()),
    };
    let n = scenario.robot.joint_count();
    let system = along_reference(scenario)?;
    let delays = || scenario.imperfections.iter().filter_map(Imperfection::of::<Delay>);
    let (delay, seconds) = (delays().map(Delay::total).sum::<f64>(), scenario.control_period);
    let period = scenario.bounds(seconds);
    let (waiting, offset) = split(delay, seconds);
    let exact = delays().fold(Interval::ZERO, |sum, delay| {
        sum + scenario.bounds(delay.computation) + scenario.bounds(delay.actuation)
    });
    let whole_periods = Interval::point(waiting.saturating_sub(1) as f64) * period;
    let limits = scenario.drive_limits();
    let limits: Option<Vec<f64>> =
        limits.map(|limits| limits.iter().map(|&limit| scenario.robot.bounds(limit).lo()).collect());
    let of = HeldLoop {
        system: &*system,
        period,
        waiting,
        offset: (offset > 0.0).then(|| exact - whole_periods),
        limits: limits.as_deref(),
    };
    let initial = &scenario.initial;
    let start: Vec<f64> =
        [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].into_iter().flatten().copied().collect();
    // The run begins at the decimals of the file, with the springs holding the links (`simulate::assembly`).
    let exact: Vec<_> = start.iter().map(|&x| scenario.bounds(x)).collect();
    let springs: Vec<_> = (0..n)
        .map(|i| scenario.robot.bounds(scenario.robot.stiffness[i]) * (exact[n + i] - exact[i]))
        .collect();
    let request = TubeRequest {
        torque: springs.iter().map(|torque| torque.midpoint()).collect(),
        periods: scenario.periods() as usize,
        extents: error.to_vec(),
        rate,
        start,
    };
    let mut found = Findings::new(n);
    let begin = [exact, springs.repeat(waiting)].concat();
    let done = tube(&of, &request, progress, &mut |k, ellipsoid, passage, step| {
        let run = found.run.map_or_else(|| ellipsoid.reach(&begin), Interval::hi);
        // From below: a growth is known from above.
        let rate = -Interval::point(step.growth).ln() / period;
        found.slowest = found.slowest.min(rate.lo());
        found.rates += rate;
        found.at(ellipsoid, run);
        raise(&mut found.torque, passage.law.largest());
        if 4 * k >= 3 * request.periods {
            let off = passage.law.errors.iter().zip(ellipsoid.extents()).take(n);
            let off = off.map(|(e, extent)| {
                (Interval::point(e.magnitude()) + Interval::point(extent) * Interval::point(run)).hi()
            });
            raise(&mut found.tracking, off);
        }
        let next = Interval::point(step.growth) * Interval::point(run) + Interval::point(step.offset);
        found.run = Some(next);
        found.first.get_or_insert_with(|| ellipsoid.clone());
    });
    Ok(done.map(|done| {
        let last = done.map_err(|ends| why(scenario, rate, &ends))?;
        let first = found.first.clone().unwrap_or_else(|| last.clone());
        found.at(&last, found.run.map_or(0.0, Interval::hi));
        // As far as the run, which need not be in the middle, leaves room.
        let room = Interval::ONE - Interval::point(first.reach(&begin));
        Ok(SampledTube {
            rate: found.slowest,
            mean_rate: (found.rates / Interval::point(request.periods as f64)).lo(),
            alone: (0..2 * n).map(|i| (Interval::point(first.alone(i)) * room).lo()).collect(),
            error: found.largest,
            tracking: found.tracking,
            torque: found.torque,
            period: seconds,
            delay,
            periods: request.periods,
            ends: [first, last],
        })
    }))
}

/// What is found along a tube.
struct Findings {
    slowest: f64,
    /// The sum of the rates of all periods.
    rates: Interval,
    /// |y| of the run, which is only nearly the middle.
    run: Option<Interval>,
    largest: Vec<f64>,
    tracking: Vec<f64>,
    torque: Vec<f64>,
    first: Option<Ellipsoid>,
}

impl Findings {
    fn new(n: usize) -> Self {
        Self {
            slowest: f64::INFINITY,
            rates: Interval::ZERO,
            run: None,
            largest: vec![0.0; 2 * n],
            tracking: vec![0.0; n],
            torque: vec![0.0; n],
            first: None,
        }
    }

    /// An ellipsoid, with the run at |y| = `run`: motions in it are as far from that as from the middle, and the run's own distance more.
    fn at(&mut self, ellipsoid: &Ellipsoid, run: f64) {
        let most = Interval::ONE + Interval::point(run);
        raise(&mut self.largest, ellipsoid.extents().into_iter().map(|e| (Interval::point(e) * most).hi()));
    }
}

fn raise(most: &mut [f64], with: impl IntoIterator<Item = f64>) {
    most.iter_mut().zip(with).for_each(|(most, x)| *most = most.max(x));
}

/// Where a tube ends, in words.
fn why(scenario: &Scenario, rate: f64, ends: &Ends) -> NoTube {
    let time = short(ends.period as f64 * scenario.control_period, 5);
    let small = "a smaller one may have one";
    let at = match ends.why {
        Why::NotStable => {
            format!("at the start small errors do not shrink at {} 1/s", engineering(rate))
        }
        Why::Unbounded => {
            format!(
                "at t = {time} s motions in it were not shown to stay bounded for a control period; {small}"
            )
        }
        Why::Grows => {
            format!("at t = {time} s motions in it were not shown to come closer; {small}")
        }
        Why::Widens(reach) => format!(
            "at t = {time} s a tube of motions that come closer was shown only with links up to {} rad from the run; {small}",
            engineering(reach)
        ),
        Why::Limited(joint, torque) => format!(
            "at t = {time} s the torque of joint {} may come to {} N m, beyond its limit of {} N m",
            joint + 1,
            short(torque, 5),
            scenario.drive_limits().map_or(f64::INFINITY, |limits| limits[joint])
        ),
    };
    NoTube { at }
}

/// Whether tubes of the sampled loop are what such a scenario is.
pub(crate) fn suitable_when_sampled(scenario: &Scenario) -> Result<(), Problems> {
    scenario.vcbc()?;
    match unsuitable(scenario) {
        Some(problem) => Err(problem.into()),
        None => Ok(()),
    }
}

/// What of `scenario` such a proof does not speak of.
fn unsuitable(scenario: &Scenario) -> Option<Problem> {
    let spoken_of = |imperfection: &&Imperfection| {
        imperfection.of::<Delay>().is_some() || imperfection.of::<Saturation>().is_some()
    };
    let (key, what) = if scenario.hold == Hold::Continuous {
        ("hold", "acts in continuous time".to_owned())
    } else if let Some(other) = scenario.imperfections.iter().find(|imperfection| !spoken_of(imperfection)) {
        ("imperfection", format!("has imperfections of kind '{}'", other.kind()))
    } else if scenario.estimator.is_some() {
        ("estimator", "has an estimator".to_owned())
    } else if scenario.disturbance_observer.is_some() {
        ("disturbance_observer", "has a disturbance observer".to_owned())
    } else if scenario.guard.is_some() {
        ("guard", "has a guard".to_owned())
    } else if let Some(option) = scenario.plant.options().first() {
        ("plant", format!("has plant.{option}"))
    } else {
        return None;
    };
    let message = format!("this loop {what}: tubes of sampled loops do not speak of that");
    let help = "they are of the law on true states, its torques held, late by a delay, and within limits; leave out --sampled-tube";
    Some(scenario.places.problem(key, "unsupported", message, help))
}
