//! The imperfections by name.

use flexure_core::linalg::Vector;

use crate::files::Entry;
use crate::imperfections::stages::{
    Actuating, Actuator, CurrentQuantisation, Deadlines, Delay, Dropout, Encoder, Missed, Noise, Outage,
    PerSide, Random, Sampling, Saturation, Sensing, Sensors, Slew,
};
use crate::imperfections::{self, Imperfection, Side};
use crate::robot::vector;

/// The registered imperfections.
pub const IMPERFECTIONS: &[Entry] = &[
    Entry { name: "noise", summary: "white noise on measured positions and velocities" },
    Entry {
        name: "encoder",
        summary: "positions in counts, with or without dither, on links, motors or both",
    },
    Entry { name: "sampling", summary: "sensors that deliver every so many control periods" },
    Entry { name: "dropout", summary: "sensors that fall silent for a while, holding or giving NaN" },
    Entry { name: "velocity-filter", summary: "velocities as filtered differences of positions" },
    Entry { name: "deadline", summary: "control instants that the law misses" },
    Entry { name: "torque-gain", summary: "drives that give more or less torque than is asked for" },
    Entry { name: "current-quantisation", summary: "motor torque in steps" },
    Entry { name: "saturation", summary: "largest motor torque" },
    Entry { name: "torque-rate", summary: "largest rate of the motor torque" },
    Entry { name: "delay", summary: "torque that comes late, by any fraction of control periods" },
    Entry { name: "friction", summary: "Coulomb and Stribeck friction of links or motors" },
    Entry { name: "spring", summary: "springs that harden, have play or lose energy" },
    Entry { name: "model-error", summary: "a simulated robot that is not the one of the law" },
    Entry { name: "push", summary: "torque from outside on the links" },
];

/// The place of a kind among the stages: that of its entry.
fn rank(kind: &str) -> usize {
    IMPERFECTIONS.iter().position(|entry| entry.name == kind).unwrap_or(IMPERFECTIONS.len())
}

/// The sensors of a loop with `imperfections`, which draw from streams of `seed`.
pub fn sensors<const N: usize>(imperfections: &[Imperfection], seed: u64) -> Sensors<N> {
    let encoders = || {
        imperfections.iter().filter_map(|imperfection| match imperfection {
            Imperfection::Encoder(encoder) => Some(encoder),
            _ => None,
        })
    };
    let placed = Side::ALL.map(|side| {
        encoders().next().is_none() || encoders().any(|encoder| encoder.resolution(side).is_some())
    });
    Sensors::new(placed, stages(imperfections, seed, sensing))
}

/// The actuator of a loop with `imperfections` and control periods of `period` \[s\]; `before` is the torque until the
/// first command arrives [N m].
pub fn actuator<const N: usize>(
    imperfections: &[Imperfection],
    seed: u64,
    period: f64,
    before: Vector<f64, N>,
) -> Actuator<N> {
    let delay = imperfections.iter().find_map(|imperfection| match imperfection {
        Imperfection::Delay(delay) => Some(Delay::new(delay.total(), period, before)),
        _ => None,
    });
    Actuator::new(stages(imperfections, seed, |what, random| actuating(what, random, before)), delay)
}

/// The stages that `make` makes of imperfections, given each its random numbers, in the order of the registry.
fn stages<T>(
    imperfections: &[Imperfection],
    seed: u64,
    make: impl Fn(&Imperfection, Random) -> Option<T>,
) -> Vec<T> {
    let mut stages: Vec<_> = imperfections
        .iter()
        .enumerate()
        .filter_map(|(i, imperfection)| {
            let kind = imperfection.kind();
            let index = imperfections.iter().take(i).filter(|earlier| earlier.kind() == kind).count();
            Some((rank(kind), make(imperfection, Random::new(seed, kind, index as u64))?))
        })
        .collect();
    stages.sort_by_key(|(rank, _)| *rank);
    stages.into_iter().map(|(_, stage)| stage).collect()
}

fn sensing<const N: usize>(imperfection: &Imperfection, random: Random) -> Option<Box<dyn Sensing<N>>> {
    let per_side = |sides: imperfections::Sides| Side::ALL.map(|side| sides.contain(side));
    Some(match imperfection {
        Imperfection::Encoder(encoder) => Box::new(Encoder {
            resolution: Side::ALL.map(|side| encoder.resolution(side).map(vector)),
            dither: encoder.dither.then_some(random),
        }),
        Imperfection::Noise(noise) => Box::new(Noise {
            position: [vector(&noise.link), vector(&noise.motor)],
            velocity: [vector(&noise.link_velocity), vector(&noise.motor_velocity)],
            random,
        }),
        Imperfection::Sampling(sampling) => {
            let periods: PerSide<u32> =
                per_side(sampling.sides).map(|slow| if slow { sampling.periods } else { 1 });
            Box::new(Sampling::new(periods))
        }
        Imperfection::Dropout(dropout) => {
            let outage = match dropout.outage {
                imperfections::Outage::Window { from, until } => Outage::Window { from, until },
                imperfections::Outage::Random { probability, mean_length } => {
                    Outage::Random { probability, mean_length, random }
                }
            };
            let holds = dropout.mode == imperfections::DropoutMode::Hold;
            Box::new(Dropout::new(per_side(dropout.sides), holds, outage))
        }
        _ => return None,
    })
}

fn actuating<const N: usize>(
    imperfection: &Imperfection,
    random: Random,
    before: Vector<f64, N>,
) -> Option<Box<dyn Actuating<N>>> {
    Some(match imperfection {
        Imperfection::Deadline(imperfections::Deadline::Random { probability }) => {
            Box::new(Deadlines::new(Missed::Random(*probability, random), before))
        }
        Imperfection::Deadline(imperfections::Deadline::Every(every)) => {
            Box::new(Deadlines::new(Missed::Every(*every), before))
        }
        Imperfection::CurrentQuantisation(step) => Box::new(CurrentQuantisation(vector(step))),
        Imperfection::Saturation(limit) => Box::new(Saturation(vector(limit))),
        Imperfection::TorqueRate(rate) => Box::new(Slew::new(vector(rate), before)),
        _ => return None,
    })
}
