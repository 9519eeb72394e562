//! Simplified Newton iteration for the collocation equations of a flexible-joint robot.
//!
//! Unknown are the accelerations of links and motors at the stages; residuals are torques. The iteration matrix keeps
//! what can be stiff, namely the mass matrix and the slopes of the springs at the start of the step, and dampers. It
//! leaves out velocity products and gravity, whose part vanishes with the step. Motors do not couple to each other and
//! are eliminated; what remains are n × n blocks of one small matrix over the stages, n the robot's own joints: those that only
//! fill a capacity stay as they are.
//!
//! The elimination by blocks is here and not in [`linalg`](crate::linalg) because it is the kernel of the simulation, run every
//! step on the stack: its entries are 4 × 4 matrices that do not commute, so that no factorisation over numbers does it.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion};

use crate::plant::Plant;
use crate::simulate::gauss::StepSolution;
use crate::simulate::scheme::{STAGES, Scheme, Stages};

type Block = Matrix<f64, STAGES, STAGES>;

const MAX_ITERATIONS: usize = 25;

/// Corrections that no longer shrink are rounding if they are within this factor of the floor: residuals are
/// differences of torques that can be much larger than what accelerates the joint.
const STALL: f64 = 1e4;

/// The factorised iteration matrix of one step.
pub(crate) struct StageSolver<const N: usize> {
    /// Number of joints, at most N; nothing is kept of others.
    joints: usize,
    /// (M_m + h D_m A + h² K A²)⁻¹ per joint.
    motor: [Block; N],
    /// h² K A² per joint: how an acceleration of one side loads the other through the spring.
    spring: [Block; N],
    /// How it loads the other through coupled rotors: a row per link, a column per motor [kg m²].
    coupling: Option<Matrix<f64, N, N>>,
    /// Block LU of M ⊗ 1 + diag(G): unit lower part below the diagonal, inverses of pivots on it.
    link: [[Block; N]; N],
}

impl<const N: usize> StageSolver<N> {
    pub(crate) fn new<L: Links<f64, N>>(
        scheme: &Scheme,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        h: f64,
    ) -> Self {
        let robot = &plant.robot;
        let joints = robot.links.joints();
        let stiffness = plant.tangent_stiffness(x);
        let spring: [Block; N] =
            per_joint(joints, Block::ZERO, |k| scheme.twice.scaled(h * h * stiffness[k]));
        let motor: [Block; N] = per_joint(joints, Block::ZERO, |k| {
            let inertia = Matrix::identity().scaled(robot.motor_inertia[k]);
            inverse(&(inertia + scheme.once.scaled(h * robot.motor_damping[k]) + spring[k]))
        });
        let mass = robot.links.mass_matrix(&x.q_l);
        let mut link = [[Block::ZERO; N]; N];
        for (k, row) in link[..joints].iter_mut().enumerate() {
            for (l, block) in row[..joints].iter_mut().enumerate() {
                let inertia = Matrix::identity().scaled(mass[(k, l)]);
                *block = if k == l {
                    let own = scheme.once.scaled(h * robot.link_damping[k]) + spring[k];
                    inertia + own - spring[k] * motor[k] * spring[k]
                } else {
                    inertia
                };
            }
        }
        let coupling = plant.coupling_matrix(&x.q_l);
        if let Some(S) = &coupling {
            // What the motors' elimination adds to the springs' −h² K A² beside S.
            for (k, row) in link[..joints].iter_mut().enumerate() {
                for (l, block) in row[..joints].iter_mut().enumerate() {
                    let mut added =
                        (motor[l] * spring[l]).scaled(S[(k, l)]) + (motor[k] * spring[k]).scaled(S[(l, k)]);
                    for (j, motor) in motor[..joints].iter().enumerate() {
                        added = added - motor.scaled(S[(k, j)] * S[(l, j)]);
                    }
                    *block = *block + added;
                }
            }
        }
        for j in 0..joints {
            link[j][j] = inverse(&link[j][j]);
            for i in j + 1..joints {
                link[i][j] = link[i][j] * link[j][j];
                for k in j + 1..joints {
                    link[i][k] = link[i][k] - link[i][j] * link[j][k];
                }
            }
        }
        Self { joints, motor, spring, coupling, link }
    }

    /// Iterates until corrections are below `floor` [rad/s²], or stop shrinking close to it. None if they do not.
    /// `stage(i, solution)` gives the motion and the motor torque at stage `i`.
    pub(crate) fn solve<L: Links<f64, N>>(
        &self,
        plant: &Plant<L, N>,
        solution: &mut StepSolution<N>,
        floor: f64,
        stage: impl Fn(usize, &StepSolution<N>) -> (Motion<f64, N>, Vector<f64, N>),
    ) -> Option<()> {
        let mut previous = f64::INFINITY;
        for iteration in 0..MAX_ITERATIONS {
            let correction = self.improve(plant, solution, &stage);
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
        plant: &Plant<L, N>,
        solution: &mut StepSolution<N>,
        stage: &impl Fn(usize, &StepSolution<N>) -> (Motion<f64, N>, Vector<f64, N>),
    ) -> f64 {
        let mut link = [Stages::ZERO; N];
        let mut motor = [Stages::ZERO; N];
        for i in 0..STAGES {
            let (x, u) = stage(i, solution);
            let [missing_l, missing_m] = plant.unbalanced(&x, &u, [solution.link[i], solution.motor[i]]);
            for k in 0..self.joints {
                link[k][i] = missing_l[k];
                motor[k][i] = missing_m[k];
            }
        }
        // Motors out, links solved, motors back.
        let free: [Stages; N] = per_joint(self.joints, Stages::ZERO, |k| self.motor[k] * motor[k]);
        let link = self.solve_links(per_joint(self.joints, Stages::ZERO, |k| {
            link[k] + self.load(k, &free, |S, j| S[(k, j)])
        }));
        let mut worst = 0.0_f64;
        for k in 0..self.joints {
            let motor = free[k] + self.motor[k] * self.load(k, &link, |S, j| S[(j, k)]);
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

    /// How accelerations of one side load joint `k` of the other; `share` picks what joint j adds from S.
    #[inline]
    fn load(
        &self,
        k: usize,
        accelerations: &[Stages; N],
        share: impl Fn(&Matrix<f64, N, N>, usize) -> f64,
    ) -> Stages {
        let mut load = self.spring[k] * accelerations[k];
        if let Some(S) = &self.coupling {
            for (j, acceleration) in accelerations[..self.joints].iter().enumerate() {
                load -= acceleration.scaled(share(S, j));
            }
        }
        load
    }

    fn solve_links(&self, mut b: [Stages; N]) -> [Stages; N] {
        for i in 0..self.joints {
            for j in 0..i {
                let known = self.link[i][j] * b[j];
                b[i] -= known;
            }
        }
        for i in (0..self.joints).rev() {
            for j in i + 1..self.joints {
                let known = self.link[i][j] * b[j];
                b[i] -= known;
            }
            b[i] = self.link[i][i] * b[i];
        }
        b
    }
}

/// `entry(k)` for each of the first `joints` joints, `other` for those that only fill the capacity.
fn per_joint<T: Copy, const N: usize>(joints: usize, other: T, entry: impl Fn(usize) -> T) -> [T; N] {
    std::array::from_fn(|k| if k < joints { entry(k) } else { other })
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
