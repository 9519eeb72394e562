//! The structural engine: the coupling cancels, so that the four blocks decide, and each of them needs finitely many
//! matrices.

use flexure_core::scalar::Interval;

use crate::prove::engine::certificate::{
    Block, BlockName, Case, Certificate, ClosedLoopWords, DecimalLaw, DecimalRobot, LoopSide, MassMatrix,
    Measure, Norm, Subject, VERSION, bounds,
};
use crate::prove::engine::coupling::{DISSIPATION, ROWS, coupling_cancels};
use crate::prove::engine::momentum::{self, MomentumBlock};
use crate::prove::engine::number::Number;
use crate::prove::engine::position::{Ends, Position};
use crate::prove::engine::rate::{ClaimedRate, Inequality, largest};
use crate::prove::engine::region::{RequestedRegion, region, tube};
use crate::prove::engine::reserve::Reserve;
use crate::prove::engine::stretched::{self, StretchedQuestion};
use crate::prove::engine::structure::{self, SideOf};
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::prove::engine::witness::{RateWitness, WitnessState, against};

/// Most cases of a position block: those of ten joints. A certificate lists every one.
const MOST_CASES: usize = 1024;

/// What is to be proved of a closed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposition {
    /// Name of the scenario.
    pub name: String,
    /// What the files of the loop say, hashed; none of a loop that was not read from files.
    pub subject: Option<Subject>,
    /// What no source vouches for.
    pub assumptions: Vec<String>,
    /// The robot.
    pub robot: DecimalRobot,
    /// The law.
    pub controller: DecimalLaw,
    /// Errors for which it shall be proved.
    pub region: RequestedRegion,
    /// Largest disturbance torque of each motor [N m], if tubes are asked for.
    pub disturbance: Option<Vec<Number>>,
    /// Largest velocity errors [rad/s], links then motors, if a rate in a stretched metric is asked for.
    pub velocity_error: Option<Vec<Number>>,
}

/// Proves contraction and convergence rates of the closed loop, and what follows from them, leaving `reserve` unclaimed.
pub fn certify(problem: &Proposition, reserve: Reserve) -> Verdict<Certificate, RateWitness> {
    match attempt(problem, reserve) {
        Ok(certificate) => Verdict::Proved(certificate),
        Err(Failure::Witness(witness)) => Verdict::Refuted(*witness),
        Err(Failure::Reason(at)) => Verdict::Undecided(Undecided { at, spent: 1 }),
    }
}

/// Why there is no certificate.
enum Failure {
    Witness(Box<RateWitness>),
    Reason(String),
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Reason(reason)
    }
}

/// The position blocks of links and motors over the errors of the region.
pub fn positions(controller: &DecimalLaw, errors: &[Option<Number>]) -> [Position; 2] {
    let errors: Vec<_> = errors.iter().map(|error| error.as_ref().map(Number::bounds)).collect();
    let (links, motors) = errors.split_at(controller.link.joints());
    [
        Position::new(controller.phi, &controller.link, links),
        Position::new(controller.phi, &controller.motor, motors),
    ]
}

fn attempt(problem: &Proposition, reserve: Reserve) -> Result<Certificate, Failure> {
    let Proposition { robot, controller, .. } = problem;
    if !coupling_cancels() {
        return Err(Failure::Reason("the coupling does not cancel".to_owned()));
    }
    let metric: Vec<Interval> =
        bounds(&controller.link.metric).into_iter().chain(bounds(&controller.motor.metric)).collect();
    let region = region(&problem.region, &metric);
    let sides = positions(controller, &region.error);
    let [links, motors] = &sides;

    let damping_l = momentum::damping(&robot.link_damping, &controller.link.damping);
    let damping_m = momentum::damping(&robot.motor_damping, &controller.motor.damping);
    let link_block = momentum::links(robot, &damping_l, reserve)?;
    let motor_block = MomentumBlock {
        inequalities: vec![momentum::motors(robot, &damping_m)],
        cases: vec![String::new()],
        unclaimed: reserve.relative(),
        forms: None,
    };
    let blocks = vec![
        position_block(BlockName::PhiL, links, reserve)?,
        position_block(BlockName::PhiM, motors, reserve)?,
        momentum_block(BlockName::SigmaL, &link_block, reserve)?,
        momentum_block(BlockName::SigmaM, &motor_block, reserve)?,
    ];

    let smallest = |rate: fn(&Block) -> &Number, blocks: &[Block]| {
        let first = |best: Number, block: &Block| {
            if rate(block).bounds().lo() < best.bounds().lo() { rate(block).clone() } else { best }
        };
        blocks.iter().fold(rate(&blocks[0]).clone(), first)
    };
    let tube = match &problem.disturbance {
        None => None,
        Some(disturbance) => {
            let others = smallest(|block| &block.convergence, &blocks[..3]);
            let rates = (blocks[3].convergence.bounds(), others.bounds());
            Some(tube(robot, disturbance, rates, &metric, &region)?)
        }
    };
    let stretched = match &problem.velocity_error {
        None => None,
        Some(velocity_error) => {
            let block_rate = blocks[2].contraction.bounds();
            let of =
                StretchedQuestion { robot, controller, error: &region.error, velocity_error, block_rate };
            Some(stretched::claim(&of, reserve)?)
        }
    };
    let sided = |side, gains, position| SideOf { side, gains, position };
    let constant = controller.link.hardening.is_none();
    let structure = if constant {
        let sides = [
            sided(LoopSide::Link, &controller.link, links),
            sided(LoopSide::Motor, &controller.motor, motors),
        ];
        structure::claims(controller.phi, &sides)?
    } else {
        Vec::new()
    };
    Ok(Certificate {
        format: "flexure-certificate".to_owned(),
        version: VERSION,
        name: problem.name.clone(),
        made_by: format!("flexure {}", env!("CARGO_PKG_VERSION")),
        subject: problem.subject.clone(),
        assumptions: problem.assumptions.clone(),
        robot: robot.clone(),
        controller: controller.clone(),
        region,
        closed_loop: ClosedLoopWords {
            rows: ROWS.map(|row| row.map(str::to_owned)),
            dissipation: DISSIPATION.map(str::to_owned),
        },
        contraction_rate: constant.then(|| smallest(|block| &block.contraction, &blocks)),
        convergence_rate: smallest(|block| &block.convergence, &blocks),
        mass_matrix: mass_matrix(robot, link_block.forms, reserve)?,
        measures: measures(&[links, motors], &blocks, reserve),
        structure,
        blocks,
        tube,
        stretched,
    })
}

