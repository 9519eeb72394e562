//! The sampled loop of a scenario: is the loop stable that holds its torque for a control period?
//!
//! A controller acts at instants; between them its torque stays, comes late, and is computed from what sensors and estimators
//! made of the motion. The exact linearisation of all that from one instant to the next has a spectral radius ρ: small errors grow or
//! shrink by it, control period for control period. It is looked at where the robot starts, and along the reference.
//!
//! ρ ≥ 1 where the robot stands is the end of the loop, whatever is proved of the same law in continuous time. A place that it passes
//! may have ρ > 1 for a while: there it counts what the maps from place to place make of small errors one after the other
//! (`growth.rs`). ρ < 1 is necessary, not sufficient: limits, noise and large errors are not small signals.
//!
//! The parts are the loop's own code on numbers that carry a derivative along ([`Tangent`](crate::core::scalar::Tangent)), the plant
//! between two instants is the exponential of its Jacobian.

mod advice;
mod devices;
mod exchange;
mod growth;
mod lifted;
mod linearised;
mod map;
mod words;

use serde::Serialize;

use crate::files::Problems;
use crate::laws::Controller;
use crate::linalg::{Dense, spectral_radius};
use crate::robot::Arm;
use crate::sampled::devices::Devices;
use crate::sampled::lifted::{Lifted, Nominal, lifted};
use crate::sampled::map::{Around, LawSlope};
use crate::scenario::{Hold, Scenario};

pub use advice::{Advice, Move};
pub use linearised::Linearised;

/// A radius is computed to about 1e-12; what grows by less than this in a period, no run shows.
const ROUNDING: f64 = 1e-9;

/// The start is a moment, and the robot need not be in balance there: what grows no faster than this in a period is over before it
/// matters, and grows in continuous time, too.
const PASSING: f64 = 1.01;

/// Places along the reference that are looked at, the first at t = 0.
const PLACES: u32 = 25;

/// Places of a loop with many torques on their way: its matrices are large.
const FEW_PLACES: u32 = 7;

/// Torques on their way, of all joints, that are many, and that are too many to look at.
const MANY: usize = 24;
const TOO_MANY: usize = 64;

/// What small errors do in a sampled loop, where that is worst.
#[derive(Clone, Debug, Serialize)]
pub struct Sampled {
    /// Largest spectral radius of the map from one control instant to the next; NaN (null in JSON) where the law has no slope.
    pub spectral_radius: f64,
    /// When, in s.
    pub time: f64,
    /// Where: at the initial motion, or on the reference.
    pub place: Place,
    /// Whether small errors shrink: everywhere, or on the whole where the robot passes places at which they grow a little.
    pub stable: bool,
    /// Rate at which they do at least [1/s], on the whole where there are such places; negative where they grow.
    pub rate: f64,
    /// The joint that moves most in the mode of this radius, where it is not stable.
    pub joint: Option<String>,
    /// The gain to move, where it is not stable, as a key of the scenario: `controller.motor.metric`.
    pub gain: Option<String>,
    /// Which way, how far, and what else helps, where it is not stable.
    #[serde(flatten)]
    pub advice: Option<Advice>,
}

/// Where a loop is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// At the initial motion of the scenario.
    Start,
    /// Exactly on the reference.
    Reference,
}

/// Looks at the sampled loop of `scenario`; none if its law acts in continuous time, or more than 64 torques of its joints together are
/// on their way at a time.
///
/// # Errors
/// As [`Scenario::open`].
pub fn probe(scenario: &Scenario) -> Result<Option<Sampled>, Problems> {
    let Some(probe) = Probe::new(scenario)? else { return Ok(None) };
    let (radius, worst, growth) = probe.found(&scenario.controller);
    let stable = growth.is_some();
    let advice = if stable { None } else { advice::advice(&probe, worst)? };
    Ok(Some(Sampled {
        spectral_radius: radius,
        time: probe.spots[worst].time,
        place: probe.spots[worst].place,
        stable,
        rate: -growth.unwrap_or(radius).ln() / scenario.control_period,
        joint: advice.as_ref().map(|advice| advice.joint_name.clone()),
        gain: advice.as_ref().map(|advice| advice.key.clone()),
        advice,
    }))
}

