//! A contraction rate that was asked for, next to the largest one that is proved.

use flexure_core::scalar::Interval;

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{BlockName, Certificate};
use crate::prove::engine::momentum;
use crate::prove::engine::rate::Inequality;
use crate::prove::engine::structural::positions;
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::prove::engine::witness::{RateWitness, WitnessState, against};
use crate::prove::sampling::Sampled;

/// The verdict on a contraction rate of `rate`, from the largest one that was proved.
pub(super) fn at_rate(
    rate: f64,
    certificate: Certificate,
    sampled: &Sampled,
    damping: &[f64],
) -> Verdict<Certificate, RateWitness> {
    let Some(proved) = &certificate.contraction_rate else {
        let at =
            "with a metric that depends on the error no contraction rate holds at every speed".to_owned();
        return Verdict::Undecided(Undecided { at, spent: 1 });
    };
    if rate <= proved.bounds().lo() {
        return Verdict::Proved(certificate);
    }
    match slower(rate, &certificate, sampled, damping) {
        Some(witness) => Verdict::Refuted(witness),
        None => Verdict::Undecided(Undecided {
            at: format!(
                "{rate} 1/s is above the proved rate, {} 1/s, and no sample is slower",
                proved.approximate()
            ),
            spent: 1,
        }),
    }
}

/// A state at which some block contracts more slowly than `rate`.
fn slower(rate: f64, certificate: &Certificate, sampled: &Sampled, damping: &[f64]) -> Option<RateWitness> {
    let sides = positions(&certificate.controller, &certificate.region.error);
    let position = [BlockName::PhiL, BlockName::PhiM].into_iter().zip(&sides).find_map(|(block, side)| {
        side.cases().iter().find_map(|case| {
            let (direction, rate) = against(&side.inequality(&side.slopes(case)), rate)?;
            let far: Vec<bool> = case.iter().map(|high| !high).collect();
            let error = if far.is_empty() { vec![0.0; side.joints()] } else { side.error_at(&far) };
            Some(RateWitness { block, state: WitnessState::Error(error), direction, rate })
        })
    });
    let links = || {
        let damping: Vec<_> = damping.iter().map(|&d| Interval::point(d)).collect();
        let weight = sampled.mass_matrix.map(Interval::point);
        let (direction, rate) = against(&Inequality { form: Symmetric::diagonal(&damping), weight }, rate)?;
        let state = WitnessState::Configuration(sampled.configuration.clone());
        Some(RateWitness { block: BlockName::SigmaL, state, direction, rate })
    };
    let motors = || {
        let robot = &certificate.robot;
        let damping = momentum::damping(&robot.motor_damping, &certificate.controller.motor.damping);
        let (direction, rate) = against(&momentum::motors(robot, &damping), rate)?;
        Some(RateWitness { block: BlockName::SigmaM, state: WitnessState::Any, direction, rate })
    };
    position.or_else(links).or_else(motors)
}
