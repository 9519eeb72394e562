//! Laws of all imperfections: nothing at zero strength, the same under the same seed, worse when stronger, and each with
//! random numbers of its own.

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::imperfections::IMPERFECTIONS;
use flexure::imperfections::stages::Measured;
use flexure::imperfections::stages::{Pieces, Random};
use flexure::imperfections::{
    Deadline, Delay, Dropout, DropoutMode, Encoder, Imperfection, Noise, Outage, Sampling, Side, Sides,
};

use super::{PERIOD, mean, motion, positions, readings, torque, torques};

/// An imperfection of strength none (0), little (1) or much (2).
struct Graded {
    name: &'static str,
    at: fn(usize) -> Imperfection,
    is_random: bool,
}

fn noise(deviation: f64) -> Imperfection {
    let same = || vec![deviation; 2];
    Imperfection::Noise(Noise { link: same(), motor: same(), link_velocity: same(), motor_velocity: same() })
}

fn encoder(resolution: f64, dither: bool) -> Imperfection {
    let same = || Some(vec![resolution; 2]);
    Imperfection::Encoder(Encoder { link: same(), motor: same(), dither })
}

fn dropout(probability: f64) -> Imperfection {
    let outage = Outage::Random { probability, mean_length: 4.0 };
    Imperfection::Dropout(Dropout { sides: Sides::Both, mode: DropoutMode::Hold, outage })
}

const SENSING: &[Graded] = &[
    Graded { name: "noise", at: |i| noise([0.0, 1e-3, 1e-2][i]), is_random: true },
    Graded { name: "encoder", at: |i| encoder([0.0, 1e-3, 1e-2][i], false), is_random: false },
    Graded { name: "encoder", at: |i| encoder([0.0, 1e-3, 1e-2][i], true), is_random: true },
    Graded {
        name: "sampling",
        at: |i| Imperfection::Sampling(Sampling { sides: Sides::Both, periods: [1, 3, 10][i] }),
        is_random: false,
    },
    Graded { name: "dropout", at: |i| dropout([0.0, 0.01, 0.2][i]), is_random: true },
];

const ACTUATION: &[Graded] = &[
    Graded {
        name: "deadline",
        at: |i| Imperfection::Deadline(Deadline::Random { probability: [0.0, 0.05, 0.5][i] }),
        is_random: true,
    },
    Graded {
        name: "current-quantisation",
        at: |i| Imperfection::CurrentQuantisation(vec![[0.0, 0.05, 0.5][i]; 2]),
        is_random: false,
    },
    Graded {
        name: "saturation",
        at: |i| Imperfection::Saturation(vec![[f64::INFINITY, 1.9, 1.0][i]; 2]),
        is_random: false,
    },
    Graded {
        name: "torque-rate",
        at: |i| Imperfection::TorqueRate(vec![[f64::INFINITY, 50.0, 20.0][i]; 2]),
        is_random: false,
    },
    Graded {
        name: "delay",
        at: |i| {
            Imperfection::Delay(Delay { computation: [0.0, 4e-4, 4e-4][i], actuation: [0.0, 0.0, 2.3e-3][i] })
        },
        is_random: false,
    },
];

/// Those that are not between law and robot, or are made of something else that has tests of its own.
const ELSEWHERE: &[&str] = &["velocity-filter", "torque-gain", "friction", "spring", "model-error", "push"];

const COUNT: u64 = 2000;

fn bits(vectors: impl IntoIterator<Item = Vector<f64, 2>>) -> Vec<u64> {
    vectors.into_iter().flat_map(|vector| vector.0.map(f64::to_bits)).collect()
}

fn sensed_bits(readings: &[Measured<2>]) -> Vec<u64> {
    bits(readings.iter().flat_map(|Measured { motion: x, .. }| [x.q_l, x.q_m, x.v_l, x.v_m]))
}

fn torque_bits(torques: &[Pieces<2>]) -> Vec<u64> {
    let pieces = || torques.iter().flat_map(Pieces::iter);
    pieces().map(|(offset, _)| offset.to_bits()).chain(bits(pieces().map(|(_, torque)| torque))).collect()
}

