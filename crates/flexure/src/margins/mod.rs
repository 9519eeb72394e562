//! How much a loop bears: delay, gain, stiffness and noise, by bisection in simulation.

mod change;
mod edge;
mod proved;

use std::ops::ControlFlow;

use serde::Serialize;

use crate::feasible;
use crate::files::{Problem, Problems};
use crate::progress::{PartProgress, Parts, Progress};
use crate::robot::JointKind;
use crate::sampled::{Sampled, probe};
use crate::scenario::{Hold, Scenario};
use crate::simulate::{Asking, Criteria, Run, in_turns, measure_watched};
use crate::units::{Unit, of_joints};

pub use change::Change;
pub use edge::Edge;
pub use proved::{ProvedDelay, check_tube};

/// What a loop bears beyond its scenario.
///
/// ```
/// use flexure::margins::margins;
/// use flexure::progress::unwatched;
///
/// let mut scenario = flexure::Scenario::load("pendulum-tanh")?;
/// scenario.duration = 0.5; // s
/// let margins = margins(&scenario, &unwatched)?;
/// assert!(margins.delay.holds() > Some(0.0)); // s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
pub struct Margins {
    /// Scenario name.
    pub name: String,
    /// Controller kind.
    pub controller: String,
    /// Shaping function of a v-CBC law.
    pub phi: Option<String>,
    /// Root mean square link error of the scenario as it is, in rad; none if it diverges.
    pub rms_e_l: Option<f64>,
    /// Why the scenario as it is does not follow; nothing if it does.
    pub reasons: Vec<String>,
    /// Root mean square link error up to which the loop counts as holding, in rad.
    pub allowed_rms_e_l: f64,
    /// Largest motor torque up to which it does [N m].
    pub allowed_max_u_m: f64,
    /// Root mean square change of the torque from one control instant to the next up to which it does [N m].
    pub allowed_rms_torque_change: f64,
    /// Delay from command to torque that may be added, in s.
    pub delay: Edge,
    /// Delay that may be added so that motions near the run are proved to come closer, where that was asked for.
    pub delay_proved: Option<ProvedDelay>,
    /// Factor by which the motor torque may be too small.
    pub gain_low: Edge,
    /// Factor by which it may be too large.
    pub gain_high: Edge,
    /// Factor by which the springs may be softer than the model.
    pub stiffness_low: Edge,
    /// Factor by which they may be stiffer.
    pub stiffness_high: Edge,
    /// Standard deviation of white noise that may be added to all measured positions, in rad.
    pub noise: Edge,
    /// Root mean square link error per standard deviation of noise on all measured positions [rad/rad], at a tenth of the noise that
    /// the loop bears.
    pub noise_to_error: Option<f64>,
    /// Root mean square change of the motor torque from one control instant to the next, per standard deviation of that noise
    /// [N m/rad].
    pub noise_to_torque: Option<f64>,
    /// Runs that were simulated.
    pub runs: usize,
    /// Whether small errors shrink in the loop as it is; none if it was not looked at.
    pub sampled: Option<Sampled>,
    /// Length of each run \[s\].
    pub duration: f64,
    /// Which joints turn, which slide.
    #[serde(skip)]
    pub kinds: Vec<JointKind>,
    /// Whether it was broken off: edges may be [open](Edge::Open), and what is measured last is not there.
    #[serde(skip)]
    pub broken_off: bool,
}

/// A loop holds if it follows, by the verdict on runs, and its error, torque and chatter are at most this many times what they are
/// without the change …
const TIMES: f64 = 10.0;

/// … or the error larger by at most this, in rad …
const BY: f64 = 0.01;

/// … but at most this, in rad …
const MOST: f64 = 0.2;

/// … or the chatter at most this part of the torque without the change.
const CHATTER: f64 = 0.5;

/// Part of the noise that the loop bears at which its answer to noise is measured: far from where it stops holding, and not below
/// what encoders show.
const LITTLE: f64 = 0.1;

/// Part of the work that the searches are; the run before them takes the rest.
const SEARCHES: f64 = 0.98;

/// What is changed, and how far.
type Search = (fn(f64) -> Change, edge::Way);

