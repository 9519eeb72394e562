//! What a loop is to tubes: its sensors, what guard and drives let pass, and what they do not speak of.

use flexure_core::scalar::Interval;

use crate::files::{Problem, Problems};
use crate::imperfections::{
    Bias, Delay, Encoder, Imperfection, Saturation, Side, TorqueRate, VelocityFilter,
};
use crate::prove::engine::sampled_data::sensors::{Filter, Sensors};
use crate::prove::engine::sampled_data::watch::{Passes, Readings};
use crate::scenario::{GuardSettings, Hold, Scenario};
use crate::simulate::acting_limits;

/// What guard and drives of `scenario` do nothing about.
pub fn passes(scenario: &Scenario) -> Passes {
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
pub fn sensors(scenario: &Scenario) -> Sensors {
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
    // So that there is a short decimal between what may be off and what is proved about.
    for off in &mut off {
        *off = off.next_up();
    }
    let filter = each().find_map(Imperfection::of::<VelocityFilter>).map(|filter| {
        let [feedback, forward] = filter.low_pass(scenario.control_period).coefficients();
        Filter { feedback: feedback.map(Interval::point), forward: forward.map(Interval::point) }
    });
    Sensors { off, filter }
}

/// Whether no reading of `scenario` is off.
pub(crate) fn reads_exactly(scenario: &Scenario) -> bool {
    sensors(scenario).off.is_empty()
}

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
    let others = scenario.imperfections.iter().filter(|imperfection| !spoken_of(imperfection));
    let mut kinds: Vec<_> = others.map(|other| format!("'{}'", other.kind())).collect();
    kinds.dedup();
    let kinds = kinds.join(", ");
    add(!kinds.is_empty(), "imperfection", &format!("has imperfections of kind {kinds}"));
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
