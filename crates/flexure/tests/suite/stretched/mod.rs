//! Contraction rates in a metric that grows where tanh is flat: what is certified, that no sample is slower, and that nothing more holds.

mod full;
mod hardening;
mod mutants;
mod random;

use flexure::Scenario;
use flexure::prove::engine::Certificate;
use flexure::prove::engine::number::Number;
use flexure::prove::question::{Question, Region, problem};
use flexure::prove::verified::certify;
use flexure::verify::verify;

use full::{Loop, State};

/// What is certified of a scenario for errors of up to `error` rad and velocity errors of up to `speed` rad/s.
pub fn certified(scenario: &Scenario, error: f64, speed: f64) -> Certificate {
    let both = 2 * scenario.robot.joint_count();
    let question = Question {
        region: Region::Errors(vec![error; both]),
        velocity_error: Some(vec![speed; both]),
        ..Question::default()
    };
    let verdict = certify(&problem(scenario, &question, None).unwrap());
    verdict.proved().unwrap_or_else(|| panic!("{}: {verdict:?}", scenario.name)).clone()
}

/// The rate in the stretched metric, and the one in the constant metric [1/s].
fn rates(certificate: &Certificate) -> [f64; 2] {
    let stretched = certificate.stretched.as_ref().unwrap();
    [stretched.rate.approximate(), certificate.contraction_rate.as_ref().map_or(0.0, Number::approximate)]
}

/// The mass matrix of the paper's arm at a cosine of its elbow.
fn mass(cosine: f64) -> [f64; 4] {
    let (a1, a2, b) = (0.180_081_887, 0.010_720_825, 0.016_469_145);
    let side = a2 + b * cosine;
    [a1 + a2 + 2.0 * b * cosine, side, side, a2]
}

/// The slowest rate of the paper's arm where errors and drifts are largest.
fn slowest(of: &Loop, exponents: &[Option<f64>], error: f64, speed: f64) -> f64 {
    // Links drift outwards with s_l, and motors with −K/Π_m s_l: so their errors are of the other sign.
    let state =
        State { error: vec![error, error, -error, -error], speed: vec![speed, speed, -speed, -speed] };
    [-1.0, 1.0]
        .map(|cosine| of.rate(exponents, &state, &mass(cosine)))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

/// 0.296 1/s in the constant metric; the largest rate that a grid of exponents shows is certified, and 1.1 times as much is not true.
#[test]
fn the_paper_s_arm_contracts_forty_times_faster() {
    let scenario = Scenario::load("two-link-tanh-smooth").unwrap();
    for (speed, wanted) in [(0.0, 12.5), (5.0, 10.0)] {
        let certificate = certified(&scenario, 3.0, speed);
        let [rate, constant] = rates(&certificate);
        println!("|s| <= {speed} rad/s: {rate} 1/s, {constant} 1/s in the constant metric");
        assert!(rate >= wanted && (constant - 0.295_981).abs() < 1e-6, "{rate} {constant}");
        verify(&certificate.text()).unwrap();

        let of = Loop::of(&certificate);
        let claim = certificate.stretched.as_ref().unwrap();
        let own: Vec<_> = claim.exponent.iter().map(|b| b.as_ref().map(Number::approximate)).collect();
        let sampled = slowest(&of, &own, 3.0, speed);
        assert!((rate / sampled - 1.0).abs() < 1e-6, "{rate} certified, {sampled} sampled");

        let values = [0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8].map(Some);
        let mut best = 0.0_f64;
        for word in 0..10_usize.pow(4) {
            let exponents: Vec<_> = (0..4).map(|k| values[word / 10_usize.pow(k) % 10]).collect();
            best = best.max(slowest(&of, &exponents, 3.0, speed));
        }
        println!("best of the grid: {best} 1/s");
        assert!(rate > 0.99 * best && rate < 1.1 * best, "{rate} certified, {best} of the grid");
        let mut bold = certificate.clone();
        for exponent in [None, Some("0.25"), Some("0.3"), Some("0.5"), Some("0.6")] {
            let claim = bold.stretched.as_mut().unwrap();
            claim.rate = Number::decimal(1.1 * best);
            if let Some(b) = exponent {
                claim.exponent = vec![Some(Number::Decimal(b.to_owned())); 4];
            }
            assert!(verify(&bold.text()).is_err(), "{exponent:?}");
        }
    }
}

/// Of seven joints, by the bound of the mass matrix that its chain gives.
#[test]
fn seven_joints() {
    let scenario = Scenario::load("panda-tanh-smooth").unwrap();
    for (error, speed) in [(1.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 0.0)] {
        let started = std::time::Instant::now();
        let certificate = certified(&scenario, error, speed);
        let [rate, constant] = rates(&certificate);
        println!(
            "|e| <= {error} rad, |s| <= {speed} rad/s: {rate} 1/s, {constant} 1/s in the constant metric, {:?}",
            started.elapsed()
        );
        assert!(rate > constant);
        verify(&certificate.text()).unwrap();
    }
}
