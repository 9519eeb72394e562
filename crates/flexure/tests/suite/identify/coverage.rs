//! Are the error bars what they say? Many arms, each with other numbers and another motion.

use std::ops::Range;

use flexure::Robot;
use flexure::identify::{Parameter, Settings, identify};
use flexure::progress::unwatched;
use rayon::prelude::*;

use super::arm;
use super::simulated::{DELAY, Draw, log};

/// The encoders that a log has.
#[derive(Clone, Copy, Debug)]
enum Encoders {
    Both,
    Motors,
}

/// A number that counts as known: what it is, how far it is off as a part of it, and whether that is within its error bar.
struct Known {
    of: &'static str,
    off: f64,
    inside: bool,
}

/// The numbers that count as known in one log of `seconds` of an arm that `seed` draws.
fn known<const N: usize>(robot: &Robot, seed: u64, seconds: f64, encoders: Encoders) -> Vec<Known> {
    let mut draw = Draw::new(seed);
    let truth = draw.truth(robot);
    let mut log = log::<N>(robot, &truth, seconds, 0.0, &mut draw);
    if let Encoders::Motors = encoders {
        log.q_l = None;
    }
    let found = identify(robot, &[log], &Settings::default(), &unwatched)
        .unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
    let of_joints = truth.iter().enumerate().flat_map(|(i, joint)| {
        let estimates = Parameter::ALL
            .into_iter()
            .map(|p| (p.name(), found.estimate(i, p)))
            .zip(joint)
            .collect::<Vec<_>>();
        estimates.into_iter().map(|((of, e), &exact)| (of, e.known, e.value, e.error, exact))
    });
    let offset = &found.offsets[0];
    std::iter::once(("offset", true, offset.value, offset.error, DELAY))
        .chain(of_joints)
        .filter(|(_, is_known, ..)| *is_known)
        .map(|(of, _, value, error, exact)| Known {
            of,
            off: (value / exact - 1.0).abs(),
            inside: (value - exact).abs() <= error,
        })
        .collect()
}

/// How far a number may be off with encoders of both sides [%].
fn wanted(of: &str) -> f64 {
    match of {
        "stiffness" => 0.5,
        "motor_inertia" => 1.0,
        "link_damping" | "motor_damping" => 10.0,
        "link_friction" | "motor_friction" => 5.0,
        _ => 100.0,
    }
}

/// The seeds that `IDENTIFY_SEEDS` asks for: `20` are the first 20, `20..40` those after them; 200 if it is not set.
fn seeds() -> Range<u64> {
    let Ok(text) = std::env::var("IDENTIFY_SEEDS") else { return 0..200 };
    let number = |text: &str| text.parse().unwrap_or_else(|_| panic!("IDENTIFY_SEEDS = {text:?}: no number"));
    match text.split_once("..") {
        Some((from, to)) => number(from)..number(to),
        None => 0..number(&text),
    }
}

/// Prints how many numbers lie within their error bars and how far they are off, for each seed when it is done and for all, and asserts the share.
fn hold_97_percent<const N: usize>(robot: &Robot, seconds: f64, encoders: Encoders) {
    let of_seeds: Vec<Vec<Known>> = seeds()
        .into_par_iter()
        .map(|seed| {
            let known = known::<N>(robot, seed, seconds, encoders);
            println!("seed {seed}: {} of {}", known.iter().filter(|known| known.inside).count(), known.len());
            known
        })
        .collect();
    let seeds = of_seeds.len();
    let all: Vec<Known> = of_seeds.into_iter().flatten().collect();
    let inside = all.iter().filter(|known| known.inside).count();
    let share = inside as f64 / all.len() as f64;
    println!(
        "{}, {encoders:?}, {seeds} seeds: {inside} of {}, {:.2} %",
        robot.name,
        all.len(),
        100.0 * share
    );
    for of in ["offset"].into_iter().chain(Parameter::ALL.map(Parameter::name)) {
        let mut off: Vec<f64> = all.iter().filter(|known| known.of == of).map(|known| known.off).collect();
        off.sort_by(f64::total_cmp);
        let Some(last) = off.len().checked_sub(1) else { continue };
        let [half, most, largest] = [last / 2, 99 * last / 100, last].map(|i| 100.0 * off[i]);
        let wanted = wanted(of);
        let within = off.iter().filter(|off| 100.0 * **off <= wanted).count();
        println!(
            "  {of}: {} known, {within} off by {wanted} % at most; {half:.3} % (median), {most:.3} % (99 of 100), {largest:.3} % (all)",
            off.len()
        );
    }
    if let Encoders::Both = encoders {
        let numbers = seeds as f64 * (1 + robot.joint_count() * Parameter::COUNT) as f64;
        assert!(all.len() as f64 >= 0.97 * numbers, "{} of {numbers} are known", all.len());
    }
    assert!(share >= 0.97, "{}, {encoders:?}: {share}", robot.name);
}

/// `cargo test --release -p flexure --test suite -- --ignored coverage::of_two --nocapture`.
#[test]
#[ignore = "a quarter of an hour of processor time"]
fn of_two_joints() {
    for encoders in [Encoders::Both, Encoders::Motors] {
        hold_97_percent::<4>(&arm(), 12.0, encoders);
    }
}

/// `IDENTIFY_SEEDS=200 cargo test --release -p flexure --test suite -- --ignored coverage::of_seven_joints_with_both --nocapture`.
#[test]
#[ignore = "an hour of processor time"]
fn of_seven_joints_with_both_encoders() {
    hold_97_percent::<8>(&Robot::load("panda").unwrap(), 20.0, Encoders::Both);
}

/// `IDENTIFY_SEEDS=20 cargo test --release -p flexure --test suite -- --ignored coverage::of_seven_joints_with_motor --nocapture`.
#[test]
#[ignore = "a minute of processor time a seed"]
fn of_seven_joints_with_motor_encoders() {
    hold_97_percent::<8>(&Robot::load("panda").unwrap(), 20.0, Encoders::Motors);
}
