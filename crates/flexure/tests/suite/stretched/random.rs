//! Robots, gains and bounds at random: no state of the box contracts more slowly than is certified.

use flexure::Scenario;
use flexure::prove::engine::number::Number;
use flexure::prove::engine::verdict::Verdict;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, Region};
use flexure::prove::verified::certify;
use flexure::robot::JointKind;

use super::full::{Loop, State};
use crate::common::Random;
use crate::random_robots::robots;
use crate::verify::python;

/// Rates are compared with eigenvalues in floats, which have rounding of their own.
const ROUNDING: f64 = 1e-7;

/// What many robots come to: certified rate over the slowest sample, and over the rate in the constant metric.
#[derive(Default)]
struct Figures {
    shares: Vec<f64>,
    gains: Vec<f64>,
    undecided: usize,
    texts: Vec<String>,
}

impl Figures {
    fn print(&mut self) {
        let Self { shares, gains, undecided, .. } = self;
        shares.sort_by(f64::total_cmp);
        gains.sort_by(f64::total_cmp);
        let last = shares.len() - 1;
        println!(
            "{} robots, {undecided} undecided; certified over sampled: least {:.4}, median {:.4}, largest {:.9}; over constant: median {:.2}, largest {:.1}",
            last + 1,
            shares[0],
            shares[last / 2],
            shares[last],
            gains[last / 2],
            gains[last]
        );
    }
}

/// A configuration at random, sliding joints within their travel.
fn configuration(scenario: &Scenario, noise: &mut Random) -> Vec<f64> {
    let robot = &scenario.robot;
    let place = |i: usize| match robot.joints[i].kind {
        JointKind::Revolute => std::f64::consts::PI * noise.next(),
        JointKind::Prismatic => {
            let (low, high) = (robot.limits.lower[i], robot.limits.upper[i]);
            0.5 * (low + high) + 0.5 * (high - low) * noise.next()
        }
    };
    (0..robot.joint_count()).map(place).collect()
}

/// Bounds of velocity errors, links then motors, a third of them 0: over four decades, or of a link metric that hardens, which has no rate where
/// errors are fast, about those at which it loses half of its own.
fn speeds(scenario: &Scenario, noise: &mut Random) -> Vec<f64> {
    let gains = scenario.vcbc().unwrap();
    let n = scenario.robot.joint_count();
    let scale = |k: usize| match gains.link.hardens() {
        None => 1.0,
        Some(h) if k < n => 0.3 * gains.link.shaping[k] * (gains.link.metric[k] / h[k]).sqrt(),
        Some(_) => 0.3 * gains.motor.shaping[k - n],
    };
    let decades = if gains.link.hardens().is_some() { 1.0 } else { 2.0 };
    let speed = |k: usize| match noise.below(3) {
        0 => 0.0,
        _ => scale(k) * 10_f64.powf(decades * noise.next()),
    };
    (0..2 * n).map(speed).collect()
}

