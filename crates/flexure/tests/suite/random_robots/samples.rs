//! The slowest rate that samples show of a certified loop, in plain floats.

use flexure::linalg::{Symmetric, weakest};
use flexure::prove::engine::Certificate;
use flexure::prove::engine::certificate::{BlockName, CertifiedPhi, DecimalGains, LoopSide};
use flexure::prove::engine::number::Number;
use flexure::scenario::Scenario;

use crate::common::Random;

fn floats(numbers: &[Number]) -> Vec<f64> {
    numbers.iter().map(Number::approximate).collect()
}

/// The certified contraction and convergence rates of a block, from above [1/s].
pub fn certified(certificate: &Certificate, name: BlockName) -> [f64; 2] {
    let block = certificate.blocks.iter().find(|block| block.block == name).unwrap();
    [&block.contraction, &block.convergence].map(|rate| rate.bounds().hi())
}

/// The rate of the links' momenta over `count` configurations, the slowest followed downhill [1/s].
pub fn links(scenario: &Scenario, certificate: &Certificate, noise: &mut Random, count: usize) -> f64 {
    let (robot, n) = (&scenario.robot, scenario.robot.joint_count());
    let arm = robot.arm().unwrap();
    let own = floats(&certificate.robot.link_damping);
    let damping: Vec<f64> =
        own.iter().zip(floats(&certificate.controller.link.damping)).map(|(d, k)| d + k).collect();
    let rate = |q: &[f64]| {
        let mut mass = vec![0.0; n * n];
        arm.mass_matrix(q, &mut mass).unwrap();
        // The largest eigenvalue of D^-1/2 M D^-1/2 is the least of its negative.
        let scaled = Symmetric::from_fn(n, |i, j| -mass[i * n + j] / (damping[i] * damping[j]).sqrt());
        weakest(&scaled, &Symmetric::diagonal(&vec![1.0; n])).map_or(f64::INFINITY, |(least, _)| -1.0 / least)
    };
    let range = |i: usize| match robot.joints[i].kind {
        flexure::robot::JointKind::Revolute => (-std::f64::consts::PI, std::f64::consts::PI),
        flexure::robot::JointKind::Prismatic => (robot.limits.lower[i], robot.limits.upper[i]),
    };
    let anywhere = |noise: &mut Random| -> Vec<f64> {
        // A sixth of the sliding joints at each end, where inertias are largest.
        let place =
            |(low, high): (f64, f64), x: f64| (0.5 * (low + high) + 0.75 * (high - low) * x).clamp(low, high);
        (0..n).map(|i| place(range(i), noise.next())).collect()
    };
    let stretched: Vec<f64> = (0..n).map(|i| if range(i).1 > 3.0 { 0.0 } else { range(i).1 }).collect();
    let mut places: Vec<(f64, Vec<f64>)> =
        (0..count).map(|_| anywhere(noise)).chain([stretched]).map(|q| (rate(&q), q)).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.into_iter().take(STARTS).map(|place| descend(place, &rate, &range)).fold(f64::INFINITY, f64::min)
}

/// How many of the slowest configurations are followed downhill.
const STARTS: usize = 3;

/// Follows a configuration with its rate downhill, joint by joint: all the way round, and close by.
fn descend(
    (mut least, mut q): (f64, Vec<f64>),
    rate: &dyn Fn(&[f64]) -> f64,
    range: &dyn Fn(usize) -> (f64, f64),
) -> f64 {
    for _ in 0..12 {
        let before = least;
        for i in 0..q.len() {
            let (low, high) = range(i);
            let far = (1..12).map(|k| f64::from(k) / 12.0);
            let close = (2..9).flat_map(|k| [0.3_f64.powi(k), -(0.3_f64.powi(k))]);
            let here = q[i];
            for step in far.chain(close) {
                // Joints that turn come round; those that slide stay within their travel.
                let there = here + step * (high - low);
                let there = if there > high { there - (high - low) } else { there.max(low) };
                let mut beside = q.clone();
                beside[i] = there;
                let found = rate(&beside);
                if found < least {
                    (least, q) = (found, beside);
                }
            }
        }
        if least > before * (1.0 - 1e-9) {
            break;
        }
    }
    least
}

/// The slowest d/M_m [1/s].
pub fn motors(certificate: &Certificate) -> f64 {
    let robot = &certificate.robot;
    let damping = floats(&robot.motor_damping).into_iter().zip(floats(&certificate.controller.motor.damping));
    damping.zip(floats(&robot.motor_inertia)).map(|((d, k), m)| (d + k) / m).fold(f64::INFINITY, f64::min)
}

/// The slowest contraction and convergence rate of a position block over corners of the region and errors inside [1/s].
pub fn positions(certificate: &Certificate, side: LoopSide, noise: &mut Random, count: usize) -> [f64; 2] {
    let controller = &certificate.controller;
    let (gains, first) = match side {
        LoopSide::Link => (&controller.link, 0),
        LoopSide::Motor => (&controller.motor, certificate.robot.joints),
    };
    let bounds = &certificate.region.error[first..first + certificate.robot.joints];
    let mut least = [f64::INFINITY; 2];
    for k in 0..count {
        let error: Vec<f64> = bounds
            .iter()
            .map(|bound| match bound {
                Some(bound) if k % 2 == 0 => bound.approximate() * [0.0, 1.0][noise.below(2)],
                Some(bound) => bound.approximate() * noise.next(),
                None => 10.0 * noise.next(),
            })
            .collect();
        let slopes: Vec<f64> = error.iter().map(|e| e.cosh().powi(-2)).collect();
        let chords: Vec<f64> = error.iter().map(|e| if *e == 0.0 { 1.0 } else { e.tanh() / e }).collect();
        for (least, a) in least.iter_mut().zip([slopes, chords]) {
            *least = least.min(rate(controller.phi, gains, &a));
        }
    }
    least
}

/// The least eigenvalue of sym(Π ∂φ) relative to Π where tanh has the slopes, or chords, `a`.
fn rate(phi: CertifiedPhi, gains: &DecimalGains, a: &[f64]) -> f64 {
    let (metric, shaping) = (floats(&gains.metric), floats(&gains.shaping));
    let (n, kappa) = (a.len(), gains.kappa.as_ref().map(|kappa| floats(kappa)).unwrap_or_default());
    let slope = |i: usize, j: usize| match phi {
        CertifiedPhi::CoupledTanh if i == j => 1.0 + kappa[i],
        CertifiedPhi::CoupledTanh => (shaping[j] / shaping[i]).sqrt() * a[j] / (n - 1) as f64,
        _ if i != j => 0.0,
        CertifiedPhi::Tanh => shaping[i] * a[i],
        CertifiedPhi::Linear => shaping[i],
    };
    // In coordinates in which Π is 1.
    let form = Symmetric::from_fn(n, |i, j| {
        0.5 * ((metric[i] / metric[j]).sqrt() * slope(i, j) + (metric[j] / metric[i]).sqrt() * slope(j, i))
    });
    weakest(&form, &Symmetric::diagonal(&vec![1.0; n])).map_or(f64::NEG_INFINITY, |(least, _)| least)
}
