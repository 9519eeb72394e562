//! How far motions of a scenario's sampled loop can be from its run, and how fast they come closer: the law at its control period, with its delay,
//! its torques held and within limits, on readings in counts and filtered velocities.

pub mod beside;
pub mod check;
pub mod file;
mod spoken_of;
mod widest;
mod words;

use std::ops::Add;
use std::sync::Arc;

use flexure_core::scalar::{Interval, Scalar};
use serde::{Deserialize, Serialize};

use crate::files::Problems;
use crate::imperfections::stages::split;
use crate::imperfections::{Delay, Imperfection};
use crate::progress::Progress;
use crate::prove::closed_loop::along_reference;
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::period::{Before, HeldLoop};
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::step::Step;
use crate::prove::engine::sampled_data::tube::{At, Sections, TubeRequest, tube};
use crate::prove::sampled_data::spoken_of::{passes, sensors};
use crate::prove::sampled_data::words::{not_looked_at, why};
use crate::sampled;
use crate::scenario::Scenario;

pub(crate) use spoken_of::{reads_exactly, suitable_when_sampled};
pub use widest::widest_tube;
pub(crate) use widest::{is_quick, strongest_tube};

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
    /// Where links are over time.
    pub profile: TubeProfile,
    /// What was asked for.
    #[serde(skip)]
    pub asked: Asked,
    /// The tube at every control instant.
    #[serde(skip)]
    pub sections: Arc<Vec<Section>>,
}

/// Where links of motions in a tube are beside the reference at control instants, part by part of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TubeProfile {
    /// The last control instant of each part in s; the first begins at 0.
    pub end: Vec<f64>,
    /// The least q_l − q_d in rad in each part: a list for each link.
    pub lowest: Vec<Vec<f64>>,
    /// The largest.
    pub highest: Vec<Vec<f64>>,
}

/// What a search is for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    /// How far link positions reach at the start, in rad, each its number.
    pub extents: Vec<f64>,
    /// The rate [1/s].
    pub rate: f64,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoTube {
    /// In words with numbers, and what else may have one.
    pub at: String,
    /// The same without that advice.
    #[serde(skip)]
    pub not_shown: String,
    /// Which tubes may be there instead.
    #[serde(skip)]
    pub way: Way,
    /// Control periods that were shown.
    #[serde(skip)]
    pub shown: usize,
    /// How many times as far as was asked for links reach after those.
    #[serde(skip)]
    pub wide: f64,
}

/// Which tubes may be there where one is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Narrower ones.
    Narrower,
    /// Wider ones.
    Wider,
    /// None: width is not what is in the way.
    None,
}

/// The rate that is looked for, as a part of the rate at which small errors decay.
const PART: f64 = 0.6;

/// The rate that is looked for in tubes of a loop in which small errors decay at `decay` \[1/s\].
pub(crate) fn rate_in_tubes(decay: f64) -> f64 {
    PART * decay
}

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
    match rate_to_look_for(scenario)? {
        Ok(rate) => followed(scenario, Asked { extents: error.to_vec(), rate }, Sections::Made, progress),
        Err(none) => Ok(Some(Err(none))),
    }
}

/// The rate that is looked for in `scenario` [1/s], or why none is.
fn rate_to_look_for(scenario: &Scenario) -> Result<Result<f64, NoTube>, Problems> {
    Ok(match sampled::probe(scenario)? {
        Some(found) if found.stable => Ok(rate_in_tubes(found.rate)),
        Some(_) => Err(NoTube::at_all("small errors do not shrink in it".to_owned())),
        None => Err(NoTube::at_all(not_looked_at(scenario))),
    })
}

impl NoTube {
    /// Of no width.
    pub(crate) fn at_all(at: String) -> Self {
        Self { not_shown: at.clone(), at, way: Way::None, shown: 0, wide: 1.0 }
    }
}

