//! The least gains of v-CBC that prove a rate, in closed form.
//!
//! In the metric W the rate is the least of four: of the shaping functions, Λ for φ linear; of the momenta, the largest β with
//! D + K_d ⪰ β M. Each asks for one gain alone: Λ = β, K_md = β M_m − D_m, and diag(K_ld) = β diag(s) − D_l with a diagonal s that
//! lies above the mass matrix in every posture.

use crate::files::Problems;
use crate::laws::{Controller, Phi, SideGains, VcbcGains};
use crate::progress::unwatched;
use crate::prove::question::{Question, prove};
use crate::prove::sampling::{largest_diagonal, sample};
use crate::prove::summary::BlockSummary;
use crate::robot::Robot;
use crate::scenario::Scenario;

/// What the least gains follow from.
#[derive(Clone, Debug)]
pub(super) struct Least {
    /// s with diag(s) ⪰ M(q) in every posture that was sampled [kg m²].
    inertia: Vec<f64>,
    link_damping: Vec<f64>,
    motor_inertia: Vec<f64>,
    motor_damping: Vec<f64>,
    /// Gains Λ and κ over the rate of φ, links and motors: 1 for φ linear, else as much as proves it after rounding.
    shaping: [f64; 2],
}

/// What s is larger than its samples by: proofs reach 99.98 % of sampled rates, and round outwards.
const RESERVE: f64 = 1.002;

/// What Λ and κ are larger by for φ other than linear, whose proved rates are rounded down.
const OUTWARDS: f64 = 1.0 + 1e-6;

/// Part of β M that is injected where the robot's own damping is enough: the law wants K_d > 0.
const SOME: f64 = 1e-3;

impl Least {
    /// For the v-CBC law of `scenario`; none for other laws, and where no rate is `asked`.
    ///
    /// # Errors
    /// As [`prove`].
    pub fn of(scenario: &Scenario) -> Result<Option<Self>, Problems> {
        let Controller::Vcbc(gains) = &scenario.controller else { return Ok(None) };
        let Robot { link_damping, motor_inertia, motor_damping, .. } = &scenario.robot;
        Ok(Some(Self {
            inertia: above_the_mass_matrix(&scenario.robot)?,
            link_damping: link_damping.clone(),
            motor_inertia: motor_inertia.clone(),
            motor_damping: motor_damping.clone(),
            shaping: if gains.phi == Phi::Linear { [1.0; 2] } else { shaping(scenario, gains)? },
        }))
    }

    /// `gains`, raised where a rate of `rate` 1/s asks for more.
    pub fn raised(&self, gains: &VcbcGains, rate: f64) -> VcbcGains {
        self.with(gains, rate, f64::max)
    }

    /// `gains` with the metrics as they are and the others as small as `rate` 1/s allows.
    pub fn exactly(&self, gains: &VcbcGains, rate: f64) -> VcbcGains {
        self.with(gains, rate, |_, least| least)
    }

    fn with(&self, gains: &VcbcGains, rate: f64, choose: impl Fn(f64, f64) -> f64) -> VcbcGains {
        let side = |side: &SideGains, shaping: f64, inertia: &[f64], damping: &[f64]| {
            let mut side = side.clone();
            let position = side.shaping.iter_mut().chain(side.extra.iter_mut().flat_map(|(_, extra)| extra));
            position.for_each(|gain| *gain = choose(*gain, shaping * rate));
            for ((gain, inertia), own) in side.damping.iter_mut().zip(inertia).zip(damping) {
                *gain = choose(*gain, (rate * inertia - own).max(SOME * rate * inertia));
            }
            side
        };
        let motors: Vec<f64> = self.motor_inertia.iter().map(|inertia| RESERVE * inertia).collect();
        let [links, motor_shaping] = self.shaping;
        VcbcGains {
            phi: gains.phi,
            link: side(&gains.link, links, &self.inertia, &self.link_damping),
            motor: side(&gains.motor, motor_shaping, &motors, &self.motor_damping),
        }
    }
}

/// s: the largest diagonal entries of the mass matrix, times the one number that makes them lie above all of it.
fn above_the_mass_matrix(robot: &Robot) -> Result<Vec<f64>, Problems> {
    let diagonal = largest_diagonal(robot)?;
    let rate = sample(robot, &diagonal, &unwatched)?.rate;
    Ok(diagonal.iter().map(|inertia| RESERVE * inertia / rate).collect())
}

/// The smallest gain of φ over its proved rate, links and motors: both grow in the same proportion.
fn shaping(scenario: &Scenario, gains: &VcbcGains) -> Result<[f64; 2], Problems> {
    let proof = prove(scenario, &Question::default())?;
    let Some(certificate) = proof.verdict.proved() else { return Ok([f64::INFINITY; 2]) };
    let smallest = |side: &SideGains| side.shaping.iter().copied().fold(f64::INFINITY, f64::min);
    let rates = BlockSummary::contraction(certificate);
    Ok([smallest(&gains.link) / rates.phi_l, smallest(&gains.motor) / rates.phi_m]
        .map(|part| OUTWARDS * part))
}
