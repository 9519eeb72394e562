//! Dense samples of the mass matrix over all configurations: how tight a proved bound is.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links};
use serde::Serialize;

use crate::files::Problems;
use crate::linalg::{Leading, Symmetric, eigenvalues};
use crate::robot::{self, RobotVisitor, with_robot};

/// Configurations looked at before the worst are refined.
const SAMPLES: u32 = 20_000;

/// Rounds of refinement, and by how much each shrinks its steps.
const ROUNDS: u32 = 60;
const SHRINK: f64 = 0.8;

/// The worst configuration found for the links' momenta.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sampled {
    /// Smallest eigenvalue of diag(d) relative to M_l(q) [1/s]: an upper bound of the true rate.
    pub rate: f64,
    /// Where, in rad (m for prismatic joints).
    pub configuration: Vec<f64>,
    /// M_l there [kg m²].
    #[serde(skip)]
    pub mass_matrix: Symmetric<f64>,
    /// Largest eigenvalue of M_l at the configuration where that is largest [kg m²].
    pub largest_inertia: f64,
}

/// Samples the links' mass matrix against `damping`, the diagonal of D_l + K_ld [N m s/rad]. The same numbers each time:
/// configurations follow a sequence of low discrepancy, not chance.
///
/// # Errors
/// If the robot has too many joints.
pub fn sample(robot: &robot::Robot, damping: &[f64]) -> Result<Sampled, Problems> {
    with_robot(robot, Sampler { robot, damping })
}

struct Sampler<'a> {
    robot: &'a robot::Robot,
    damping: &'a [f64],
}

impl RobotVisitor for Sampler<'_> {
    type Output = Sampled;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Sampled {
        let root = Vector::<f64, N>::from_fn(|i| self.damping[i].sqrt());
        let ranges = ranges::<N>(self.robot);
        let rate = |q: &Vector<f64, N>| {
            let m = robot.links.mass_matrix(q);
            1.0 / largest::<N>(Matrix::from_fn(|i, j| m[(i, j)] / (root[i] * root[j])))
        };
        let inertia = |q: &Vector<f64, N>| -largest(robot.links.mass_matrix(q));
        let (rate, configuration) = smallest(&ranges, &rate);
        let (negative, _) = smallest(&ranges, &inertia);
        let mass = robot.links.mass_matrix(&configuration);
        let mass_matrix = Symmetric::from_fn(N, |i, j| mass[(i, j)]);
        let configuration = configuration.0.to_vec();
        Sampled { rate, configuration, mass_matrix, largest_inertia: -negative }
    }
}

/// A full turn for joints that turn, the travel for those that slide.
fn ranges<const N: usize>(robot: &robot::Robot) -> Vector<(f64, f64), N> {
    let turn = std::f64::consts::PI;
    Vector::from_fn(|i| match robot.joints[i].kind {
        robot::JointKind::Revolute => (-turn, turn),
        robot::JointKind::Prismatic => {
            let end = |limit: f64| if limit.is_finite() { limit } else { 0.0 };
            (end(robot.limits.lower[i]), end(robot.limits.upper[i]))
        }
    })
}

fn largest<const N: usize>(mut m: Matrix<f64, N, N>) -> f64 {
    eigenvalues(Leading::of(&mut m.0, N)).fold(f64::NEG_INFINITY, f64::max)
}

/// The smallest value found of `f` over the ranges, and where.
fn smallest<const N: usize>(
    ranges: &Vector<(f64, f64), N>,
    f: &dyn Fn(&Vector<f64, N>) -> f64,
) -> (f64, Vector<f64, N>) {
    // Kronecker sequence of the root of x^(N+1) = x + 1 (M. Roberts, 2018): even in every dimension.
    let root = (0..50).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (N as f64 + 1.0)));
    let mut power = 1.0;
    let steps = Vector::<f64, N>::from_fn(|_| {
        power /= root;
        power
    });
    let at = |k: u32| {
        Vector::<f64, N>::from_fn(|i| {
            let phase = (0.5 + f64::from(k) * steps[i]).fract();
            let (low, high) = ranges[i];
            low + (high - low) * phase
        })
    };
    let best = (0..SAMPLES).map(|k| (f(&at(k)), at(k))).min_by(|(a, _), (b, _)| a.total_cmp(b));
    let (mut value, mut q) = best.unwrap_or((f64::INFINITY, at(0)));
    let mut step = 0.3;
    for _ in 0..ROUNDS {
        for i in 0..N {
            for sign in [-1.0, 1.0] {
                let mut next = q;
                let (low, high) = ranges[i];
                next[i] = (next[i] + sign * step * (high - low) / std::f64::consts::TAU).clamp(low, high);
                let found = f(&next);
                if found < value {
                    (value, q) = (found, next);
                }
            }
        }
        step *= SHRINK;
    }
    (value, q)
}
