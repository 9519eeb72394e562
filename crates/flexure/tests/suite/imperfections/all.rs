//! Laws of all imperfections: nothing at zero strength, the same under the same seed, worse when stronger, and each with
//! random numbers of its own.

use std::slice;

use flexure::core::linalg::Vector;
use flexure::core::memory::{Memory, Port};
use flexure::core::model::Motion;
use flexure::imperfections::stages::{Measured, Pieces, Random, Tick};
use flexure::imperfections::{
    Dropout, DropoutMode, Effects, Encoder, IMPERFECTIONS, Imperfection, Noise, Outage, STRENGTHS, Side,
    Sides,
};

use super::{PERIOD, mean, motion, positions, readings, registered, sensors, torque, torques};

/// An imperfection of strength none (0), if it has that, little (1) or much (2).
struct Graded {
    name: &'static str,
    at: [Option<Imperfection>; 3],
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

/// Every registered kind, and encoders of one sort each.
fn all() -> Vec<Graded> {
    let encoders = [false, true].map(|dither| {
        let at = [0.0, 1e-3, 1e-2].map(|resolution| Some(encoder(resolution, dither)));
        Graded { name: "encoder", at }
    });
    registered().map(|(name, at)| Graded { name, at }).chain(encoders).collect()
}

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

/// How many streams of random numbers something draws from.
fn streams(of: &mut dyn Memory<f64>) -> usize {
    struct Streams(usize);
    impl Port<f64> for Streams {
        fn numbers(&mut self, _: &'static str, _: &'static str, _: &mut [f64]) {}
        fn joints(&mut self, _: &'static str, _: &'static str, _: &mut [f64]) {}
        fn word(&mut self, _: &'static str, _: &mut u32) {}
        fn flag(&mut self, _: &'static str, _: &mut bool) {}
        fn enter(&mut self, name: &'static str) {
            self.0 += usize::from(name == "random");
        }
    }
    let mut streams = Streams(0);
    of.memory(&mut streams);
    streams.0
}

#[test]
fn strengths_are_of_their_kind() {
    for (name, at) in registered() {
        assert!(at.iter().flatten().all(|imperfection| imperfection.kind() == name), "{name}");
    }
    assert!(STRENGTHS.iter().map(|(kind, _)| kind).eq(IMPERFECTIONS.iter().map(|entry| &entry.name)));
}

#[test]
fn at_zero_strength_no_bit_changes() {
    let nothing = (sensed_bits(&readings(&[], 7, COUNT)), torque_bits(&torques(&[], 7, COUNT)));
    for Graded { name, at: [none, ..] } in all() {
        let Some(none) = none.map(|none| [none]) else { continue };
        let read = readings(&none, 7, COUNT);
        assert!(read.iter().all(|measured| measured.age == [0; 2] && measured.placed == [true; 2]));
        assert_eq!((sensed_bits(&read), torque_bits(&torques(&none, 7, COUNT))), nothing, "{name}");
    }
    let together: Vec<_> = all().into_iter().filter_map(|Graded { at: [none, ..], .. }| none).collect();
    assert_eq!(sensed_bits(&readings(&together, 7, COUNT)), nothing.0);
    assert_eq!(torque_bits(&torques(&together, 7, COUNT)), nothing.1);
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
    for Graded { name, at: [none, ..] } in all() {
        let Some(none) = none else { continue };
        let read = sensors(&[none], 3).sense(&Tick::new(0, PERIOD), &zero);
        assert_eq!(sensed_bits(&[read]), sensed_bits(&[Measured::exactly(zero)]), "{name}");
    }
}

/// Another seed makes a difference exactly where random numbers are drawn.
#[test]
fn a_seed_says_everything_and_another_something_else() {
    let check = |name: &str, streams: usize, run: &dyn Fn(u64) -> Vec<u64>| {
        assert_eq!(run(1), run(1), "{name}");
        assert_eq!(run(1) != run(2), streams > 0, "{name}");
    };
    let mut random = 0;
    for Graded { name, at: [.., much] } in all() {
        let much = &much.map(|much| [much]).unwrap();
        let Effects { mut sensors, mut computer, mut actuator, .. } = Effects::of(much, 2, PERIOD, 1);
        let (sensing, acting) = (streams(&mut sensors), streams(&mut computer) + streams(&mut actuator));
        check(name, sensing, &|seed| sensed_bits(&readings(much, seed, COUNT)));
        check(name, acting, &|seed| torque_bits(&torques(much, seed, COUNT)));
        random += sensing + acting;
    }
    assert!(random >= 5, "noise, dither twice, dropouts, deadlines");
}

/// By a factor: less would be chance. What changes neither readings nor torques is tested in whole loops.
#[test]
fn stronger_is_worse() {
    let mut between = 0;
    for Graded { name, at } in all() {
        let of = |measure: &dyn Fn(&[Imperfection]) -> f64| {
            let [none, little, much] =
                at.each_ref().map(|at| at.as_ref().map_or(0.0, |at| measure(slice::from_ref(at))));
            assert!(
                none == 0.0 && ((little, much) == (0.0, 0.0) || little > 0.0 && much > 2.0 * little),
                "{name}"
            );
            usize::from(much > 0.0)
        };
        between += of(&|imperfections| error(&readings(imperfections, 7, COUNT)));
        between += of(&|imperfections| misery(&torques(imperfections, 7, COUNT)));
    }
    assert!(between >= 11, "six of sensors, five of drives");
}

#[test]
fn order_in_the_file_does_not_matter() {
    let much: Vec<_> = registered().filter_map(|(_, [.., much])| much).collect();
    let reversed: Vec<_> = much.iter().rev().cloned().collect();
    let sensed = |imperfections: &[Imperfection]| sensed_bits(&readings(imperfections, 7, COUNT));
    let driven = |imperfections: &[Imperfection]| torque_bits(&torques(imperfections, 7, COUNT));
    assert_eq!((sensed(&much), driven(&much)), (sensed(&reversed), driven(&reversed)));
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

/// What says that it draws random numbers gives something else with another seed, and what does not never does.
#[test]
fn seeds_matter_to_what_draws() {
    let mut drawing = 0;
    for (kind, strengths) in registered() {
        for imperfection in strengths.into_iter().flatten() {
            let of = |seed: u64| {
                let alone = [imperfection.clone()];
                (format!("{:?}", readings(&alone, seed, 2000)), format!("{:?}", torques(&alone, seed, 2000)))
            };
            assert_eq!(of(1) != of(2), imperfection.draws(), "{kind}: {imperfection:?}");
            drawing += usize::from(imperfection.draws());
        }
    }
    assert!(drawing >= 6, "{drawing}");
}
