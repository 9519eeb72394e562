//! Contraction rates in a metric that grows where tanh is flat: what is certified, that no sample is slower, and that nothing more holds.

mod full;
mod hardening;
mod mutants;
mod random;

use flexure::Scenario;
use flexure::prove::engine::Certificate;
use flexure::prove::engine::number::Number;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, Region};
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
    let verdict = certify(&proposition(scenario, &question, None).unwrap());
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

/// The slowest rate of the paper's arm where drifts are largest, and errors are so or 0: both ends of what P is.
fn slowest(of: &Loop, exponents: &[Option<f64>], error: f64, speed: f64) -> f64 {
    let mut least = f64::INFINITY;
    for word in 0..16_u8 {
        let end = |k: u8| if word >> k & 1 == 0 { error } else { 0.0 };
        // Links drift outwards with s_l, and motors with −K/Π_m s_l: so their errors are of the other sign.
        let state = State {
            error: vec![end(0), end(1), -end(2), -end(3)],
            speed: vec![speed, speed, -speed, -speed],
        };
        least = [-1.0, 1.0]
            .map(|cosine| of.rate(exponents, &state, &mass(cosine)))
            .into_iter()
            .fold(least, f64::min);
    }
    least
}

/// 0.296 1/s in the constant metric. Of what a grid of exponents shows at most, nearly all is certified, and 1.1 times as much is true of none.
#[test]
fn the_paper_s_arm_contracts_sixty_times_faster() {
    let scenario = Scenario::load("two-link-tanh-smooth").unwrap();
    for (speed, wanted) in [(0.0, 24.0), (1.0, 23.0), (5.0, 19.0), (10.0, 14.0)] {
        let certificate = certified(&scenario, 3.0, speed);
        let [rate, constant] = rates(&certificate);
        println!("|s| <= {speed} rad/s: {rate} 1/s, {constant} 1/s in the constant metric");
        assert!(rate >= wanted && (constant - 0.295_981).abs() < 1e-6, "{rate} {constant}");
        verify(&certificate.text()).unwrap();

        let of = Loop::of(&certificate);
        let claim = certificate.stretched.as_ref().unwrap();
        let own: Vec<_> = claim.exponent.iter().map(|b| b.as_ref().map(Number::approximate)).collect();
        let sampled = slowest(&of, &own, 3.0, speed);
        assert!(rate <= sampled && rate > 0.95 * sampled, "{rate} certified, {sampled} sampled");

        let values = [0.3, 0.45, 0.5, 0.55, 0.6, 0.65, 0.75, 0.85, 0.95].map(Some);
        let (mut best, count) = (0.0_f64, values.len());
        for word in 0..count.pow(4) {
            let exponents: Vec<_> = (0..4).map(|k| values[word / count.pow(k) % count]).collect();
            best = best.max(slowest(&of, &exponents, 3.0, speed));
        }
        println!("with its exponents: {sampled} 1/s sampled; best of the grid: {best} 1/s sampled");
        assert!(rate > 0.95 * best && rate < 1.1 * best, "{rate} certified, {best} of the grid");
        let mut bold = certificate.clone();
        for exponent in [None, Some("0.3"), Some("0.5"), Some("0.6"), Some("0.7"), Some("0.9")] {
            let claim = bold.stretched.as_mut().unwrap();
            claim.rate = Number::decimal(1.1 * best);
            if let Some(b) = exponent {
                claim.exponent = vec![Some(Number::Decimal(b.to_owned())); 4];
            }
            assert!(verify(&bold.text()).is_err(), "{exponent:?}");
        }
    }
}

/// Of seven joints, by the bound of the mass matrix that its chain gives. Up to 1.5 rad the momenta of the links are what is slow, which no
/// stretch of positions makes faster.
#[test]
fn seven_joints() {
    let scenario = Scenario::load("panda-tanh-smooth").unwrap();
    for (error, speed, wanted) in [(1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (2.0, 1.0, 1.6), (3.0, 1.0, 3.8)] {
        let started = std::time::Instant::now();
        let certificate = certified(&scenario, error, speed);
        let [rate, constant] = rates(&certificate);
        println!(
            "|e| <= {error} rad, |s| <= {speed} rad/s: {rate} 1/s, {constant} 1/s in the constant metric, {:?}",
            started.elapsed()
        );
        assert!(rate >= wanted * constant * (1.0 - 1e-6));
        verify(&certificate.text()).unwrap();
    }
}

/// No metric at all makes the seven-joint arm contract ten times as fast as the constant one on |q̃| ≤ 1: standing on its reference, where the
/// loop is linear, its slowest mode is slower.
#[test]
fn ten_times_the_rate_of_the_constant_metric_is_impossible_for_seven_joints() {
    let scenario = Scenario::load("panda-tanh-smooth").unwrap();
    let certificate = certified(&scenario, 1.0, 0.0);
    let [_, constant] = rates(&certificate);
    let arm = scenario.robot.arm().unwrap();
    let mut mass = vec![0.0; 49];
    arm.mass_matrix(&scenario.initial.q_l, &mut mass).unwrap();
    let abscissa = Loop::of(&certificate).abscissa(&mass);
    println!("spectral abscissa {abscissa} 1/s, constant metric {constant} 1/s");
    assert!(-abscissa < 10.0 * constant);
}
