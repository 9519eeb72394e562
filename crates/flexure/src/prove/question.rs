//! What to prove of a scenario, and all that is proved of it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant as Clock;

use crate::files::Problems;
use crate::progress::{Progress, unwatched};
use crate::prove::along::{Along, along, start_level, suitable, uneven_metric};
use crate::prove::asked_rate::at_rate;
use crate::prove::confirmation::{Confirmation, confirm};
use crate::prove::decay::Decay;
use crate::prove::engine::certificate::{Certificate, CertifiedPhi};
use crate::prove::engine::number::Number;
use crate::prove::engine::verdict::Verdict;
use crate::prove::engine::witness::RateWitness;
use crate::prove::paper::paper_rate;
use crate::prove::proposition::proposition;
use crate::prove::robust::{NoFunnel, Robust, robust, up_to_limits};
use crate::prove::sampled_data::{
    NoTube, SampledTube, is_quick, sampled_tube, strongest_tube, suitable_when_sampled,
};
use crate::prove::sampling::{Sampled, sample};
use crate::prove::verified::certify;
use crate::prove::within::{Open, Within, spread, within};
use crate::robot;
use crate::scenario::Scenario;

/// What to prove of a scenario.
///
/// ```
/// use flexure::prove::question::{Question, Region};
///
/// // A pendulum: errors of its link and of its motor up to 0.2 rad.
/// let question = Question { region: Region::Errors(vec![0.2, 0.2]), ..Question::default() };
/// let proof = flexure::Scenario::load("pendulum-tanh")?.certify(&question)?;
/// let certificate = proof.verdict.proved().expect("proved");
/// assert!(certificate.convergence_rate.approximate() > 1.0); // 1/s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Question {
    /// Errors for which it shall be proved.
    pub region: Region,
    /// The contraction rate to prove [1/s]; the largest if none is given.
    pub rate: Option<f64>,
    /// Largest unknown torque on each motor [N m].
    pub disturbance: Option<Vec<f64>>,
    /// Largest unknown torque on each link [N m].
    pub link_disturbance: Option<Vec<f64>>,
    /// Whether these torques say only which ones, and the largest multiple is looked for under which no limit of the robot acts.
    pub up_to_limits: bool,
    /// Slabs of time that a funnel may have; if none are named, the fewer the more joints there are.
    pub slabs: Option<usize>,
    /// Largest velocity errors [rad/s], links then motors, if a rate in a stretched metric is asked for.
    pub velocity_error: Option<Vec<f64>>,
    /// How far link positions reach in a tube of the sampled loop in rad, one number a link, if one is asked for.
    pub sampled_tube: Option<Vec<f64>>,
    /// Whether the widest tube of the sampled loop is looked for where none is named: what is proved then is the strongest that can be.
    pub climb: Climb,
    /// Whether the direct engine shall prove the rate once more, and how hard it may try.
    pub direct: Option<Direct>,
}

/// Whether the widest tube of the sampled loop is looked for unasked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Climb {
    /// It is not.
    #[default]
    Stay,
    /// Where nothing else is asked for, and it takes a minute or two of two cores at most.
    IfQuick,
    /// However long it takes.
    Always,
}

/// How hard the direct engine may try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direct {
    /// Boxes that it may look at.
    pub budget: usize,
}

/// Smallest error that a region can be made of \[rad\]: with smaller ones the slopes of tanh are 1 to rounding.
pub const SMALLEST_ERROR: f64 = 1e-6;

/// Errors for which a claim shall hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Region {
    /// Everywhere if φ allows it; else errors of up to 1 rad, as an assumption.
    #[default]
    Chosen,
    /// |q̃_i| up to these, links then motors, in rad.
    Errors(Vec<f64>),
    /// The smallest level of W that holds these position errors, links then motors, in rad, with no momentum errors.
    Start(Vec<f64>),
}

impl Question {
    /// Whether it asks for what only a funnel can say, whatever the robot.
    fn is_of_funnels(&self) -> bool {
        self.link_disturbance.is_some() || self.up_to_limits
    }