/// What is shown of `scenario` in sections that are made or given, one for each of its control instants.
fn followed(
    scenario: &Scenario,
    asked: Asked,
    sections: Sections<'_>,
    progress: Progress<'_>,
) -> Result<Option<Result<SampledTube, NoTube>>, Problems> {
    let n = scenario.robot.joint_count();
    let system = along_reference(scenario)?;
    let seconds = scenario.control_period;
    let period = scenario.bounds(seconds);
    let Late { delay, waiting, offset } = late(scenario);
    let passes = passes(scenario);
    let sensors = sensors(scenario);
    let of = HeldLoop { system: &*system, sensors: &sensors, period, waiting, offset, passes: &passes };
    let start = start(scenario);
    let begin = of.started(&start);
    let Asked { extents, rate } = asked.clone();
    let request = TubeRequest { periods: scenario.periods() as usize, extents, rate, start };
    let mut found = Findings::new(n);
    let done = tube(&of, &request, sections, progress, &mut |At { k, section, law, step }| {
        let [run, read] = found.runs.unwrap_or_else(|| [section.reach(&begin); 2]).map(Interval::point);
        raise(&mut found.largest, section.reaches(Interval::ONE + run));
        raise(&mut found.torque, law.largest());
        if k == 0 {
            let on_their_way = of.on_their_way(&Before::over(&of, section).state).ranges(&law.sizes);
            let on_their_way: Vec<_> = on_their_way.iter().map(|u| u.magnitude()).collect();
            on_their_way.chunks(n).for_each(|torques| raise(&mut found.torque, torques.iter().copied()));
        }
        let reference = system.reference(period * Interval::point(k as f64));
        let beside = section.reaches(Interval::ONE).into_iter().zip(&section.center).zip(&reference);
        let beside = beside.map(|((reach, &c), q)| Interval::point(c) + around_zero(reach) - q[0]);
        found.profile.add(k, request.periods, seconds, &beside.collect::<Vec<_>>());
        if 4 * k >= 3 * request.periods {
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
    let sections = match done {
        None => return Ok(None),
        Some(Err(ends)) => return Ok(Some(Err(why(scenario, rate, &sensors, &ends)))),
        Some(Ok(sections)) => sections,
    };
    let shifted = |i: usize| {
        let unit = |k: usize| if i == k { Interval::ONE } else { Interval::ZERO };
        of.started(&(0..4 * n).map(unit).collect::<Vec<_>>())
    };
    // As far as the run, which need not be in the middle, leaves room.
    let room = Interval::ONE - Interval::point(sections[0].reach(&begin));
    Ok(Some(Ok(SampledTube {
        rate: found.slowest,
        mean_rate: (found.rates / Interval::point(request.periods as f64)).lo(),
        alone: (0..2 * n).map(|i| (Interval::point(sections[0].alone(&shifted(i))) * room).lo()).collect(),
        error: found.largest,
        tracking: found.tracking,
        readings: sensors.off.clone(),
        filtered: sensors.filter.is_some(),
        torque: found.torque,
        period: seconds,
        delay,
        periods: request.periods,
        profile: found.profile,
        asked,
        sections: Arc::new(sections),
    })))
}

/// Where the run begins: at the decimals of the file, with the springs holding the links (`simulate::assembly`).
fn start(scenario: &Scenario) -> Vec<Interval> {
    let initial = &scenario.initial;
    let start = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].into_iter().flatten();
    start.map(|&x| scenario.bounds(x)).collect()
}

/// How late torques are.
struct Late {
    /// In s.
    delay: f64,
    /// Torques on their way at a control instant, before the law has asked for another.
    waiting: usize,
    /// How long into a period the next of them begins to act in s; none if from its beginning.
    offset: Option<Interval>,
}

fn late(scenario: &Scenario) -> Late {
    let delays = || scenario.imperfections.iter().filter_map(Imperfection::of::<Delay>);
    let exact = delays().fold(Interval::ZERO, |sum, delay| {
        sum + scenario.bounds(delay.computation) + scenario.bounds(delay.actuation)
    });
    let delay = delays().map(Delay::total).fold(0.0, f64::add);
    let (waiting, offset) = split(delay, scenario.control_period);
    let period = scenario.bounds(scenario.control_period);
    let whole_periods = Interval::point(waiting.saturating_sub(1) as f64) * period;
    Late { delay, waiting, offset: (offset > 0.0).then(|| exact - whole_periods) }
}

impl SampledTube {
    /// How far links in the tube are from the reference in rad, as they are read, at control instants.
    pub fn region(&self) -> Vec<f64> {
        let TubeProfile { lowest, highest, .. } = &self.profile;
        let largest = |of: &[f64]| of.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let each = lowest.iter().zip(highest).enumerate();
        each.map(|(i, (lowest, highest))| {
            let off = self.readings.get(i).copied().unwrap_or(0.0);
            (Interval::point(largest(lowest).max(largest(highest))) + Interval::point(off)).hi()
        })
        .collect()
    }
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
    profile: TubeProfile,
}

/// Parts of a profile at most.
const PARTS: usize = 500;

impl TubeProfile {
    /// With the control instant `k` of `periods`, each of `seconds`, at which links are so far beside the reference.
    fn add(&mut self, k: usize, periods: usize, seconds: f64, beside: &[Interval]) {
        let t = k as f64 * seconds;
        if k.is_multiple_of(periods.div_ceil(PARTS)) || self.end.is_empty() {
            self.end.push(t);
            self.lowest.resize(beside.len(), Vec::new());
            self.highest.resize(beside.len(), Vec::new());
            let all = self.lowest.iter_mut().zip(&mut self.highest).zip(beside);
            all.for_each(|((lowest, highest), beside)| {
                lowest.push(beside.lo());
                highest.push(beside.hi());
            });
            return;
        }
        let last = self.end.len() - 1;
        self.end[last] = t;
        for ((lowest, highest), beside) in self.lowest.iter_mut().zip(&mut self.highest).zip(beside) {
            lowest[last] = lowest[last].min(beside.lo());
            highest[last] = highest[last].max(beside.hi());
        }
    }
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
            profile: TubeProfile::default(),
        }
    }
}

fn raise(most: &mut [f64], with: impl IntoIterator<Item = f64>) {
    most.iter_mut().zip(with).for_each(|(most, x)| *most = most.max(x));
}
