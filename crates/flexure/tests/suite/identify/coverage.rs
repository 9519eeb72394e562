//! Are the error bars what they say? Many arms, each with other numbers and another motion.

use flexure::Robot;
use flexure::identify::{Parameter, Settings, identify};
use flexure::progress::unwatched;
use rayon::prelude::*;

use super::arm;
use super::simulated::{DELAY, Draw, log};

/// How many numbers that count as known lie within their errors, and how many there are.
fn covered<const N: usize>(robot: &Robot, seeds: u64, seconds: f64, of_links: bool) -> (usize, usize) {
    let of = |seed: u64| {
        let mut draw = Draw::new(seed);
        let truth = draw.truth(robot);
        let mut log = log::<N>(robot, &truth, seconds, 0.0, &mut draw);
        if !of_links {
            log.q_l = None;
        }
        let found = identify(robot, &[log], &Settings::default(), &unwatched)
            .unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
        let offset = &found.offsets[0];
        let mut inside = vec![(offset.value - DELAY).abs() <= offset.error];
        for (i, joint) in truth.iter().enumerate() {
            let known = Parameter::ALL.into_iter().map(|p| found.estimate(i, p)).zip(joint);
            inside
                .extend(known.filter(|(e, _)| e.known).map(|(e, exact)| (e.value - exact).abs() <= e.error));
        }
        (inside.iter().filter(|inside| **inside).count(), inside.len())
    };
    (0..seeds).into_par_iter().map(of).reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}

/// Prints and asserts the share with encoders of both sides and with those of the motors alone.
fn hold_97_percent<const N: usize>(robot: &Robot, seconds: f64) {
    let seeds = std::env::var("IDENTIFY_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(200);
    for (encoders, of_links) in [("both", true), ("motors", false)] {
        let (inside, all) = covered::<N>(robot, seeds, seconds, of_links);
        let share = inside as f64 / all as f64;
        println!("{}, {encoders}, {seeds} seeds: {inside} of {all}, {:.2} %", robot.name, 100.0 * share);
        assert!(share >= 0.97, "{}, {encoders}: {share}", robot.name);
    }
}

/// `IDENTIFY_SEEDS=200 cargo test --release -p flexure --test suite -- --ignored coverage::of_two --nocapture`.
#[test]
#[ignore = "a quarter of an hour of processor time"]
fn of_two_joints() {
    hold_97_percent::<4>(&arm(), 12.0);
}

/// `IDENTIFY_SEEDS=200 cargo test --release -p flexure --test suite -- --ignored coverage::of_seven --nocapture`.
#[test]
#[ignore = "hours of processor time"]
fn of_seven_joints() {
    hold_97_percent::<8>(&Robot::load("panda").unwrap(), 20.0);
}