    /// Whether a statement, a region or a rate is named.
    fn names_something(&self) -> bool {
        let plain = Self { climb: self.climb, ..Self::default() };
        *self != plain
    }

    /// Whether the widest tube of the sampled loop of `scenario` is looked for.
    pub fn climbs(&self, scenario: &Scenario) -> bool {
        match self.climb {
            Climb::Stay => false,
            Climb::IfQuick => !self.names_something() && is_quick(scenario),
            Climb::Always => self.sampled_tube.is_none(),
        }
    }

    /// Whether a tube of the sampled loop of `scenario` is looked for, named or not.
    pub fn looks_for_tube(&self, scenario: &Scenario) -> bool {
        self.sampled_tube.is_some() || self.climbs(scenario)
    }

    /// Whether a funnel is looked for: under disturbances, and of robots with tolerances.
    pub fn looks_for_funnel(&self, scenario: &Scenario) -> bool {
        let feels = self.disturbance.is_some() || self.is_of_funnels();
        (feels || !scenario.robot.tolerances.are_none()) && suitable(scenario).is_ok()
    }
}

/// Slabs of time that bounds along the reference of `joints` joints may look at: one costs the more the more joints there
/// are, 40 ms for seven.
fn slabs(joints: usize) -> usize {
    8000 / joints.pow(3)
}

/// What holds of all robots within the tolerances is looked for at several levels, with this part of the slabs each.
const SHARE: usize = 4;

/// The answer to a [`Question`]: verdict and certificate, and what to compare them with.
#[derive(Clone, Debug)]
pub struct Proof {
    /// Proved, with the certificate; refuted, with a witness; or undecided, with the reason.
    pub verdict: Verdict<Certificate, RateWitness>,
    /// The rate by the paper's formula [1/s].
    pub paper_rate: f64,
    /// The links' momentum block sampled over all configurations.
    pub sampled: Sampled,
    /// What the direct engine says, if it was asked.
    pub confirmation: Option<Confirmation>,
    /// An upper bound of W at the scenario's start, in J; none where W is not defined or jumps.
    pub start: Option<f64>,
    /// What holds of every robot within the tolerances of the robot file, if it has some, or why nothing was shown.
    pub within: Option<Result<Within, Open>>,
    /// Whether it asks for what only a funnel can say.
    pub needs_funnel: bool,
    /// How far the motion can be from its reference, by a funnel, if disturbances or tolerances were named; or why there is none.
    pub robust: Option<Result<Robust, NoFunnel>>,
    /// How fast motions of the sampled loop come closer near its run, if that was asked for; or why nothing was shown.
    pub sampled_tube: Option<Result<SampledTube, NoTube>>,
    /// Whether a tube of the sampled loop was looked for unasked: that there is none then leaves the others.
    pub climbed: bool,
    /// Bounds along the reference inside the tube of W, if a disturbance of the motors or tolerances were named and there is no funnel.
    pub along: Option<Along>,
    /// Options that were not given, and numbers that no source vouches for.
    pub assumptions: Vec<String>,
    /// Time that it took in s.
    pub wall_seconds: f64,
    /// Whether it was broken off: what is here holds, and more may have been proved of what was asked beside the rates.
    pub broken_off: bool,
}

/// Whether a sliding joint starts outside its travel.
fn outside_travel(scenario: &Scenario) -> bool {
    let robot = &scenario.robot;
    robot.joints.iter().enumerate().any(|(i, joint)| {
        let q = scenario.initial.q_l[i];
        joint.kind == robot::JointKind::Prismatic
            && !(robot.limits.lower[i]..=robot.limits.upper[i]).contains(&q)
    })
}

impl Scenario {
    /// Proves how fast the closed loop contracts, and where: [`prove`].
    ///
    /// # Errors
    /// Where no certificate can speak of it: with the place and the reason.
    pub fn certify(&self, question: &Question) -> Result<Proof, Problems> {
        prove(self, question)
    }
}