/// Measures the margins of a scenario's loop. Each is where the loop still holds on the way from the scenario as it is: loops that
/// hold again farther out are not looked for. What `progress` breaks off has what was found until then ([`Margins::broken_off`]).
///
/// # Errors
/// As [`run`](crate::simulate::run), [`Problems::interrupted`] if the loop as it is was not even run, and for a loop in continuous time, which has no devices that could be late.
///
/// # Panics
/// Never: there are as many edges as searches.
pub fn margins(scenario: &Scenario, progress: Progress<'_>) -> Result<Margins, Problems> {
    if scenario.hold == Hold::Continuous {
        let message = "hold is \"continuous\": margins are of loops with control periods";
        let help = "remove hold: the torque is then held between control instants";
        return Err(scenario.places.problem("hold", "unsupported", message.to_owned(), help).into());
    }
    let scenario = feasible::pinned(&scenario.by_collocation())?;
    let criteria = Criteria::of(&scenario)?;
    let before = 1.0 - SEARCHES;
    let nominal = || measure_watched(&scenario, &criteria, &|fraction| progress(before * fraction));
    let (nominal, sampled) = rayon::join(nominal, || probe(&scenario));
    let nominal = nominal?;
    let rms = nominal.divergence.is_none().then_some(nominal.summary.rms_e_l);
    let follows = nominal.summary.following.follows;
    let allowed = Allowed::beside(&nominal);
    let period = scenario.control_period;
    // The longest first, so that none is left when the others are done.
    let searches: [Search; 6] = [
        (Change::Noise, edge::Way::outward(0.0, 1e-6, 1.0)),
        (Change::Delay, edge::Way::outward(0.0, 0.125 * period, scenario.duration / 4.0)),
        (Change::Stiffness, edge::Way::inward(1.0, 100.0)),
        (Change::Stiffness, edge::Way::inward(1.0, 0.01)),
        (Change::TorqueGain, edge::Way::inward(1.0, 100.0)),
        (Change::TorqueGain, edge::Way::inward(1.0, 0.01)),
    ];
    let parts = Parts::new(searches.len());
    let tell = |part, fraction| progress(before + SEARCHES * parts.with(part, fraction));
    let hunts = searches.iter().enumerate().map(|(part, (change, way))| Hunt {
        part,
        change: *change,
        search: way.search(),
        scenario: &scenario,
        criteria: &criteria,
        allowed: &allowed,
        tell: &tell,
        asked: Vec::new(),
        known: Vec::new(),
        little: Little::of(change(0.0)),
        problems: None,
    });
    let mut found = vec![Found::NOTHING; searches.len()];
    if follows {
        for (found, hunt) in found.iter_mut().zip(in_turns(hunts.collect())) {
            *found = hunt.found()?;
        }
    }
    let runs = 1 + found.iter().map(|found| found.runs).sum::<usize>();
    let broken_off = found.iter().any(|found| found.broken_off);
    let noisy = found.iter_mut().find_map(|found| found.noisy.take());
    let edges: Vec<Edge> = found.into_iter().map(|found| found.edge).collect();
    let [noise, delay, stiffness_high, stiffness_low, gain_high, gain_low] =
        edges.try_into().expect("six searches");
    let per_noise = |of: fn(&Run) -> f64| {
        let (little, noisy) = noisy.as_ref().filter(|(_, run)| run.divergence.is_none())?;
        let excess = of(noisy).powi(2) - of(&nominal).powi(2);
        (excess > 0.0).then(|| excess.sqrt() / little)
    };
    Ok(Margins {
        name: scenario.name.clone(),
        controller: scenario.controller.kind().to_owned(),
        phi: scenario.controller.phi().map(str::to_owned),
        rms_e_l: rms,
        reasons: nominal.summary.following.reasons.iter().map(|reason| reason.words.clone()).collect(),
        allowed_rms_e_l: allowed.rms_e_l,
        allowed_max_u_m: allowed.max_u_m,
        allowed_rms_torque_change: allowed.rms_torque_change,
        delay,
        delay_proved: None,
        gain_low,
        gain_high,
        stiffness_low,
        stiffness_high,
        noise,
        noise_to_error: per_noise(|run| run.summary.rms_e_l),
        noise_to_torque: per_noise(|run| run.summary.rms_torque_change),
        runs,
        duration: scenario.duration,
        kinds: scenario.robot.kinds(),
        sampled: if broken_off { None } else { sampled? },
        broken_off,
    })
}

/// A search for one of the edges.
struct Hunt<'a> {
    part: usize,
    change: fn(f64) -> Change,
    search: edge::Search,
    scenario: &'a Scenario,
    criteria: &'a Criteria,
    allowed: &'a Allowed,
    /// Told the number of the search and how far it is.
    tell: PartProgress<'a>,
    /// Changes whose runs are on their way.
    asked: Vec<f64>,
    /// Whether the loop holds under changes that the search has not come to yet.
    known: Vec<(f64, Result<bool, Problems>)>,
    little: Little,
    /// What ended it.
    problems: Option<Problems>,
}

/// The run with [`LITTLE`] of the noise that the loop bears, once that is known.
enum Little {
    /// Of other changes there is none.
    None,
    /// The edge is looked for.
    Wanted,
    /// It is on its way, with so much.
    Asked(f64),
    Run(f64, Box<Run>),
}

impl Little {
    /// Before a search along changes such as `change`.
    fn of(change: Change) -> Self {
        if matches!(change, Change::Noise(_)) { Self::Wanted } else { Self::None }
    }
}

/// What a search has found.
#[derive(Clone)]
struct Found {
    edge: Edge,
    /// Runs that it took.
    runs: usize,
    /// A little noise, and the run with it.
    noisy: Option<(f64, Box<Run>)>,
    broken_off: bool,
}

impl Found {
    /// Of a loop that does not hold as it is.
    const NOTHING: Self = Self { edge: Edge::Nowhere, runs: 0, noisy: None, broken_off: false };
}