/// Whether the sampled loop of `scenario` is stable, or not looked at.
///
/// # Errors
/// As [`Scenario::open`].
pub(crate) fn is_stable(scenario: &Scenario) -> Result<bool, Problems> {
    Ok(Probe::new(scenario)?.is_none_or(|probe| probe.found(&scenario.controller).2.is_some()))
}

/// The sampled loop of a scenario, made ready to be looked at under many laws.
pub(crate) struct Outlook<'a>(Option<Probe<'a>>);

impl<'a> Outlook<'a> {
    /// Of `scenario`, whose own law plays no part.
    ///
    /// # Errors
    /// As [`Scenario::open`].
    pub fn new(scenario: &'a Scenario) -> Result<Self, Problems> {
        Probe::new(scenario).map(Self)
    }

    /// By what small errors grow in a control period under `law`: the largest spectral radius that counts, or what becomes of them on the
    /// whole way along the reference where they grow at some places and shrink on the whole. NaN where the law has no slope; none where
    /// nothing is looked at.
    pub fn growth(&self, law: &Controller) -> Option<f64> {
        self.0.as_ref().map(|probe| {
            let (radius, _, growth) = probe.found(law);
            growth.unwrap_or(radius)
        })
    }

    /// The largest spectral radius under `law` at some of the places: a first idea, for a fifth of the effort.
    pub fn first_idea(&self, law: &Controller) -> Option<f64> {
        let largest = |radii: f64, radius: f64| if radius.is_nan() { radius } else { radii.max(radius) };
        let probe = self.0.as_ref()?;
        let some = probe.spots.iter().filter(|spot| spot.place == Place::Reference).step_by(5);
        Some(some.map(|spot| probe.radius(spot, law)).fold(0.0, largest))
    }
}

/// Whether a law adapts parameters of the links. The linearised loop solves for all of a memory together, and their step does not: it would be another loop's.
fn adapts(law: &Controller) -> bool {
    law.memory().iter().any(|(name, _)| name.starts_with("phi"))
}

/// Why the sampled loop of `scenario` is not looked at, if it is not and its law acts at instants.
pub fn not_looked_at(scenario: &Scenario) -> Option<String> {
    if scenario.hold == Hold::ZeroOrder && adapts(&scenario.controller) {
        return Some("sampled loop: not looked at, the law adapts parameters of the links".to_owned());
    }
    let waiting = Devices::of(scenario).waiting.saturating_mul(scenario.robot.joint_count());
    (scenario.hold == Hold::ZeroOrder && waiting > TOO_MANY).then(|| {
        format!("sampled loop: not looked at, {waiting} torques of all joints are on their way at a time, more than {TOO_MANY}")
    })
}

/// The spectral radius at every place that [`probe`] looks at: time in s, place and radius; nothing where it does not look.
///
/// # Errors
/// As [`Scenario::open`].
pub fn radii(scenario: &Scenario) -> Result<Vec<(f64, Place, f64)>, Problems> {
    let Some(probe) = Probe::new(scenario)? else { return Ok(Vec::new()) };
    let law = &scenario.controller;
    Ok(probe.spots.iter().map(|spot| (spot.time, spot.place, probe.radius(spot, law))).collect())
}

/// Parts of a run at which it is looked at: its ends, and multiples of the golden section in between, which fall on other phases of
/// whatever repeats.
fn times(places: u32) -> Vec<f64> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let inside = (1..places - 1).map(|i| (f64::from(i) * golden).fract());
    let mut times: Vec<_> = inside.chain([0.0, 1.0]).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Everything about a scenario that its gains do not change.
struct Probe<'a> {
    scenario: &'a Scenario,
    lifted: Box<dyn Lifted>,
    arm: Box<dyn Arm>,
    devices: Devices,
    spots: Vec<Spot>,
}

/// A time and place, and the loop there.
struct Spot {
    time: f64,
    place: Place,
    around: Around,
}

impl<'a> Probe<'a> {
    /// None where there is nothing to look at, or too much.
    fn new(scenario: &'a Scenario) -> Result<Option<Self>, Problems> {
        let devices = Devices::of(scenario);
        let waiting = devices.waiting.saturating_mul(scenario.robot.joint_count());
        if scenario.hold == Hold::Continuous || waiting > TOO_MANY || adapts(&scenario.controller) {
            return Ok(None);
        }
        let places = if waiting > MANY { FEW_PLACES } else { PLACES };
        let (lifted, arm) = (lifted(scenario)?, scenario.robot.arm()?);
        let mut probe = Self { scenario, lifted, arm, devices, spots: Vec::new() };
        let period = scenario.control_period;
        let on_reference = times(places).into_iter().map(|part| part * scenario.duration);
        let spots: Vec<_> = [(0.0, Place::Start)]
            .into_iter()
            .chain(on_reference.map(|time| (time, Place::Reference)))
            .map(|(time, place)| Spot { time, place, around: probe.around(time, place, period) })
            .collect();
        probe.spots = spots;
        Ok(Some(probe))
    }

