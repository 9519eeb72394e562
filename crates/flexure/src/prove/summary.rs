//! A proof at a glance: the contract of `certify --json`.

use serde::Serialize;

use crate::prove::along::Along;
use crate::prove::confirmation::Confirmation;
use crate::prove::engine::certificate::{
    Block, BlockName, Certificate, LoopSide, Norm, StructureClaim, StructureName,
};
use crate::prove::engine::number::Number;
use crate::prove::engine::verdict::Verdict;
use crate::prove::engine::witness::WitnessState;
use crate::prove::question::{Proof, inside};
use crate::prove::robust::{NoFunnel, Robust};
use crate::prove::sampled_data::{NoTube, SampledTube, suitable_when_sampled};
use crate::prove::sampling;
use crate::prove::standing::{Standing, Step};
use crate::prove::within::{Closer, Open, Within};
use crate::robot::JointKind;
use crate::sampled::Sampled;
use crate::scenario::Scenario;
use crate::units::{Unit, of_joints};

/// What was proved, as numbers.
#[derive(Clone, Debug, Serialize)]
pub struct ProofSummary {
    /// Name of the scenario.
    pub name: String,
    /// Which joints turn, which slide.
    #[serde(skip)]
    pub kinds: Vec<JointKind>,
    /// On everything that was asked, as [`Standing::words`] has it. Rates stand where they were proved of the law in continuous
    /// time.
    pub verdict: &'static str,
    /// The highest step of the ladder of docs/proofs.md that is proved; none where nothing is, or the loop is unstable as sampled.
    pub step: Option<Step>,
    /// Whether a higher one was not looked for, and may be there.
    #[serde(skip)]
    pub may_be_higher: bool,
    /// What the loop in the file has that the proof leaves out: options of the plant, imperfections, estimators, guard.
    pub left_out: Vec<&'static str>,
    /// Whether the loop is stable that holds its torque for a control period; none for laws in continuous time.
    pub sampled: Option<Sampled>,
    /// Proved contraction rate [1/s].
    pub contraction_rate: Option<f64>,
    /// Proved convergence rate [1/s].
    pub convergence_rate: Option<f64>,
    /// The rate by the paper's formula [1/s].
    pub paper_rate: f64,
    /// Contraction rate of each block [1/s].
    pub blocks: Option<BlockSummary>,
    /// Convergence rate of each block [1/s].
    pub convergence_blocks: Option<BlockSummary>,
    /// Errors for which it holds; none if nothing was proved.
    pub region: Option<RegionSummary>,
    /// Upper bounds of the matrix measures of −Θ ∂φ Θ⁻¹ [1/s].
    pub measures: Vec<MeasureSummary>,
    /// Port-Hamiltonian structures, and whether the closed loop keeps them.
    pub structure: Vec<StructureSummary>,
    /// True where the mass matrix was proved to be positive definite at every configuration.
    pub mass_matrix_positive_definite: Option<bool>,
    /// The links' momentum block, sampled over all configurations.
    pub sigma_l_sampled: sampling::Sampled,
    /// Proved rate of the links' momentum block over the sampled one.
    pub tightness: Option<f64>,
    /// Where the scenario starts; none where W is not defined or jumps.
    pub start: Option<StartSummary>,
    /// What holds of every robot within the tolerances of the robot file; none if it has none.
    pub within: Option<WithinSummary>,
    /// How far the motion can be from its reference, by a funnel; none without disturbances or tolerances.
    pub funnel: Option<FunnelSummary>,
    /// How fast motions of the sampled loop come closer near its run; none if that was not asked for.
    pub sampled_tube: Option<SampledTubeSummary>,
    /// Bounds along the reference inside the tube of W; none without a disturbance or tolerances, or where there is a funnel.
    pub along: Option<Along>,
    /// What the direct engine says of the contraction rate; none if it was not asked.
    pub direct: Option<DirectSummary>,
    /// Error tube under a disturbance.
    pub tube: Option<TubeSummary>,
    /// A contraction rate in a metric that grows with the error; none if it was not asked for.
    pub stretched: Option<StretchedSummary>,
    /// A state at which what was asked fails, if it was refuted.
    pub witness: Option<WitnessSummary>,
    /// Why nothing was decided, if so.
    pub undecided: Option<UndecidedSummary>,
    /// Options that were not given, and numbers that no source vouches for.
    pub assumptions: Vec<String>,
    /// Wall-clock time of the proof in s.
    pub wall_seconds: f64,
}

