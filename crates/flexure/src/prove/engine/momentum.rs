//! The momentum blocks: D + K_d against the mass matrices.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::Links as _;
use flexure_core::robots::{Pendulum, PlanarTwoLink};
use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{DecimalLinks, DecimalRobot, bounds};
use crate::prove::engine::chain::{self, Chain};
use crate::prove::engine::number::Number;
use crate::prove::engine::rate::Inequality;
use crate::prove::engine::reserve::Reserve;

/// D + K_d, enclosed.
pub fn damping(plant: &[Number], injected: &[Number]) -> Vec<Interval> {
    bounds(plant).into_iter().zip(bounds(injected)).map(|(a, b)| a + b).collect()
}

/// What has to be positive definite for diag(`damping`) − β M_l(q) to be so for all q: closed forms at the ends of their
/// cosines, a chain for a tree.
///
/// # Errors
/// The reason in words, if the mass matrix has no bound.
pub fn links(robot: &DecimalRobot, damping: &[Interval], reserve: Reserve) -> Result<MomentumBlock, String> {
    if let DecimalLinks::Tree { bodies } = &robot.links {
        let Chain { forms, inequalities, cases } = chain::chain(bodies, damping, reserve.skipped())?;
        let unclaimed = reserve.relative().max(CHAIN_RESERVE);
        return Ok(MomentumBlock { inequalities, cases, unclaimed, forms: Some(forms) });
    }
    let masses = masses(&robot.links);
    let cases = if masses.len() == 1 { vec![""] } else { vec!["L", "H"] };
    let inequality = |weight| Inequality { form: Symmetric::diagonal(damping), weight };
    Ok(MomentumBlock {
        inequalities: masses.into_iter().map(inequality).collect(),
        cases: cases.into_iter().map(str::to_owned).collect(),
        unclaimed: reserve.relative(),
        forms: None,
    })
}

/// A momentum block: diag(d) − β M for all M.
pub struct MomentumBlock {
    /// What has to be positive definite.
    pub inequalities: Vec<Inequality>,
    /// The name of each inequality.
    pub cases: Vec<String>,
    /// What is left of the rate unclaimed, relative to it.
    pub unclaimed: f64,
    /// Parameters of the forms of a chain, a joint each; none at the base, and none but for trees.
    pub forms: Option<Vec<Option<Vec<Number>>>>,
}

/// What a rate from a chain leaves unclaimed at least: its matrices have seven rows, and pivots cancel more digits than
/// those of closed forms.
const CHAIN_RESERVE: f64 = 1e-9;

/// diag(`damping`) − β M_m.
pub fn motors(robot: &DecimalRobot, damping: &[Interval]) -> Inequality {
    Inequality {
        form: Symmetric::diagonal(damping),
        weight: Symmetric::diagonal(&bounds(&robot.motor_inertia)),
    }
}

/// Matrices of which some mixture is no less than M(q), whatever q: where diag(d) − β M is positive definite for each, it is so for the
/// mass matrix. Of a tree one, diag(`damping`)/β_σ with the rate β_σ of its momentum block.
pub fn upper_masses(
    links: &DecimalLinks,
    damping: &[Interval],
    block_rate: Interval,
) -> Vec<Symmetric<Interval>> {
    match links {
        DecimalLinks::Tree { .. } => {
            let share: Vec<Interval> = damping.iter().map(|&d| d / block_rate).collect();
            vec![Symmetric::diagonal(&share)]
        }
        closed_form => masses(closed_form),
    }
}

/// Lower bounds of pivots that show M(q) to be positive definite for all q, in the order of `docs/certificate.md`.
pub fn pivots(links: &DecimalLinks) -> Vec<f64> {
    match links {
        DecimalLinks::Tree { bodies } => chain::own_inertias(bodies),
        closed_form => masses(closed_form).iter().map(Symmetric::smallest_pivot).collect(),
    }
}

/// The mass matrices of a closed form that cover all its configurations.
fn masses(links: &DecimalLinks) -> Vec<Symmetric<Interval>> {
    match links {
        DecimalLinks::PlanarTwoLink { mass, length, com, inertia } => {
            let two = |numbers: &[Number; 2]| numbers.each_ref().map(Number::bounds);
            let arm = PlanarTwoLink::new(two(mass), length.bounds(), two(com), two(inertia));
            // Affine in cos q_2: both ends of its range cover all angles.
            let half_turn = Interval::ONE.atan() * Interval::point(4.0);
            [half_turn, Interval::ZERO]
                .map(|q| symmetric(&arm.mass_matrix(&Vector([Interval::ZERO, q]))))
                .to_vec()
        }
        DecimalLinks::Pendulum { mass, com, inertia } => {
            let about_joint = inertia.bounds() + mass.bounds() * com.bounds() * com.bounds();
            let links = Pendulum { inertia: about_joint, weight_moment: Interval::ZERO };
            vec![symmetric(&links.mass_matrix(&Vector([Interval::ZERO])))]
        }
        DecimalLinks::Tree { .. } => Vec::new(),
    }
}

fn symmetric<const N: usize>(matrix: &Matrix<Interval, N, N>) -> Symmetric<Interval> {
    Symmetric::from_fn(N, |i, j| matrix[(i, j)])
}