fn mass_matrix(
    robot: &DecimalRobot,
    forms: Option<Vec<Option<Vec<Number>>>>,
    reserve: Reserve,
) -> Result<MassMatrix, Failure> {
    let pivots = momentum::pivots(&robot.links);
    if let Some(k) = pivots.iter().position(|&pivot| pivot <= 0.0) {
        return Err(Failure::Reason(format!(
            "body {} has no inertia of its own about its joint: the mass matrix may be singular somewhere",
            k + 1
        )));
    }
    let margins = pivots.iter().map(|&pivot| Number::margin(reserve.claimed() * pivot)).collect();
    Ok(MassMatrix { margins, forms })
}

fn measures(sides: &[&Position; 2], blocks: &[Block], reserve: Reserve) -> Vec<Measure> {
    let entries = [LoopSide::Link, LoopSide::Motor].into_iter().zip(sides).zip(blocks);
    entries
        .flat_map(|((side, position), block)| {
            let up = |x: f64| Number::above(x + reserve.relative() * x.abs());
            let negative = |rate: &Number| match rate {
                Number::Decimal(text) | Number::Between([text, _]) => Number::Decimal(format!("-{text}")),
            };
            [
                (Norm::One, up(position.measure(true))),
                (Norm::Two, negative(&block.contraction)),
                (Norm::Infinity, up(position.measure(false))),
            ]
            .map(|(norm, bound)| Measure { side, norm, bound })
        })
        .collect()
}

fn momentum_block(block: BlockName, from: &MomentumBlock, reserve: Reserve) -> Result<Block, Failure> {
    let claim = largest(&from.inequalities, from.unclaimed)
        .ok_or_else(|| Failure::Reason(format!("no positive rate of {} could be shown", block.name())))?;
    let margins = claim.margins.iter().map(|&margin| Number::margin(reserve.claimed() * margin));
    let cases = from.cases.iter().zip(margins).map(|(case, margin)| Case {
        case: case.clone(),
        contraction: margin.clone(),
        convergence: margin,
    });
    Ok(Block { block, cases: cases.collect(), contraction: claim.rate.clone(), convergence: claim.rate })
}

fn position_block(block: BlockName, position: &Position, reserve: Reserve) -> Result<Block, Failure> {
    if position.case_count() > MOST_CASES {
        return Err(Failure::Reason(format!(
            "{} has {} cases, one per corner of the slopes of {} joints that φ couples; at most {MOST_CASES} are looked at; linear and tanh have one",
            block.name(),
            position.case_count(),
            position.joints()
        )));
    }
    let cases = position.cases();
    let claimed = |a: &dyn Fn(&Ends) -> Vec<Interval>| -> Result<ClaimedRate, Failure> {
        let inequalities: Vec<Inequality> = cases.iter().map(|case| position.inequality(&a(case))).collect();
        largest(&inequalities, reserve.relative()).ok_or_else(|| {
            let refuted = cases.iter().zip(&inequalities).find_map(|(case, inequality)| {
                let (direction, value) = against(inequality, 0.0)?;
                // Slopes are 1 at no error and smallest at the largest.
                let far: Vec<bool> = case.iter().map(|high| !high).collect();
                // A slope that is only approached, where errors have no bound, has no state.
                let state = WitnessState::Error(position.bounded(&far).then(|| position.error_at(&far))?);
                Some(RateWitness { block, state, direction, rate: value })
            });
            match refuted {
                Some(witness) => Failure::Witness(Box::new(witness)),
                None => Failure::Reason(format!(
                    "no positive rate of {} on the region: slopes of φ come arbitrarily close to 0 where errors are \
                     large",
                    block.name()
                )),
            }
        })
    };
    let contraction = claimed(&|case| position.slopes(case))?;
    let convergence = claimed(&|case| position.chords(case))?;
    let margins = contraction.margins.iter().zip(&convergence.margins);
    let cases = cases.iter().zip(margins).map(|(case, (&contraction, &convergence))| Case {
        case: case.iter().map(|&high| if high { 'H' } else { 'L' }).collect(),
        contraction: Number::margin(reserve.claimed() * contraction),
        convergence: Number::margin(reserve.claimed() * convergence),
    });
    Ok(Block { block, cases: cases.collect(), contraction: contraction.rate, convergence: convergence.rate })
}
