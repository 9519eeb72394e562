//! How far motions of a scenario's sampled loop can be from its run, and how fast they come closer: the law at its control period, with its delay,
//! its torques held and within limits, on readings in counts and filtered velocities.

use flexure_core::scalar::{Interval, Scalar};
use serde::Serialize;

use crate::files::number::{engineering, short};
use crate::files::{Problem, Problems};
use crate::imperfections::stages::split;
use crate::imperfections::{
    Bias, Delay, Encoder, Imperfection, Saturation, Side, TorqueRate, VelocityFilter,
};
use crate::progress::Progress;
use crate::prove::closed_loop::along_reference;
use crate::prove::engine::sampled_data::period::{Before, HeldLoop};
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::sensors::{Filter, Sensors};
use crate::prove::engine::sampled_data::tube::{At, Ends, Step, TubeRequest, Why, tube};
use crate::prove::engine::sampled_data::watch::{Beyond, Limit, Passes, Readings};
use crate::sampled;
use crate::scenario::{GuardSettings, Hold, Scenario};
use crate::simulate::acting_limits;
use crate::units::{self, Unit};

/// A tube around the run, in which motions come closer. Where readings are off, the run is the one on exact readings.
#[derive(Clone, Debug, Serialize)]
pub struct SampledTube {
    /// Two motions in the tube come closer at this rate in every control period, in its own norms [1/s]; where readings are off, two of the same errors.
    pub rate: f64,
    /// On the whole run [1/s].
    pub mean_rate: f64,
    /// How far motions that start in the tube are from the run at any control instant, at most: positions in rad, links then motors.
    pub error: Vec<f64>,
    /// How far positions of links, then motors, may be off at the start each alone, in rad.
    pub alone: Vec<f64>,
    /// How far links are from the reference at the control instants of the last quarter of the file's run, in rad.
    pub tracking: Vec<f64>,
    /// How far readings of positions are off at most, links then motors, in rad; empty where they are exact.
    pub readings: Vec<f64>,
    /// Whether velocities are filtered differences of readings.
    pub filtered: bool,
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
    pub ends: [Section; 2],
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
        None => return none(not_looked_at(scenario)),
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
    let passes = passes(scenario);
    let sensors = sensors(scenario);
    let of = HeldLoop {
        system: &*system,
        sensors: &sensors,
        period,
        waiting,
        offset: (offset > 0.0).then(|| exact - whole_periods),
        passes: &passes,
    };
    let initial = &scenario.initial;
    // The run begins at the decimals of the file, with the springs holding the links (`simulate::assembly`).
    let start = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].into_iter().flatten();
    let start: Vec<_> = start.map(|&x| scenario.bounds(x)).collect();
    let begin = of.started(&start);
    let request = TubeRequest { periods: scenario.periods() as usize, extents: error.to_vec(), rate, start };
    let mut found = Findings::new(n);
    let done = tube(&of, &request, progress, &mut |At { k, section, law, step }| {
        let [run, read] = found.runs.unwrap_or_else(|| [section.reach(&begin); 2]).map(Interval::point);
        raise(&mut found.largest, section.reaches(Interval::ONE + run));
        raise(&mut found.torque, law.largest());
        if k == 0 {
            let on_their_way = of.on_their_way(&Before::over(&of, section).state).ranges(&law.sizes);
            let on_their_way: Vec<_> = on_their_way.iter().map(|u| u.magnitude()).collect();
            on_their_way.chunks(n).for_each(|torques| raise(&mut found.torque, torques.iter().copied()));
        }
        if 4 * k >= 3 * request.periods {
            let reference = system.reference(period * Interval::point(k as f64));
            let off = reference.iter().zip(&section.center).zip(section.reaches(read));
            let off = off.map(|((q, &c), reach)| {
                (Interval::point((Interval::point(c) - q[0]).magnitude()) + Interval::point(reach)).hi()
            });
            raise(&mut found.tracking, off);
        }
        if let Some(Step { growth, offset, noise }) = step {
            let [growth, offset, noise] = [growth, offset, noise].map(Interval::point);
            // From below: a growth is known from above.
            let rate = -growth.ln() / period;
            found.slowest = found.slowest.min(rate.lo());
            found.rates += rate;
            found.runs = Some([growth * run + offset, growth * read + offset + noise].map(Interval::hi));
        }
    });
    let ends = match done {
        None => return Ok(None),
        Some(Err(ends)) => return Ok(Some(Err(why(scenario, rate, &sensors, &ends)))),
        Some(Ok(ends)) => ends,
    };
    let shifted = |i: usize| {
        let unit = |k: usize| if i == k { Interval::ONE } else { Interval::ZERO };
        of.started(&(0..4 * n).map(unit).collect::<Vec<_>>())
    };
    // As far as the run, which need not be in the middle, leaves room.
    let room = Interval::ONE - Interval::point(ends[0].reach(&begin));
    Ok(Some(Ok(SampledTube {
        rate: found.slowest,
        mean_rate: (found.rates / Interval::point(request.periods as f64)).lo(),
        alone: (0..2 * n).map(|i| (Interval::point(ends[0].alone(&shifted(i))) * room).lo()).collect(),
        error: found.largest,
        tracking: found.tracking,
        readings: sensors.off.clone(),
        filtered: sensors.filter.is_some(),
        torque: found.torque,
        period: seconds,
        delay,
        periods: request.periods,
        ends,
    })))
}