/// A rate of each block [1/s].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockSummary {
    /// Rate of the link positions [1/s].
    pub phi_l: f64,
    /// Rate of the motor positions [1/s].
    pub phi_m: f64,
    /// Rate of the link momenta [1/s].
    pub sigma_l: f64,
    /// Rate of the motor momenta [1/s].
    pub sigma_m: f64,
}

/// Errors for which a proof holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionSummary {
    /// Largest |q̃_i| in rad, links then motors; none for every error.
    pub error: Option<Vec<f64>>,
    /// The level of W inside, in J.
    pub level: Option<f64>,
    /// What |q̃_i| ≤ for W up to that level, in rad.
    pub error_at_level: Option<Vec<f64>>,
}

/// A matrix measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasureSummary {
    /// Links or motors.
    pub side: LoopSide,
    /// Norm that the measure belongs to.
    pub norm: Norm,
    /// Upper bound of the measure [1/s].
    pub bound: f64,
}

/// A structural claim.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StructureSummary {
    /// The structure.
    pub name: StructureName,
    /// Whether the closed loop keeps it.
    pub holds: bool,
}

/// W at the scenario's start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StartSummary {
    /// An upper bound in J.
    pub level: f64,
    /// Whether the start lies in the invariant set.
    pub inside: bool,
}

/// What the direct engine says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DirectSummary {
    /// `proved`, `refuted` or `undecided`.
    pub verdict: &'static str,
    /// The rate that it proved [1/s].
    pub rate: Option<f64>,
    /// Boxes looked at; none if it found a state that speaks against it.
    pub boxes: Option<usize>,
    /// The state or box that it could not decide, in words.
    pub at: Option<String>,
}

/// What holds of every robot within the tolerances: along the reference, from every start with W ≤ level, until its end,
/// √W(t) ≤ √settles + e^(−rate t) max(√W(0) − √settles, 0).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WithinSummary {
    /// `proved` or `undecided`.
    pub verdict: &'static str,
    /// Rate at which √W decays to what it settles at [1/s].
    pub rate: Option<f64>,
    /// Level of W in J that the run never leaves.
    pub level: Option<f64>,
    /// Level of W in J that it comes to.
    pub settles: Option<f64>,
    /// Bounds of |q̃_i| in rad there, links then motors.
    pub error: Option<Vec<f64>>,
    /// Why nothing was shown.
    pub at: Option<String>,
    /// Smaller tolerances of which something was shown, where nothing was of those of the file.
    pub closer: Option<Closer>,
}

/// A funnel along the reference, or why there is none.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "verdict", rename_all = "lowercase")]
pub enum FunnelSummary {
    /// Errors stay in it.
    Proved(Box<Robust>),
    /// None was found.
    Undecided(NoFunnel),
}

/// A tube of the sampled loop, or why there is none.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "verdict", rename_all = "lowercase")]
pub enum SampledTubeSummary {
    /// Motions in it come closer.
    Proved(Box<SampledTube>),
    /// None was found.
    Undecided(NoTube),
}

/// An error tube.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TubeSummary {
    /// Largest disturbance torques of the motors [N m].
    pub disturbance: Vec<f64>,
    /// Level of W in J.
    pub level: f64,
    /// Bounds of |q̃_i| in rad, links then motors.
    pub error: Vec<f64>,
}