    /// The loop at a time and place, with control periods of `period` in s.
    fn around(&self, time: f64, place: Place, period: f64) -> Around {
        let at = |t: f64| match place {
            Place::Start => self.start(),
            Place::Reference => self.on_reference(t),
        };
        Around::new(&*self.lifted, &self.devices, period, &at((time - period).max(0.0)), &|after| {
            at(time + after)
        })
    }

    fn start(&self) -> Nominal {
        let initial = &self.scenario.initial;
        let motion = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let motion: Vec<f64> = motion;
        let u_m = self.lifted.torque(&self.scenario.controller, 0.0, &motion);
        Nominal { motion, u_m }
    }

    /// Links on the reference, motors where that takes them.
    fn on_reference(&self, t: f64) -> Nominal {
        let q_l = self.lifted.reference(t);
        let (mut q_m, mut u_m) = (vec![[0.0; 4]; q_l.len()], vec![[0.0; 2]; q_l.len()]);
        self.arm.feed_forward(&q_l, &mut q_m, &mut u_m).expect("a series a joint");
        let links = |k: usize| q_l.iter().map(move |q| q[k]);
        let motors = |k: usize| q_m.iter().map(move |q| q[k]);
        let motion = links(0).chain(motors(0)).chain(links(1)).chain(motors(1)).collect();
        Nominal { motion, u_m: u_m.iter().map(|u| u[0]).collect() }
    }

    /// How far apart the links are on the reference at two times, in rad.
    fn moved(&self, from: f64, to: f64) -> f64 {
        let [from, to] = [from, to].map(|time| self.lifted.reference(time));
        from.iter().zip(&to).fold(0.0, |farthest: f64, (a, b)| farthest.max((b[0] - a[0]).abs()))
    }

    /// Spectral radius of a spot with `law`, per control period.
    fn radius(&self, spot: &Spot, law: &Controller) -> f64 {
        self.radius_of(spot, law, &spot.around)
    }

    fn radius_of(&self, spot: &Spot, law: &Controller, around: &Around) -> f64 {
        let radius = spectral_radius(&self.cycle(spot, law, around));
        radius.powf(1.0 / f64::from(self.devices.cycle))
    }

    /// The map over a cycle.
    fn cycle(&self, spot: &Spot, law: &Controller, around: &Around) -> Dense<f64> {
        let settled = spot.place == Place::Reference;
        let at = |t: f64| if settled { self.on_reference(t) } else { self.start() };
        let (before, now) = (at((spot.time - self.scenario.control_period).max(0.0)), at(spot.time));
        around.cycle(&match self.lifted.memory(law, spot.time, [&before, &now], settled) {
            Some(device) => LawSlope::Dynamic(device),
            None => LawSlope::Static(self.lifted.law(law, spot.time, &now.motion)),
        })
    }

    /// The largest spectral radius with `law` that counts, where it is, and by what small errors shrink a control period, if they do.
    fn found(&self, law: &Controller) -> (f64, usize, Option<f64>) {
        let (radius, worst) = self.worst(law);
        let growth = if radius < 1.0 + ROUNDING { Some(radius) } else { self.passed(law, worst) };
        (radius, worst, growth)
    }

    /// The largest spectral radius with `law` that counts, and where it is; what is no number is larger than any.
    fn worst(&self, law: &Controller) -> (f64, usize) {
        let radii = self.spots.iter().map(|spot| (spot.place, self.radius(spot, law))).zip(0..);
        let passing = |place, radius| place == Place::Start && (1.0..PASSING).contains(&radius);
        radii
            .filter(|((place, radius), _)| !passing(*place, *radius))
            .map(|((_, radius), i)| (radius, i))
            .max_by(|(x, _), (y, _)| x.abs().total_cmp(&y.abs()))
            .expect("the reference has places")
    }
}