/// What is found along a tube.
struct Findings {
    slowest: f64,
    /// The sum of the rates of all periods.
    rates: Interval,
    /// |y| of the run on exact readings, which is only nearly the middle, and of that of the file.
    runs: Option<[f64; 2]>,
    largest: Vec<f64>,
    tracking: Vec<f64>,
    torque: Vec<f64>,
}

impl Findings {
    fn new(n: usize) -> Self {
        Self {
            slowest: f64::INFINITY,
            rates: Interval::ZERO,
            runs: None,
            largest: vec![0.0; 2 * n],
            tracking: vec![0.0; n],
            torque: vec![0.0; n],
        }
    }
}

/// What guard and drives of `scenario` do nothing about.
fn passes(scenario: &Scenario) -> Passes {
    let n = scenario.robot.joint_count();
    let below = |all: &[f64]| -> Vec<f64> {
        all.iter().map(|&x| if x.is_finite() { scenario.bounds(x).lo() } else { x }).collect()
    };
    let rates =
        scenario.imperfections.iter().filter_map(Imperfection::of::<TorqueRate>).map(|rate| &rate.limit);
    let rates = rates.chain(scenario.guard.as_ref().map(|guard| &guard.torque_rate_limit));
    let mut step = vec![f64::INFINITY; n];
    for rate in rates {
        step.iter_mut().zip(rate).for_each(|(step, &rate)| *step = step.min(rate));
    }
    let in_a_period = |rate: &f64| {
        if rate.is_finite() {
            (scenario.bounds(*rate) * scenario.bounds(scenario.control_period)).lo()
        } else {
            *rate
        }
    };
    let readings = scenario.guard.as_ref().map(|guard| {
        let believed = &guard.believed;
        Readings {
            position: believed.position.clone(),
            speed: below(&believed.speed),
            deflection: below(&believed.deflection),
            jump: below(&believed.jump),
            travel: scenario.bounds(believed.frozen.1).lo(),
        }
    });
    Passes {
        torque: below(&acting_limits(scenario)),
        torque_step: step.iter().map(in_a_period).collect(),
        readings,
    }
}

/// What the law of `scenario` sees.
fn sensors(scenario: &Scenario) -> Sensors {
    let each = || scenario.imperfections.iter();
    let mut off = Vec::new();
    for encoder in each().filter_map(Imperfection::of::<Encoder>) {
        off.resize(2 * scenario.robot.joint_count(), 0.0);
        for (side, off) in Side::ALL.into_iter().zip(off.chunks_mut(scenario.robot.joint_count())) {
            let Some(counts) = encoder.resolution(side) else { continue };
            // To the nearest count; with dither, half a count is added to a number that far from it.
            let part = if encoder.dither { 1.0 } else { 0.5 };
            off.iter_mut().zip(counts).for_each(|(off, &count)| {
                *off = (Interval::point(part) * scenario.bounds(count)).hi();
            });
        }
    }
    for Bias { link, motor } in each().filter_map(Imperfection::of::<Bias>) {
        off.resize(2 * scenario.robot.joint_count(), 0.0);
        off.iter_mut().zip(link.iter().chain(motor)).for_each(|(off, &bias)| {
            *off = (Interval::point(*off) + Interval::point(scenario.bounds(bias).magnitude())).hi();
        });
    }
    if off.iter().all(|&off| off == 0.0) {
        off.clear();
    }
    let filter = each().find_map(Imperfection::of::<VelocityFilter>).map(|filter| {
        let [feedback, forward] = filter.low_pass(scenario.control_period).coefficients();
        Filter { feedback: feedback.map(Interval::point), forward: forward.map(Interval::point) }
    });
    Sensors { off, filter }
}

fn raise(most: &mut [f64], with: impl IntoIterator<Item = f64>) {
    most.iter_mut().zip(with).for_each(|(most, x)| *most = most.max(x));
}

/// Why nobody looks at small errors.
fn not_looked_at(scenario: &Scenario) -> String {
    let why = sampled::not_looked_at(scenario).unwrap_or_default();
    why.strip_prefix("sampled loop: ").map_or(why.clone(), str::to_owned)
}