/// Mean square of what is read beside the truth.
fn error(readings: &[Measured<2>]) -> f64 {
    mean(readings.iter().enumerate().flat_map(|(k, measured)| {
        let truth: Vec<_> = positions(&motion(k as f64 * PERIOD)).collect();
        positions(&measured.motion)
            .zip(truth)
            .map(|(read, true_one)| (read - true_one).powi(2))
            .collect::<Vec<_>>()
    }))
}

/// Mean square in time of what acts beside the command.
fn misery(torques: &[Pieces<2>]) -> f64 {
    mean(torques.iter().enumerate().map(|(k, pieces)| {
        let wanted = torque(k as f64 * PERIOD);
        let square = |given: Vector<f64, 2>| (given - wanted).dot(&(given - wanted));
        pieces.spans(PERIOD).map(|(_, length, given)| length / PERIOD * square(given)).sum()
    }))
}

#[test]
fn every_registered_one_is_here_or_has_tests_of_its_own() {
    let here = SENSING.iter().chain(ACTUATION).map(|graded| graded.name);
    for graded in SENSING.iter().chain(ACTUATION) {
        assert_eq!((graded.at)(1).kind(), graded.name);
    }
    let mut known: Vec<_> = here.chain(ELSEWHERE.iter().copied()).collect();
    known.sort_unstable();
    known.dedup();
    let mut registered: Vec<_> = IMPERFECTIONS.iter().map(|entry| entry.name).collect();
    registered.sort_unstable();
    assert_eq!(known, registered);
}

#[test]
fn at_zero_strength_no_bit_changes() {
    for Graded { name, at, .. } in SENSING {
        let read = readings(&[at(0)], 7, COUNT);
        assert!(read.iter().all(|measured| measured.age == [0; 2] && measured.placed == [true; 2]));
        assert_eq!(sensed_bits(&read), sensed_bits(&readings(&[], 7, COUNT)), "{name}");
    }
    for Graded { name, at, .. } in ACTUATION {
        assert_eq!(torque_bits(&torques(&[at(0)], 7, COUNT)), torque_bits(&torques(&[], 7, COUNT)), "{name}");
    }
    let all: Vec<_> = SENSING.iter().map(|graded| (graded.at)(0)).collect();
    assert_eq!(sensed_bits(&readings(&all, 7, COUNT)), sensed_bits(&readings(&[], 7, COUNT)));
    let exact = motion(5.0 * PERIOD);
    assert_eq!(readings(&[], 0, 6)[5], Measured::exactly(exact));
    assert_eq!(torques(&[], 0, 6)[5], Pieces::constant(torque(5.0 * PERIOD)));
}

/// Zeros of either sign and torques that are exactly at a limit are zero strength, too.
#[test]
fn signs_of_zeros_survive() {
    let zero = Motion {
        q_l: Vector([-0.0, 0.0]),
        q_m: Vector([0.0, -0.0]),
        v_l: Vector([-0.0; 2]),
        v_m: Vector([0.0; 2]),
    };
    for Graded { name, at, .. } in SENSING {
        let mut sensors = flexure::imperfections::sensors(&[at(0)], 3);
        let read = sensors.sense(&flexure::imperfections::stages::Tick::new(0, PERIOD), &zero);
        assert_eq!(sensed_bits(&[read]), sensed_bits(&[Measured::exactly(zero)]), "{name}");
    }
}

#[test]
fn a_seed_says_everything_and_another_something_else() {
    let check = |name: &str, is_random: bool, run: &dyn Fn(u64) -> Vec<u64>| {
        assert_eq!(run(1), run(1), "{name}");
        assert_eq!(run(1) != run(2), is_random, "{name}");
    };
    for Graded { name, at, is_random } in SENSING {
        check(name, *is_random, &|seed| sensed_bits(&readings(&[at(2)], seed, COUNT)));
    }
    for Graded { name, at, is_random } in ACTUATION {
        check(name, *is_random, &|seed| torque_bits(&torques(&[at(2)], seed, COUNT)));
    }
}