/// A contraction rate in a stretched metric: of any two solutions, while both have position errors in the region and velocity errors up to
/// these bounds. Nothing says that they stay there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StretchedSummary {
    /// The rate [1/s].
    pub rate: f64,
    /// Largest |s_i|, links then motors [rad/s].
    pub velocity_error: Vec<f64>,
    /// b of the stretch of each position error, links then motors; none where nothing is stretched.
    pub exponent: Vec<Option<f64>>,
}

/// A state and a direction in which a claim fails.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WitnessSummary {
    /// Block that is slower than was asked.
    pub block: BlockName,
    /// Position errors of the block's side in rad.
    pub error: Option<Vec<f64>>,
    /// Joint positions in rad.
    pub configuration: Option<Vec<f64>>,
    /// Direction of the variation.
    pub direction: Vec<f64>,
    /// Rate of that block at that state [1/s].
    pub rate: f64,
}

/// Why nothing was decided.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UndecidedSummary {
    /// The place, or the reason.
    pub at: String,
    /// Boxes looked at before it stopped.
    pub spent: usize,
}

fn floats(numbers: &[Number]) -> Vec<f64> {
    numbers.iter().map(Number::approximate).collect()
}

impl BlockSummary {
    /// The contraction rates of `certificate`.
    pub(crate) fn contraction(certificate: &Certificate) -> Self {
        Self::of(&certificate.blocks, |block| &block.contraction)
    }

    fn of(blocks: &[Block], rate: impl Fn(&Block) -> &Number) -> Self {
        let of = |name| {
            blocks
                .iter()
                .find(|block| block.block == name)
                .map_or(f64::NAN, |block| rate(block).approximate())
        };
        Self {
            phi_l: of(BlockName::PhiL),
            phi_m: of(BlockName::PhiM),
            sigma_l: of(BlockName::SigmaL),
            sigma_m: of(BlockName::SigmaM),
        }
    }
}

impl ProofSummary {
    /// A unit of joints, as this robot's turn or slide.
    pub fn unit(&self, unit: Unit) -> String {
        of_joints(unit, "", &self.kinds)
    }

