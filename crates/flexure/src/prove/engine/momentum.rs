//! The momentum blocks: D + K_d against the mass matrices.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::Links as _;
use flexure_core::robots::{Pendulum, PlanarTwoLink};
use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{DecimalLinks, DecimalRobot, bounds};
use crate::prove::engine::number::Number;
use crate::prove::engine::rate::Inequality;
use crate::prove::engine::reach;

/// D + K_d, enclosed.
pub fn damping(plant: &[Number], injected: &[Number]) -> Vec<Interval> {
    bounds(plant).into_iter().zip(bounds(injected)).map(|(a, b)| a + b).collect()
}

/// diag(`damping`) − β M for each of the mass matrices that cover all configurations; the reason in words if none can.
///
/// # Errors
/// If the mass matrix has no bound.
pub fn links(robot: &DecimalRobot, damping: &[Interval]) -> Result<Vec<Inequality>, String> {
    Ok(masses(&robot.links)?
        .into_iter()
        .map(|weight| Inequality { form: Symmetric::diagonal(damping), weight })
        .collect())
}

/// diag(`damping`) − β M_m.
pub fn motors(robot: &DecimalRobot, damping: &[Interval]) -> Inequality {
    Inequality {
        form: Symmetric::diagonal(damping),
        weight: Symmetric::diagonal(&bounds(&robot.motor_inertia)),
    }
}

/// The letters of the cases of [`links`].
pub fn cases(links: &DecimalLinks) -> Vec<String> {
    match links {
        DecimalLinks::PlanarTwoLink { .. } => ["L", "H"].map(str::to_owned).to_vec(),
        DecimalLinks::Pendulum { .. } | DecimalLinks::Tree { .. } => vec![String::new()],
    }
}

/// Lower bounds of pivots that show M(q) to be positive definite for all q, in the order of `docs/certificate.md`.
pub fn pivots(links: &DecimalLinks) -> Vec<f64> {
    match links {
        DecimalLinks::Tree { bodies } => reach::own_inertias(bodies),
        closed_form => {
            masses(closed_form).unwrap_or_default().iter().map(Symmetric::smallest_pivot).collect()
        }
    }
}

fn masses(links: &DecimalLinks) -> Result<Vec<Symmetric<Interval>>, String> {
    match links {
        DecimalLinks::PlanarTwoLink { mass, length, com, inertia } => {
            let two = |numbers: &[Number; 2]| numbers.each_ref().map(Number::bounds);
            let arm = PlanarTwoLink::new(two(mass), length.bounds(), two(com), two(inertia));
            // Affine in cos q_2: both ends of its range cover all angles.
            let half_turn = Interval::ONE.atan() * Interval::point(4.0);
            Ok([half_turn, Interval::ZERO]
                .map(|q| symmetric(&arm.mass_matrix(&Vector([Interval::ZERO, q]))))
                .to_vec())
        }
        DecimalLinks::Pendulum { mass, com, inertia } => {
            let about_joint = inertia.bounds() + mass.bounds() * com.bounds() * com.bounds();
            let links = Pendulum { inertia: about_joint, weight_moment: Interval::ZERO };
            Ok(vec![symmetric(&links.mass_matrix(&Vector([Interval::ZERO])))])
        }
        DecimalLinks::Tree { bodies } => Ok(vec![reach::mass_bound(bodies)?]),
    }
}

fn symmetric<const N: usize>(matrix: &Matrix<Interval, N, N>) -> Symmetric<Interval> {
    Symmetric::from_fn(N, |i, j| matrix[(i, j)])
}
