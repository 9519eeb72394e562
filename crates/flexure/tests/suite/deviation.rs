//! From what differences of the numbers do to W to a rate and a level: against closed forms, and instant by instant.

use flexure::core::scalar::Interval;
use flexure::prove::engine::envelope::deviation::{Bound, Deviation};

use crate::along::slabs::enclosed;
use crate::within::{IDENTIFIED, proof, scenario, spread, tolerant};

/// Without slopes A = β, and ν = |η| / β at λ = β/2; a slope from one block to another leaves μ = β − γ/2, one on its own block β − γ.
#[test]
fn rates_and_lengths_of_small_matrices() {
    let bound = |slopes: [[f64; 4]; 4], steady: [f64; 4]| {
        let deviation = Deviation { time: Interval::point(0.0), steady, slopes };
        deviation.bound(&[Interval::point(5.0); 4])
    };
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-5;
    let mut slopes = [[0.0; 4]; 4];
    let Bound { rate, length } = bound(slopes, [0.0, 0.3, 0.0, 0.4]).expect("a bound");
    assert!(near(rate, 5.0) && near(length, 0.1) && rate <= 5.0 && length >= 0.1, "{rate} {length}");
    slopes[0][2] = 4.0;
    assert!(bound(slopes, [0.1; 4]).is_some_and(|bound| near(bound.rate, 3.0)));
    slopes = [[0.0; 4]; 4];
    slopes[1][1] = 4.0;
    assert!(bound(slopes, [0.1; 4]).is_some_and(|bound| near(bound.rate, 1.0)));
    slopes[1][1] = 5.0;
    assert!(bound(slopes, [0.0; 4]).is_none());
}

/// What is said of the whole run is the worst of its instants: no instant is worse, and the worst is not much better.
#[test]
fn the_whole_is_the_worst_of_its_instants() {
    let scenario = tolerant(scenario(), IDENTIFIED);
    let system = enclosed(&scenario);
    let proof = proof(&scenario);
    let Some(Ok(within)) = &proof.within else { panic!("{:?}", proof.within) };
    let certificate = proof.verdict.proved().expect("proved");
    // They come in the order of the errors.
    let rates: Vec<_> =
        certificate.blocks.iter().map(|block| Interval::point(block.convergence.bounds().lo())).collect();
    let spread = spread(&scenario.robot.tolerances, [[0.0; 2]; 2]);
    let at = |k: u32| {
        let time = Interval::point(scenario.duration * f64::from(k) / 128.0);
        let deviation =
            Deviation::watched(&system, &spread, within.level, time, &|| true).expect("an instant");
        deviation.bound(&rates.clone().try_into().expect("four blocks")).expect("a bound")
    };
    let bounds: Vec<Bound> = (0..=128).map(at).collect();
    let slowest = bounds.iter().map(|bound| bound.rate).fold(f64::INFINITY, f64::min);
    let longest = bounds.iter().map(|bound| bound.length).fold(0.0, f64::max);
    let said = (2.0 * within.settles).sqrt();
    println!("{slowest} 1/s and {longest} √J at the worst instants: {within:?}");
    assert!(within.rate <= slowest && within.rate > 0.94 * slowest, "{slowest}: {within:?}");
    assert!(longest <= said && longest > 0.9 * said, "{longest}: {within:?}");
}