    /// The summary of a proof of `scenario`.
    pub fn new(scenario: &Scenario, proof: &Proof, sampled: Option<Sampled>) -> Self {
        let certificate = proof.verdict.proved();
        let sigma_l = |c: &Certificate| BlockSummary::contraction(c).sigma_l;
        let (witness, undecided) = match &proof.verdict {
            Verdict::Proved(_) => (None, None),
            Verdict::Refuted(witness) => {
                let (error, configuration) = match &witness.state {
                    WitnessState::Error(error) => (Some(error.clone()), None),
                    WitnessState::Configuration(q) => (None, Some(q.clone())),
                    WitnessState::Any => (None, None),
                };
                let (direction, rate) = (witness.direction.clone(), witness.rate);
                (Some(WitnessSummary { block: witness.block, error, configuration, direction, rate }), None)
            }
            Verdict::Undecided(reason) => {
                (None, Some(UndecidedSummary { at: reason.at.clone(), spent: reason.spent }))
            }
        };
        Self {
            name: scenario.name.clone(),
            kinds: scenario.robot.kinds(),
            verdict: Standing::of(scenario, proof, sampled.as_ref()).words(),
            step: Step::of(scenario, proof).filter(|_| sampled.as_ref().is_none_or(|sampled| sampled.stable)),
            may_be_higher: proof.sampled_tube.is_none()
                && !proof.climbed
                && suitable_when_sampled(scenario).is_ok(),
            left_out: scenario.beyond_ideal(),
            contraction_rate: certificate.and_then(|c| Some(c.contraction_rate.as_ref()?.approximate())),
            convergence_rate: certificate.map(|c| c.convergence_rate.approximate()),
            paper_rate: proof.paper_rate,
            blocks: certificate.map(BlockSummary::contraction),
            convergence_blocks: certificate.map(|c| BlockSummary::of(&c.blocks, |block| &block.convergence)),
            region: certificate.map(region),
            measures: certificate.map_or_else(Vec::new, measures),
            structure: certificate.map_or_else(Vec::new, |c| {
                c.structure
                    .iter()
                    .map(|&StructureClaim { name, holds, .. }| StructureSummary { name, holds })
                    .collect()
            }),
            mass_matrix_positive_definite: certificate.map(|_| true),
            sigma_l_sampled: proof.sampled.clone(),
            sampled,
            tightness: certificate.map(|c| sigma_l(c) / proof.sampled.rate),
            start: proof
                .start
                .zip(certificate)
                .map(|(level, certificate)| StartSummary { level, inside: inside(certificate, level) }),
            within: proof.within.as_ref().map(within),
            funnel: proof.robust.clone().map(|found| {
                found.map_or_else(FunnelSummary::Undecided, |found| FunnelSummary::Proved(Box::new(found)))
            }),
            sampled_tube: proof.sampled_tube.clone().map(|found| {
                found.map_or_else(SampledTubeSummary::Undecided, |found| {
                    SampledTubeSummary::Proved(Box::new(found))
                })
            }),
            along: proof.along.clone(),
            direct: proof.confirmation.as_ref().map(direct),
            tube: certificate.and_then(|c| c.tube.as_ref()).map(|tube| TubeSummary {
                disturbance: floats(&tube.disturbance),
                level: tube.level.approximate(),
                error: floats(&tube.error),
            }),
            stretched: certificate.and_then(|c| c.stretched.as_ref()).map(|claim| StretchedSummary {
                rate: claim.rate.approximate(),
                velocity_error: floats(&claim.velocity_error),
                exponent: claim.exponent.iter().map(|b| b.as_ref().map(Number::approximate)).collect(),
            }),
            witness,
            undecided,
            assumptions: proof.assumptions.clone(),
            wall_seconds: proof.wall_seconds,
        }
    }
}

fn within(found: &Result<Within, Open>) -> WithinSummary {
    match found {
        Ok(found) => WithinSummary {
            verdict: "proved",
            rate: Some(found.rate),
            level: Some(found.level),
            settles: Some(found.settles),
            error: Some(found.error.clone()),
            at: None,
            closer: None,
        },
        Err(open) => WithinSummary {
            verdict: "undecided",
            rate: None,
            level: None,
            settles: None,
            error: None,
            at: Some(open.at.clone()),
            closer: open.closer.clone(),
        },
    }
}

fn direct(confirmation: &Confirmation) -> DirectSummary {
    let verdict = confirmation.word();
    let (rate, boxes, at) = match confirmation {
        Verdict::Proved(proved) => (Some(proved.rate), Some(proved.boxes), None),
        Verdict::Refuted(witness) => (None, None, Some(witness.at.to_string())),
        Verdict::Undecided(undecided) => (None, Some(undecided.spent), Some(undecided.at.clone())),
    };
    DirectSummary { verdict, rate, boxes, at }
}

fn region(certificate: &Certificate) -> RegionSummary {
    let error: Option<Vec<f64>> =
        certificate.region.error.iter().map(|e| e.as_ref().map(Number::approximate)).collect();
    let level = certificate.region.level.as_ref().map(Number::approximate);
    let metric = certificate.controller.link.metric.iter().chain(&certificate.controller.motor.metric);
    let error_at_level =
        level.map(|c| metric.map(|metric| (2.0 * c / metric.approximate()).sqrt()).collect());
    RegionSummary { error, level, error_at_level }
}

fn measures(certificate: &Certificate) -> Vec<MeasureSummary> {
    let summary = |m: &crate::prove::engine::certificate::Measure| MeasureSummary {
        side: m.side,
        norm: m.norm,
        bound: m.bound.approximate(),
    };
    certificate.measures.iter().map(summary).collect()
}