/// Proves what `question` asks of `scenario`.
///
/// # Errors
/// Where no certificate can speak of it: with the place and the reason.
pub fn prove(scenario: &Scenario, question: &Question) -> Result<Proof, Problems> {
    prove_watched(scenario, question, &unwatched)
}

/// Where the rates, all robots within tolerances, the funnel and the direct proof end, about; bounds along the reference take the rest.
const RATES: f64 = 0.05;
const WITHIN: f64 = 0.25;
const ROBUST: f64 = 0.5;
const DIRECT: f64 = 0.6;

/// Where all that ends if a tube of the sampled loop is asked for, which takes the rest.
const BEFORE_TUBE: f64 = 0.2;

/// As [`prove`]; `progress` is told about what fraction is done. Once the rates are proved, what it breaks off has what was
/// proved until then ([`Proof::broken_off`]).
///
/// # Errors
/// As [`prove`], and [`Problems::interrupted`] if it was broken off before the rates were proved.
pub fn prove_watched(
    scenario: &Scenario,
    question: &Question,
    progress: Progress<'_>,
) -> Result<Proof, Problems> {
    let broken_off = AtomicBool::new(false);
    let climbs = question.climbs(scenario);
    let share = if question.looks_for_tube(scenario) { BEFORE_TUBE } else { 1.0 };
    let told = |fraction: f64| {
        let flow = progress(fraction);
        broken_off.fetch_or(flow.is_break(), Ordering::Relaxed);
        flow
    };
    let watched = |fraction: f64| told(share * fraction);
    let is_broken_off = || broken_off.load(Ordering::Relaxed);
    let started = Clock::now();
    let start = start_level(scenario).ok().filter(|_| !outside_travel(scenario));
    let problem = proposition(scenario, question, start)?;
    let uneven = uneven_metric(scenario).is_some();
    let has_tolerances = !scenario.robot.tolerances.are_none() && !uneven;
    // W says nothing of torques on the links, and masses that are off are such.
    let has_masses = has_tolerances && !scenario.robot.tolerances.masses_are_none();
    let needs_funnel = question.is_of_funnels() || has_masses;
    if needs_funnel {
        suitable(scenario)?;
    }
    if question.sampled_tube.is_some() {
        suitable_when_sampled(scenario)?;
    }
    if watched(0.0).is_break() {
        return Err(Problems::interrupted());
    }
    let gains = scenario.vcbc()?;
    let damping: Vec<f64> =
        scenario.robot.link_damping.iter().zip(&gains.link.damping).map(|(a, b)| a + b).collect();
    let sampled = sample(&scenario.robot, &damping, &|fraction| watched(0.5 * RATES * fraction))?;
    let verdict = match (certify(&problem), question.rate) {
        (Verdict::Proved(certificate), Some(rate)) => at_rate(rate, certificate, &sampled, &damping),
        (verdict, _) => verdict,
    };
    let _ = watched(RATES);
    let budget = slabs(scenario.robot.joint_count());
    let watched = &watched;
    let between = |from: f64, to: f64| move |fraction: f64| watched(from + (to - from) * fraction);
    let (within, begun) = match verdict.proved().filter(|_| has_tolerances && !needs_funnel) {
        None => (None, RATES),
        Some(certificate) => {
            let found = within(scenario, certificate, start, budget / SHARE, &between(RATES, WITHIN))?;
            (found, WITHIN)
        }
    };
    let (robust, begun) = match verdict.proved().filter(|_| question.looks_for_funnel(scenario)) {
        Some(_) if !is_broken_off() => (funnel(scenario, question, &between(begun, ROBUST))?, ROBUST),
        _ => (None, begun),
    };
    // Where the robot need not be that of the file, the level is that of all robots that it may be.
    let level = match &within {
        _ if needs_funnel || matches!(robust, Some(Ok(_))) => None,
        _ if !has_tolerances => verdict.proved().and_then(|certificate| level_of_the_run(certificate, start)),
        Some(Ok(within)) => Some(Number::above(within.level)),
        _ => None,
    };
    // Whichever is asked for alone takes all the time.
    let middle = match (question.direct, &level) {
        (None, _) => begun,
        (Some(_), None) => 1.0,
        (Some(_), Some(_)) => DIRECT,
    };
    let confirmation = match (verdict.proved(), question.direct) {
        (Some(certificate), Some(direct)) if !is_broken_off() && !uneven => {
            Some(confirm(scenario, certificate, direct, &between(begun, middle))?)
        }
        _ => None,
    };
    let along = match level {
        Some(level) if !is_broken_off() => along(scenario, &level, budget, &between(middle, 1.0))?,
        _ => None,
    };
    let last = |fraction: f64| told(share + (1.0 - share) * fraction);
    let sampled_tube = match &question.sampled_tube {
        Some(error) if !is_broken_off() => sampled_tube(scenario, error, &last)?,
        None if climbs && !is_broken_off() => strongest_tube(scenario, &last)?,
        _ => None,
    };
    Ok(Proof {
        confirmation,
        sampled_tube,
        climbed: climbs,
        start,
        within,
        needs_funnel,
        robust,
        along,
        paper_rate: paper_rate(&scenario.robot, gains, &problem, sampled.largest_inertia),
        verdict,
        sampled,
        assumptions: problem.assumptions,
        wall_seconds: started.elapsed().as_secs_f64(),
        broken_off: is_broken_off(),
    })
}

