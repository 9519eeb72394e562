//! Dense samples of the mass matrix over all configurations: how tight a proved bound is.

use serde::Serialize;

use crate::files::Problems;
use crate::linalg::{Dense, Leading, Symmetric, eigenvalues};
use crate::progress::{Progress, unwatched};
use crate::robot::{JointKind, MovingJoint, Robot};

/// Configurations looked at before the worst are refined.
const SAMPLES: u32 = 20_000;

/// So many between two looks at whether to go on: milliseconds.
const UNWATCHED: u32 = 500;

/// Rounds of refinement, and by how much each shrinks its steps.
const ROUNDS: u32 = 60;
const SHRINK: f64 = 0.8;

/// The worst configuration found for the links' momenta.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sampled {
    /// Smallest eigenvalue of diag(d) relative to M_l(q) [1/s]: an upper bound of the true rate.
    pub rate: f64,
    /// Joint positions of the smallest sampled rate, in rad (m for prismatic joints).
    pub configuration: Vec<f64>,
    /// M_l at that configuration [kg m²].
    #[serde(skip)]
    pub mass_matrix: Symmetric<f64>,
    /// Largest eigenvalue of M_l at the configuration where that is largest [kg m²].
    pub largest_inertia: f64,
}

/// Samples the links' mass matrix against `damping`, the diagonal of D_l + K_ld [N m s/rad]. The same numbers each time:
/// configurations follow a sequence of low discrepancy, not chance. `progress` is told what fraction is done.
///
/// # Errors
/// If the robot has too many joints, and [`Problems::interrupted`] if it was broken off.
///
/// # Panics
/// If `damping` has fewer numbers than the robot has joints.
pub fn sample(robot: &Robot, damping: &[f64], progress: Progress<'_>) -> Result<Sampled, Problems> {
    let (n, arm) = (robot.joint_count(), robot.arm()?);
    let root: Vec<f64> = damping.iter().map(|d| d.sqrt()).collect();
    let ranges = ranges(robot);
    let mass_matrix = |q: &[f64]| {
        let mut mass = vec![0.0; n * n];
        arm.mass_matrix(q, &mut mass).expect("n joints");
        mass
    };
    let rate = |q: &[f64]| {
        let mass = mass_matrix(q);
        1.0 / largest(n, |i, j| mass[i * n + j] / (root[i] * root[j]))
    };
    let inertia = |q: &[f64]| {
        let mass = mass_matrix(q);
        -largest(n, |i, j| mass[i * n + j])
    };
    let (rate, configuration) =
        smallest(&ranges, &rate, &|part| progress(0.5 * part)).ok_or_else(Problems::interrupted)?;
    let (negative, _) =
        smallest(&ranges, &inertia, &|part| progress(0.5 + 0.5 * part)).ok_or_else(Problems::interrupted)?;
    let mass = mass_matrix(&configuration);
    let mass_matrix = Symmetric::from_fn(n, |i, j| mass[i * n + j]);
    Ok(Sampled { rate, configuration, mass_matrix, largest_inertia: -negative })
}

/// The largest diagonal entries of the links' mass matrix over the samples [kg m²].
///
/// # Errors
/// If the robot has too many joints.
///
/// # Panics
/// Never: the slices have one entry per joint.
pub fn largest_diagonal(robot: &Robot) -> Result<Vec<f64>, Problems> {
    let (n, arm) = (robot.joint_count(), robot.arm()?);
    let ranges = ranges(robot);
    let entry = |joint: usize| {
        let negative = |q: &[f64]| {
            let mut mass = vec![0.0; n * n];
            arm.mass_matrix(q, &mut mass).expect("n joints");
            -mass[joint * (n + 1)]
        };
        smallest(&ranges, &negative, &unwatched).map_or(f64::INFINITY, |(negative, _)| -negative)
    };
    Ok((0..n).map(entry).collect())
}

/// A full turn for joints that turn, the travel for those that slide.
fn ranges(robot: &Robot) -> Vec<(f64, f64)> {
    let turn = std::f64::consts::PI;
    let range = |(i, joint): (usize, &MovingJoint)| match joint.kind {
        JointKind::Revolute => (-turn, turn),
        JointKind::Prismatic => {
            let end = |limit: f64| if limit.is_finite() { limit } else { 0.0 };
            (end(robot.limits.lower[i]), end(robot.limits.upper[i]))
        }
    };
    robot.joints.iter().enumerate().map(range).collect()
}

/// The largest eigenvalue of the symmetric `n` × `n` matrix of `entry`.
fn largest(n: usize, entry: impl Fn(usize, usize) -> f64) -> f64 {
    let mut matrix = Dense::from_fn(n, n, entry);
    eigenvalues(Leading::whole(&mut matrix)).fold(f64::NEG_INFINITY, f64::max)
}

/// The smallest value found of `f` over the ranges, and where; none if it was broken off.
fn smallest(
    ranges: &[(f64, f64)],
    f: &dyn Fn(&[f64]) -> f64,
    progress: Progress<'_>,
) -> Option<(f64, Vec<f64>)> {
    let n = ranges.len();
    // Kronecker sequence of the root of x^(n+1) = x + 1 (M. Roberts, 2018): even in every dimension.
    let root = (0..50).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (n as f64 + 1.0)));
    let mut power = 1.0;
    let steps: Vec<f64> = ranges
        .iter()
        .map(|_| {
            power /= root;
            power
        })
        .collect();
    let at = |k: u32| -> Vec<f64> {
        let place = |(step, (low, high)): (&f64, &(f64, f64))| {
            let phase = (0.5 + f64::from(k) * step).fract();
            low + (high - low) * phase
        };
        steps.iter().zip(ranges).map(place).collect()
    };
    let (mut value, mut q) = (f64::INFINITY, at(0));
    for k in 0..SAMPLES {
        if k % UNWATCHED == 0 && progress(f64::from(k) / f64::from(SAMPLES)).is_break() {
            return None;
        }
        let there = at(k);
        let found = f(&there);
        if found < value {
            (value, q) = (found, there);
        }
    }
    let mut step = 0.3;
    for _ in 0..ROUNDS {
        for (i, (low, high)) in ranges.iter().enumerate() {
            for sign in [-1.0, 1.0] {
                let here = q[i];
                q[i] = (here + sign * step * (high - low) / std::f64::consts::TAU).clamp(*low, *high);
                let found = f(&q);
                if found < value {
                    value = found;
                } else {
                    q[i] = here;
                }
            }
        }
        step *= SHRINK;
    }
    Some((value, q))
}
