//! Simplified Newton iteration for the collocation equations of a flexible-joint robot.
//!
//! Unknown are the accelerations of links and motors at the stages; residuals are torques. The iteration matrix keeps
//! what can be stiff, namely the mass matrix at the start of the step, springs and dampers, and leaves out velocity
//! products and gravity, whose part vanishes with the step. Motors couple only to their own joint and are
//! eliminated; what remains are N × N blocks of one small matrix over the stages.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};

use super::gauss::StepSolution;
use super::scheme::{STAGES, Scheme, Stages};

type Block = Matrix<f64, STAGES, STAGES>;

const MAX_ITERATIONS: usize = 25;

/// Corrections that no longer shrink are rounding if they are within this factor of the floor: residuals are
/// differences of torques that can be much larger than what accelerates the joint.
const STALL: f64 = 1e4;

/// The factorised iteration matrix of one step.
pub(super) struct StageSolver<const N: usize> {
    /// (M_m + h D_m A + h² K A²)⁻¹ per joint.
    motor: [Block; N],
    /// h² K A² per joint: how an acceleration of one side loads the other through the spring.
    spring: [Block; N],
    /// Block LU of M ⊗ 1 + diag(G): unit lower part below the diagonal, inverses of pivots on it.
    link: [[Block; N]; N],
}

impl<const N: usize> StageSolver<N> {
    pub(super) fn new<L: Links<f64, N>>(
        scheme: &Scheme,
        robot: &Fjr<f64, L, N>,
        q_l: &Vector<f64, N>,
        h: f64,
    ) -> Self {
        let spring = std::array::from_fn(|k| scheme.twice.scaled(h * h * robot.stiffness[k]));
        let motor: [Block; N] = std::array::from_fn(|k| {
            let inertia = Matrix::identity().scaled(robot.motor_inertia[k]);
            inverse(&(inertia + scheme.once.scaled(h * robot.motor_damping[k]) + spring[k]))
        });
        let mass = robot.links.mass_matrix(q_l);
        let mut link: [[Block; N]; N] = std::array::from_fn(|k| {
            std::array::from_fn(|l| {
                let inertia = Matrix::identity().scaled(mass[(k, l)]);
                if k == l {
                    let own = scheme.once.scaled(h * robot.link_damping[k]) + spring[k];
                    inertia + own - spring[k] * motor[k] * spring[k]
                } else {
                    inertia
                }
            })
        });
        for j in 0..N {
            link[j][j] = inverse(&link[j][j]);
            for i in j + 1..N {
                link[i][j] = link[i][j] * link[j][j];
                for k in j + 1..N {
                    link[i][k] = link[i][k] - link[i][j] * link[j][k];
                }
            }
        }
        Self { motor, spring, link }
    }

    /// Iterates until corrections are below `floor` [rad/s²], or stop shrinking close to it. None if they do not.
    /// `stage(i, solution)` gives the motion and the motor torque at stage `i`.
    pub(super) fn solve<L: Links<f64, N>>(
        &self,
        robot: &Fjr<f64, L, N>,
        solution: &mut StepSolution<N>,
        floor: f64,
        stage: impl Fn(usize, &StepSolution<N>) -> (Motion<f64, N>, Vector<f64, N>),
    ) -> Option<()> {
        let mut previous = f64::INFINITY;
        for iteration in 0..MAX_ITERATIONS {
            let correction = self.improve(robot, solution, &stage);
            let stalled = iteration > 3 && correction > 0.5 * previous;
            if correction <= floor || (stalled && correction <= STALL * floor) {
                return Some(());
            }
            if !correction.is_finite() || (stalled && correction > previous) {
                return None;
            }
            previous = correction;
        }
        None
    }

    /// One iteration: improves the accelerations and returns the largest correction [rad/s²].
    fn improve<L: Links<f64, N>>(
        &self,
        robot: &Fjr<f64, L, N>,
        solution: &mut StepSolution<N>,
        stage: &impl Fn(usize, &StepSolution<N>) -> (Motion<f64, N>, Vector<f64, N>),
    ) -> f64 {
        let mut link = [Stages::ZERO; N];
        let mut motor = [Stages::ZERO; N];
        for i in 0..STAGES {
            let (x, u) = stage(i, solution);
            let needed = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &solution.link[i]);
            let spring = robot.spring_torque(&x.q_l, &x.q_m);
            let damping_m = robot.motor_damping.diag_mul(&x.v_m);
            let inertia_m = robot.motor_inertia.diag_mul(&solution.motor[i]);
            let missing_l = robot.link_torque(&x) - needed;
            let missing_m = u - spring - damping_m - inertia_m;
            for k in 0..N {
                link[k][i] = missing_l[k];
                motor[k][i] = missing_m[k];
            }
        }
        // Motors out, links solved, motors back.
        let load: [Stages; N] = std::array::from_fn(|k| self.motor[k] * motor[k]);
        let link = self.solve_links(std::array::from_fn(|k| link[k] + self.spring[k] * load[k]));
        let mut worst = 0.0_f64;
        for k in 0..N {
            let motor = load[k] + self.motor[k] * (self.spring[k] * link[k]);
            for i in 0..STAGES {
                solution.link[i][k] += link[k][i];
                solution.motor[i][k] += motor[i];
                worst = worst.max(link[k][i].abs()).max(motor[i].abs());
                // NaN does not win a maximum.
                if !(link[k][i] + motor[i]).is_finite() {
                    return f64::NAN;
                }
            }
        }
        worst
    }

    fn solve_links(&self, mut b: [Stages; N]) -> [Stages; N] {
        for i in 0..N {
            for j in 0..i {
                let known = self.link[i][j] * b[j];
                b[i] -= known;
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                let known = self.link[i][j] * b[j];
                b[i] -= known;
            }
            b[i] = self.link[i][i] * b[i];
        }
        b
    }
}

/// Inverse by Gauss–Jordan elimination with row pivoting.
fn inverse(a: &Block) -> Block {
    let (mut a, mut inverse) = (*a, Block::identity());
    for j in 0..STAGES {
        let pivot = (j..STAGES).max_by(|&r, &s| a[(r, j)].abs().total_cmp(&a[(s, j)].abs())).unwrap_or(j);
        a.0.swap(j, pivot);
        inverse.0.swap(j, pivot);
        let reciprocal = 1.0 / a[(j, j)];
        for k in 0..STAGES {
            a[(j, k)] *= reciprocal;
            inverse[(j, k)] *= reciprocal;
        }
        for i in (0..STAGES).filter(|&i| i != j) {
            let factor = a[(i, j)];
            for k in 0..STAGES {
                a[(i, k)] -= factor * a[(j, k)];
                inverse[(i, k)] -= factor * inverse[(j, k)];
            }
        }
    }
    inverse
}