impl Hunt<'_> {
    /// What it found: an open edge if it was broken off.
    fn found(self) -> Result<Found, Problems> {
        let broken_off = self.problems.is_some();
        if let Some(problems) = self.problems.filter(|problems| !problems.is_interrupted()) {
            return Err(problems);
        }
        let (edge, tried) = self.search.edge();
        let noisy = if let Little::Run(little, run) = self.little { Some((little, run)) } else { None };
        Ok(Found { edge, runs: tried + usize::from(noisy.is_some()), noisy, broken_off })
    }
}

impl Asking for Hunt<'_> {
    fn ask(&mut self, most: usize) -> Vec<Scenario> {
        self.asked = self.search.ahead(most);
        if self.asked.is_empty() && matches!(self.little, Little::Wanted) {
            let little = self.search.edge().0.holds().map(|holds| LITTLE * holds);
            self.little = little.map_or(Little::None, Little::Asked);
            self.asked.extend(little);
        }
        if self.problems.is_some() {
            self.asked.clear();
        }
        if self.asked.is_empty() {
            // One that is done sooner than it seemed counts as done.
            let _ = (self.tell)(self.part, 1.0);
        }
        self.asked.iter().map(|&x| (self.change)(x).of(self.scenario)).collect()
    }

    fn criteria(&self) -> &Criteria {
        self.criteria
    }

    fn watch(&self, fraction: f64) -> ControlFlow<()> {
        let done = self.search.next().map_or(1.0, |(_, stage)| stage.fraction(fraction));
        (self.tell)(self.part, done)
    }

    fn tell(&mut self, runs: Vec<(Scenario, Result<Run, Problems>)>) {
        for (x, (_, run)) in std::mem::take(&mut self.asked).into_iter().zip(runs) {
            match (run, &self.little) {
                (Ok(run), &Little::Asked(little)) => self.little = Little::Run(little, Box::new(run)),
                (Err(problems), Little::Asked(_)) => self.problems = Some(problems),
                (run, _) => self.known.push((x, run.map(|run| self.allowed.holds(&run)))),
            }
        }
        while let Some((next, _)) = self.search.next().filter(|_| self.problems.is_none()) {
            let known = self.known.iter().position(|(x, _)| x.to_bits() == next.to_bits());
            match known.map(|known| self.known.swap_remove(known).1) {
                Some(Ok(holds)) => self.search.tell(holds),
                Some(Err(problems)) => self.problems = Some(problems),
                None => break,
            }
        }
    }
}

/// What a loop may come to under a change and still hold.
#[derive(Clone, Copy, Debug)]
struct Allowed {
    rms_e_l: f64,
    max_u_m: f64,
    rms_torque_change: f64,
}

impl Allowed {
    /// Beside what it comes to as it is.
    fn beside(nominal: &Run) -> Self {
        let summary = &nominal.summary;
        Self {
            rms_e_l: (TIMES * summary.rms_e_l).max(summary.rms_e_l + BY).min(MOST),
            max_u_m: TIMES * summary.max_abs_u_m,
            rms_torque_change: (TIMES * summary.rms_torque_change).max(CHATTER * summary.rms_u_m),
        }
    }

    fn holds(&self, run: &Run) -> bool {
        let summary = &run.summary;
        summary.following.follows
            && summary.rms_e_l <= self.rms_e_l
            && summary.max_abs_u_m <= self.max_u_m
            && summary.rms_torque_change <= self.rms_torque_change
    }
}

impl Margins {
    /// Whether small errors grow in the loop as it is: what follows then follows in so short a run.
    pub fn is_unstable(&self) -> bool {
        self.sampled.as_ref().is_some_and(|sampled| !sampled.stable)
    }

    /// A unit of joints with a prefix, as this robot's turn or slide.
    pub fn unit(&self, unit: Unit, prefix: &str) -> String {
        of_joints(unit, prefix, &self.kinds)
    }

    /// The law in words.
    pub fn law(&self) -> String {
        self.phi.as_ref().map_or_else(|| self.controller.clone(), |phi| format!("{} {phi}", self.controller))
    }

    /// Says that the loop does not even hold as it is, if so.
    pub fn objection(&self, scenario: &Scenario) -> Option<Problem> {
        let unstable = self.sampled.as_ref().filter(|sampled| !sampled.stable);
        (self.delay == Edge::Nowhere || unstable.is_some()).then(|| {
            let how = match self.rms_e_l {
                None => "diverges as it is".to_owned(),
                Some(_) if self.reasons.is_empty() => {
                    let line = unstable.map_or_else(String::new, Sampled::line);
                    format!("follows for as long as the run is, but {line}")
                }
                Some(_) => format!("does not follow its reference: {}", self.reasons.join("; ")),
            };
            let message = format!("{}, {}: the loop {how}: it has no margins", self.name, self.law());
            let help = self.sampled.as_ref().and_then(Sampled::help).unwrap_or_else(|| {
                let cause = if self.sampled.is_some() {
                    "small errors shrink: join the reference smoothly"
                } else {
                    "small errors were not looked at: try other gains, or join the reference smoothly"
                };
                format!("{cause}; `flexure run` shows how it goes wrong")
            });
            scenario.places.problem("controller", "diverged", message, help)
        })
    }
}