/// Robots by number, under a law with this φ and a link metric that hardens, or does not.
fn examine(
    numbers: impl Iterator<Item = u64>,
    (phi, hardens): (&str, bool),
    samples: usize,
    figures: &mut Figures,
) {
    for number in numbers {
        let (style, scenario) = robots::scenario_under(number, phi, hardens);
        let n = scenario.robot.joint_count();
        let mut noise = Random(7 + number);
        let error: Vec<f64> = (0..2 * n).map(|_| 10_f64.powf(0.4 * noise.next()) * 1.2).collect();
        let speed = speeds(&scenario, &mut noise);
        let question = Question {
            region: Region::Errors(error.clone()),
            velocity_error: Some(speed.clone()),
            ..Question::default()
        };
        let verdict = certify(&proposition(&scenario, &question, None).unwrap());
        let certificate = match verdict {
            Verdict::Proved(certificate) => certificate,
            // Where a metric hardens by much and errors are fast there need be no rate; else the constant metric has one.
            Verdict::Undecided(_) if hardens => {
                figures.undecided += 1;
                continue;
            }
            other => panic!("robot {number}, {style:?}: {other:?}"),
        };
        let claim = certificate.stretched.as_ref().unwrap();
        let of = Loop::of(&certificate);
        let exponents: Vec<_> = claim.exponent.iter().map(|b| b.as_ref().map(Number::approximate)).collect();
        let arm = scenario.robot.arm().unwrap();
        let mut slowest = f64::INFINITY;
        for k in 0..samples {
            // Half of the states in corners of the box, every other of those with errors that drift outwards.
            let sign = |noise: &mut Random| if noise.next() < 0.0 { -1.0 } else { 1.0 };
            let mut state = State {
                error: error
                    .iter()
                    .map(|e| e * if k % 2 == 0 { sign(&mut noise) } else { noise.next() })
                    .collect(),
                speed: speed
                    .iter()
                    .map(|s| s * if k % 2 == 0 { sign(&mut noise) } else { noise.next() })
                    .collect(),
            };
            if k % 4 == 0 {
                for i in 0..n {
                    state.error[i] = error[i] * state.speed[i].signum();
                    state.error[n + i] = -error[n + i] * state.speed[i].signum();
                    state.speed[n + i] = -speed[n + i] * state.speed[i].signum();
                }
            }
            let q = configuration(&scenario, &mut noise);
            let mut mass = vec![0.0; n * n];
            arm.mass_matrix(&q, &mut mass).unwrap();
            slowest = slowest.min(of.rate(&exponents, &state, &mass));
        }
        let rate = claim.rate.bounds().hi();
        assert!(
            rate <= slowest * (1.0 + ROUNDING),
            "robot {number}, {n} joints, {style:?}: {rate} certified, {slowest} sampled"
        );
        figures.shares.push(rate / slowest);
        let constant = certificate.contraction_rate.as_ref().map_or(f64::NAN, Number::approximate);
        figures.gains.push(rate / constant);
        figures.texts.push(certificate.text());
    }
}

/// φ, and whether the link metric hardens: the kinds of statements.
const KINDS: [(&str, bool); 3] = [("tanh", false), ("tanh", true), ("linear", true)];

#[test]
fn no_state_is_slower_than_is_certified() {
    for kind in KINDS {
        let mut figures = Figures::default();
        examine(0..100, kind, 60, &mut figures);
        figures.print();
        assert!(figures.undecided < 60, "{}", figures.undecided);
        let some: Vec<String> = figures.texts.iter().step_by(10).cloned().collect();
        assert!(python::codes(&some).is_none_or(|codes| codes.iter().all(|&code| code == 0)));
    }
}

/// 2,000 robots of a kind, each certificate by both checkers.
fn two_thousand(kind: (&str, bool)) {
    let mut figures = Figures::default();
    for hundred in 100..120 {
        figures.texts.clear();
        examine(100 * hundred..100 * (hundred + 1), kind, 200, &mut figures);
        let codes = python::codes(&figures.texts).expect("python3 with mpmath");
        assert!(codes.iter().all(|&code| code == 0), "{codes:?}");
    }
    println!("{kind:?}");
    figures.print();
}

/// `cargo test --release -p flexure --test suite stretched::random:: -- --ignored --nocapture`
#[test]
#[ignore = "minutes: 2,000 robots, each certificate by both checkers"]
fn two_thousand_robots_under_tanh() {
    two_thousand(KINDS[0]);
}

#[test]
#[ignore = "minutes: 2,000 robots, each certificate by both checkers"]
fn two_thousand_metrics_that_harden_under_tanh() {
    two_thousand(KINDS[1]);
}

#[test]
#[ignore = "minutes: 2,000 robots, each certificate by both checkers"]
fn two_thousand_metrics_that_harden_under_linear_shaping() {
    two_thousand(KINDS[2]);
}