/// Where a tube ends, in words.
fn why(scenario: &Scenario, rate: f64, sensors: &Sensors, ends: &Ends) -> NoTube {
    let time = format!("at t = {} s", short(ends.period as f64 * scenario.control_period, 5));
    let unit = |unit: Unit, joint: usize| unit.of(scenario.robot.joints[joint].kind).plain;
    let other = if sensors.off.is_empty() { "a smaller one" } else { "another width" };
    let at = match ends.why {
        Why::NotStable => {
            format!("at the start small errors do not shrink at {} 1/s", engineering(rate))
        }
        Why::Unbounded => format!(
            "{time} motions in it were not shown to stay bounded for a control period; {other} may have one"
        ),
        Why::Grows => format!("{time} motions in it were not shown to come closer; {other} may have one"),
        Why::Widens(link, reach) => format!(
            "{time} it would have to be so wide that link {} is up to {} {} from the run; {other} may have one",
            link + 1,
            engineering(reach),
            unit(units::ANGLE, link)
        ),
        Why::Missed => {
            format!(
                "{time} rounding of its middle is as much as motions come closer by; a larger one may have one"
            )
        }
        Why::Beyond(Beyond { limit, joint, found, passes }) => {
            let (what, of, who) = match limit {
                Limit::Torque => ("the torque", units::TORQUE, "and the limit is"),
                Limit::TorqueStep => {
                    ("a control period's change of the torque", units::TORQUE, "and the limit is")
                }
                Limit::Highest => ("a reading", units::ANGLE, BELIEVES),
                Limit::Lowest => ("minus a reading", units::ANGLE, BELIEVES),
                Limit::Speed => ("a reading of the speed", units::SPEED, BELIEVES),
                Limit::Deflection => ("a reading of the deflection", units::ANGLE, BELIEVES),
                Limit::Jump => ("a control period's change of a reading", units::ANGLE, BELIEVES),
                Limit::Travel => (
                    "what the other side or the reference moves while a reading may stay the same",
                    units::ANGLE,
                    "and the guard takes it to be frozen from",
                ),
            };
            let (found, passes) = (short(found, 5), short(passes, 5));
            let unit = unit(of, joint);
            format!("{time} {what} of joint {} may come to {found} {unit}, {who} {passes} {unit}", joint + 1)
        }
    };
    NoTube { at }
}

const BELIEVES: &str = "and the guard believes up to";

/// Whether tubes of the sampled loop are what such a scenario is.
pub(crate) fn suitable_when_sampled(scenario: &Scenario) -> Result<(), Problems> {
    scenario.vcbc()?;
    match unsuitable(scenario) {
        Some(problem) => Err(problem.into()),
        None => Ok(()),
    }
}

/// The key of what a guard watches that a tube says nothing of.
fn watches_more(guard: &GuardSettings) -> Option<&'static str> {
    let is_finite = |all: &[f64]| all.iter().any(|x| x.is_finite());
    if guard.collision.is_some() {
        Some("collision")
    } else if is_finite(&guard.believed.motor_residual) {
        Some("motor_residual")
    } else if is_finite(&guard.believed.velocity_gap) {
        Some("velocity_gap")
    } else {
        None
    }
}

/// What of `scenario` such a proof does not speak of.
fn unsuitable(scenario: &Scenario) -> Option<Problem> {
    let spoken_of = |imperfection: &&Imperfection| {
        imperfection.of::<Delay>().is_some()
            || imperfection.of::<Saturation>().is_some()
            || imperfection.of::<VelocityFilter>().is_some()
            || imperfection.of::<Encoder>().is_some()
            || imperfection.of::<Bias>().is_some()
            || imperfection.of::<TorqueRate>().is_some()
    };
    let encoders = || scenario.imperfections.iter().filter_map(Imperfection::of::<Encoder>);
    let placed = |side: Side| encoders().any(|encoder| encoder.resolution(side).is_some());
    let mut found: Vec<(&str, String)> = Vec::new();
    let mut add = |is_there: bool, key: &'static str, what: &str| {
        if is_there {
            found.push((key, what.to_owned()));
        }
    };
    add(scenario.hold == Hold::Continuous, "hold", "acts in continuous time");
    for other in scenario.imperfections.iter().filter(|imperfection| !spoken_of(imperfection)) {
        add(true, "imperfection", &format!("has imperfections of kind '{}'", other.kind()));
    }
    add(placed(Side::Link) != placed(Side::Motor), "imperfection", "has encoders on one side of its joints");
    add(scenario.estimator.is_some(), "estimator", "has an estimator");
    add(scenario.disturbance_observer.is_some(), "disturbance_observer", "has a disturbance observer");
    if let Some(key) = scenario.guard.as_ref().and_then(watches_more) {
        add(true, "guard", &format!("has a guard with {key}"));
    }
    for option in scenario.plant.options() {
        add(true, "plant", &format!("has plant.{option}"));
    }
    let &(key, _) = found.first()?;
    let all: Vec<_> = found.into_iter().map(|(_, what)| what).collect();
    let message = format!("this loop {}: tubes of sampled loops do not speak of that", all.join(", "));
    let help = "they are of the law on true states or on encoders and velocity filters, its torques held, late by a delay, under a guard and within limits; leave out --sampled-tube";
    Some(scenario.places.problem(key, "unsupported", message, help))
}
