//! Imperfections of sensing and actuation: what all of them have in common, and each in numbers.

mod actuation;
mod all;
mod memory;
mod sensing;

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::imperfections::stages::{Actuator, Measured, Pieces, Sensors, Tick};
use flexure::imperfections::{Effects, Imperfection, STRENGTHS, Strengths};
use flexure::scenario::scenario_from_text;

/// Control period of all loops here \[s\].
const PERIOD: f64 = 0.001;

/// A motion in which nothing is constant or a multiple of anything else.
fn motion(t: f64) -> Motion<f64, 2> {
    let wave = |omega: f64, phase: f64| [(omega * t + phase).sin(), omega * (omega * t + phase).cos()];
    let [[a, da], [b, db], [c, dc], [d, dd]] =
        [wave(3.1, 0.2), wave(4.7, -1.0), wave(5.3, 0.4), wave(2.9, 2.0)];
    Motion { q_l: Vector([a, b]), q_m: Vector([c, d]), v_l: Vector([da, db]), v_m: Vector([dc, dd]) }
}

/// A torque of the same sort, up to 3.5 N m.
fn torque(t: f64) -> Vector<f64, 2> {
    Vector([3.0 * (21.0 * t + 0.3).sin() + 0.5, 2.0 * (33.0 * t - 0.4).cos()])
}

/// Sensors of a robot with two joints.
fn sensors(imperfections: &[Imperfection], seed: u64) -> Sensors {
    Effects::of(imperfections, 2, PERIOD, seed).sensors
}

/// Drives of a robot with two joints that gave `before` N m until now.
fn actuator(imperfections: &[Imperfection], seed: u64, before: Vector<f64, 2>) -> Actuator {
    let mut actuator = Effects::of(imperfections, 2, PERIOD, seed).actuator;
    actuator.start(&before);
    actuator
}

/// The entry of `kind` with these keys, read in the scenario that registered strengths are for.
fn entry(kind: &str, keys: &str) -> Imperfection {
    let text = flexure::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-hardware").unwrap().1;
    let text = text.split("[guard]").next().unwrap();
    let text = format!("{text}[[imperfection]]\nkind = \"{kind}\"\n{keys}\n");
    let scenario = scenario_from_text(kind, &text, ".".as_ref()).unwrap_or_else(|bad| panic!("{bad}"));
    let [imperfection] = &scenario.imperfections[..] else { panic!("one entry") };
    imperfection.clone()
}

/// Every registered kind with no, little and much strength.
fn registered() -> impl Iterator<Item = (&'static str, [Option<Imperfection>; 3])> {
    STRENGTHS.iter().map(|&(kind, Strengths { none, little, much })| {
        (kind, [none, Some(little), Some(much)].map(|keys| keys.map(|keys| entry(kind, keys))))
    })
}

/// What is read at the first `count` control instants.
fn readings(imperfections: &[Imperfection], seed: u64, count: u64) -> Vec<Measured<2>> {
    let mut sensors = sensors(imperfections, seed);
    (0..count)
        .map(|k| Tick::new(k, PERIOD))
        .map(|instant| sensors.sense(&instant, &motion(instant.t)))
        .collect()
}

/// Torque over the first `count` control periods of a robot that gave none before.
fn torques(imperfections: &[Imperfection], seed: u64, count: u64) -> Vec<Pieces<2>> {
    driven(imperfections, seed, count, torque)
}

/// The same with `command` as the commanded torque.
fn driven(
    imperfections: &[Imperfection],
    seed: u64,
    count: u64,
    command: impl Fn(f64) -> Vector<f64, 2>,
) -> Vec<Pieces<2>> {
    let Effects { mut computer, mut actuator, .. } = Effects::of(imperfections, 2, PERIOD, seed);
    actuator.start(&Vector::<_, 2>::ZERO);
    let mut last = Vector::ZERO;
    (0..count)
        .map(|k| Tick::new(k, PERIOD))
        .map(|instant| {
            if !computer.is_still(&instant) && !computer.misses(&instant) {
                last = command(instant.t);
            }
            actuator.actuate(&instant, last)
        })
        .collect()
}

fn positions(motion: &Motion<f64, 2>) -> impl Iterator<Item = f64> {
    motion.q_l.0.into_iter().chain(motion.q_m.0)
}

fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}