#[test]
fn stronger_is_worse() {
    let check = |name: &str, errors: [f64; 3]| {
        // By a factor: less would be chance.
        assert!(errors[0] == 0.0 && errors[1] > 0.0 && errors[2] > 2.0 * errors[1], "{name}: {errors:?}");
    };
    for Graded { name, at, .. } in SENSING {
        check(name, [0, 1, 2].map(|strength| error(&readings(&[at(strength)], 7, COUNT))));
    }
    for Graded { name, at, .. } in ACTUATION {
        check(name, [0, 1, 2].map(|strength| misery(&torques(&[at(strength)], 7, COUNT))));
    }
}

#[test]
fn order_in_the_file_does_not_matter() {
    let reversed = |imperfections: &[Imperfection]| imperfections.iter().rev().cloned().collect::<Vec<_>>();
    let sensing: Vec<_> =
        SENSING.iter().filter(|graded| graded.name != "encoder" || graded.is_random).collect();
    let sensing: Vec<_> = sensing.into_iter().map(|graded| (graded.at)(2)).collect();
    let actuation: Vec<_> = ACTUATION.iter().map(|graded| (graded.at)(2)).collect();
    assert_eq!(
        sensed_bits(&readings(&sensing, 7, COUNT)),
        sensed_bits(&readings(&reversed(&sensing), 7, COUNT))
    );
    assert_eq!(
        torque_bits(&torques(&actuation, 7, COUNT)),
        torque_bits(&torques(&reversed(&actuation), 7, COUNT))
    );
}

/// Noise is the same with dither, outages, late deadlines and another noise around it; and the other noise is another.
#[test]
fn each_has_random_numbers_of_its_own() {
    let error = |imperfections: &[Imperfection]| -> Vec<Vec<f64>> {
        let read = readings(imperfections, 7, COUNT);
        let off = |(k, measured): (usize, &Measured<2>)| {
            let truth: Vec<_> = positions(&motion(k as f64 * PERIOD)).collect();
            positions(&measured.motion).zip(truth).map(|(read, true_one)| read - true_one).collect()
        };
        read.iter().enumerate().map(off).collect()
    };
    let alone = error(&[noise(1e-2)]);
    let coarse = error(&[encoder(1e-9, true), noise(1e-2)]);
    let twice = error(&[noise(1e-2), noise(1e-2)]);
    let (mut same, mut product, mut square) = (0, 0.0, 0.0);
    for ((alone, coarse), twice) in alone.iter().zip(&coarse).zip(&twice) {
        for ((a, b), c) in alone.iter().zip(coarse).zip(twice) {
            // One count, with dither.
            assert!((a - b).abs() < 1.1e-9);
            same += u32::from((c - 2.0 * a).abs() < 1e-12);
            product += a * (c - a);
            square += a * a;
        }
    }
    // Correlation of 8000 independent pairs: 0.011 is one standard deviation.
    assert!(same == 0 && (product / square).abs() < 0.06, "{}", product / square);
    let silent = |imperfections: &[Imperfection]| -> Vec<bool> {
        readings(imperfections, 7, COUNT)
            .iter()
            .map(|measured| measured.age[Side::Motor as usize] > 0)
            .collect()
    };
    assert_eq!(silent(&[dropout(0.1)]), silent(&[noise(1.0), encoder(0.1, true), dropout(0.1)]));
}

/// Seed, kind and index all count; and what they say is the same in every version: these are the first numbers of
/// xoshiro256++ after SplitMix64 from the hash, as an independent program gives them.
#[test]
fn streams_are_told_apart_and_stay_as_they_are() {
    let first = |seed, kind, index| Random::new(seed, kind, index).uniform().to_bits();
    let streams = [
        first(0, "noise", 0),
        first(0, "noise", 1),
        first(1, "noise", 0),
        first(0, "dropout", 0),
        first(256, "noise", 0),
    ];
    for (i, stream) in streams.iter().enumerate() {
        assert!(streams.iter().skip(i + 1).all(|other| other != stream));
    }
    let mut random = Random::new(7, "noise", 1);
    for expected in [0.7403135434750249, 0.9267012025334068, 0.5915823722714179] {
        assert_eq!(random.uniform().to_bits(), f64::to_bits(expected));
    }
}