/// The funnel that `question` asks for.
fn funnel(
    scenario: &Scenario,
    question: &Question,
    progress: Progress<'_>,
) -> Result<Option<Result<Robust, NoFunnel>>, Problems> {
    let number = |torques: &Option<Vec<f64>>| {
        torques.as_ref().map(|all| all.iter().map(|&d| Number::decimal(d)).collect::<Vec<_>>())
    };
    let [motors, links] = [&question.disturbance, &question.link_disturbance].map(number);
    let spread = spread(&scenario.robot, motors.as_deref(), links.as_deref());
    let bounds = if question.up_to_limits { up_to_limits } else { robust };
    bounds(scenario, &spread, question.slabs, progress)
}

/// The level of W that a run from `start` never leaves under the certificate's disturbance: that of the tube, or of the start
/// where that is more. None without a disturbance, and for a start that is not known to lie in the region.
fn level_of_the_run(certificate: &Certificate, start: Option<f64>) -> Option<Number> {
    let tube = certificate.tube.as_ref()?.level.clone();
    let start = start.filter(|&start| inside(certificate, start))?;
    // Its decimal may lie a step below.
    Some(if start <= tube.bounds().lo() { tube } else { Number::decimal(start.next_up()) })
}

/// Whether {W ≤ `level`} lies in the certificate's invariant set.
pub(crate) fn inside(certificate: &Certificate, level: f64) -> bool {
    certificate.region.level.as_ref().is_none_or(|c| level <= c.bounds().lo())
}

/// The contraction rate that is proved of `scenario` without further options [1/s]; none if none is.
///
/// # Errors
/// If its level set cannot be found.
pub fn certified_rate(scenario: &Scenario) -> Result<Option<f64>, Problems> {
    let rate = |(certificate, _): (Certificate, _)| Some(certificate.contraction_rate?.approximate());
    Ok(certified(scenario)?.and_then(rate))
}

/// What is proved of `scenario` without further options, if anything is, and how errors decay from its start, if that is inside.
///
/// # Errors
/// If its level set cannot be found.
pub(crate) fn certified(scenario: &Scenario) -> Result<Option<(Certificate, Option<Decay>)>, Problems> {
    let certified = scenario.vcbc().is_ok_and(|gains| CertifiedPhi::named(gains.phi.name()).is_some());
    if !certified || uneven_metric(scenario).is_some() {
        return Ok(None);
    }
    let start = start_level(scenario).ok();
    let problem = proposition(scenario, &Question::default(), start)?;
    Ok(certify(&problem).proved().map(|certificate| {
        let decay = start.and_then(|start| Decay::of(certificate, start));
        (certificate.clone(), decay)
    }))
}
