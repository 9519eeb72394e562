//! Robots and gains at random: both checkers accept whatever is certified, no sample is slower than what is certified, and what
//! can be certified is.

pub mod robots;
mod samples;

use std::time::Instant;

use flexure::prove::engine::certificate::{BlockName, CertifiedPhi, LoopSide};
use flexure::prove::engine::verdict::Verdict;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, Region};
use flexure::prove::verified::certify;
use flexure::verify::verify;

use crate::common::Random;
use crate::verify::python;

/// What certificates of many robots come to.
#[derive(Default)]
struct Figures {
    proved: usize,
    refuted: usize,
    undecided: usize,
    /// Certified rate of the links' momenta over the slowest sample.
    shares: Vec<f64>,
    /// Seconds of the prover.
    times: Vec<f64>,
    texts: Vec<String>,
}

impl Figures {
    fn add(&mut self, other: Self) {
        self.proved += other.proved;
        self.refuted += other.refuted;
        self.undecided += other.undecided;
        self.shares.extend(other.shares);
        self.times.extend(other.times);
    }

    fn print(&mut self) {
        let Self { proved, refuted, undecided, shares, times, .. } = self;
        shares.sort_by(f64::total_cmp);
        times.sort_by(f64::total_cmp);
        let last = shares.len() - 1;
        println!("{proved} proved, {refuted} refuted, {undecided} undecided");
        println!(
            "certified over sampled: least {:.4}, 5 % {:.4}, median {:.6}, largest {:.9}",
            shares[0],
            shares[last / 20],
            shares[last / 2],
            shares[last]
        );
        println!("prover and checker: median {:.3} s, longest {:.3} s", times[last / 2], times[last]);
    }
}

/// Rates are compared with samples in floats, whose eigenvalues have rounding of their own.
const ROUNDING: f64 = 1e-9;

/// Certifies robots by number, each looked at in `samples` configurations.
fn examine(numbers: impl Iterator<Item = u64>, samples: usize) -> Figures {
    let mut figures = Figures::default();
    for number in numbers {
        let (style, scenario) = robots::scenario(number);
        let n = scenario.robot.joint_count();
        let question = Question {
            region: Region::Errors(vec![0.5; 2 * n]),
            disturbance: Some(vec![1e-9; n]),
            ..Question::default()
        };
        let problem = proposition(&scenario, &question, None).unwrap();
        let started = Instant::now();
        let verdict = certify(&problem);
        let seconds = started.elapsed().as_secs_f64();
        let what = format!("robot {number}, {n} joints, {style:?}, {:?}", problem.controller.phi);
        let certificate = match verdict {
            Verdict::Proved(certificate) => certificate,
            Verdict::Refuted(witness) => {
                // Slopes that couple joints can be too strong for a metric; others never are.
                assert_eq!(problem.controller.phi, CertifiedPhi::CoupledTanh, "{what}: {witness:?}");
                figures.refuted += 1;
                continue;
            }
            Verdict::Undecided(undecided) => {
                println!("{what}: {undecided:?}");
                figures.undecided += 1;
                continue;
            }
        };
        figures.proved += 1;
        figures.times.push(seconds);
        let text = certificate.text();
        verify(&text).unwrap_or_else(|rejected| panic!("{what}: {rejected}"));
        figures.texts.push(text);
        let mut noise = Random(number);
        let slowest = samples::links(&scenario, &certificate, &mut noise, samples);
        let [rate, _] = samples::certified(&certificate, BlockName::SigmaL);
        assert!(rate <= slowest * (1.0 + ROUNDING), "{what}: {rate} certified, {slowest} sampled");
        figures.shares.push(rate / slowest);
        if rate < 0.9 * slowest {
            println!("{what}: {rate} of {slowest}");
        }
        let [rate, _] = samples::certified(&certificate, BlockName::SigmaM);
        assert!(rate <= samples::motors(&certificate) * (1.0 + ROUNDING), "{what}");
        for (block, side) in [(BlockName::PhiL, LoopSide::Link), (BlockName::PhiM, LoopSide::Motor)] {
            let sampled = samples::positions(&certificate, side, &mut noise, 40);
            for (rate, sampled) in samples::certified(&certificate, block).into_iter().zip(sampled) {
                assert!(rate <= sampled * (1.0 + ROUNDING), "{what}: {rate} certified, {sampled} sampled");
            }
        }
    }
    figures
}

/// The second checker needs a fifth of a second for each: in a test it looks at every fifth.
const SECOND_CHECKER: usize = 5;

#[test]
fn what_is_certified_is_verified_and_no_sample_is_slower() {
    let mut figures = examine(0..200, 60);
    figures.print();
    let some: Vec<String> = figures.texts.iter().step_by(SECOND_CHECKER).cloned().collect();
    assert!(python::codes(&some).is_none_or(|codes| codes.iter().all(|&code| code == 0)));
    assert_eq!(figures.undecided, 0);
    assert!(figures.shares[0] > 0.95, "{}", figures.shares[0]);
}

/// Robots whose programmes need more than a hundred steps to a point of the central path, or are followed to where rounding
/// hides what another step would lower.
#[test]
fn long_paths_are_followed_to_their_ends() {
    let figures = examine([10042, 10189, 10284].into_iter(), 60);
    assert_eq!(figures.proved, 3);
    assert!(figures.shares.iter().all(|&share| share > 0.99), "{:?}", figures.shares);
}

/// `cargo test --release -p flexure --test suite two_thousand -- --ignored --nocapture`
#[test]
#[ignore = "half an hour: 2,000 robots, each certificate by both checkers"]
fn two_thousand_robots() {
    let mut figures = Figures::default();
    let mut accepted = 0;
    for hundred in 100..120 {
        let next = examine(100 * hundred..100 * (hundred + 1), 300);
        let codes = python::codes(&next.texts).expect("python3 with mpmath");
        assert!(codes.iter().all(|&code| code == 0), "{codes:?}");
        accepted += codes.len();
        figures.add(next);
        figures.print();
        println!("{accepted} accepted by both checkers");
    }
    assert_eq!(figures.undecided, 0);
}
