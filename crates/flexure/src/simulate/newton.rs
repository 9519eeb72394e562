//! Simplified Newton iteration for the collocation equations of a flexible-joint robot.
//!
//! Unknown are, at the stages, the accelerations of the links and what accelerates the motors beside their dampers; residuals are
//! torques. The iteration matrix keeps what can be stiff, namely the mass matrix and the slopes of the springs where it was made, and
//! dampers. It leaves out velocity products and gravity, whose part vanishes with the step. Motors do not couple to each other and
//! are eliminated; what remains are n × n blocks of one small matrix over the stages, n the robot's own joints: those that only
//! fill a capacity stay as they are. It serves many steps: a matrix from some way back makes more iterations, not another solution.
//!
//! The elimination by blocks is here and not in [`linalg`](crate::linalg) because it is the kernel of the simulation, done
//! on the stack: its entries are matrices over the stages that do not commute, so that no factorisation over numbers does it.

use flexure_core::linalg::{Ldl, Matrix, Vector};
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Over, Piecewise, Scalar};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::Damped;
use crate::simulate::scheme::{AtStages, Block, Scheme, StageMap, Stages};

/// Where an iteration matrix was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor<const N: usize, T = f64> {
    /// Positions in rad: the mass matrix is that at q_l, the slopes of the springs are those between.
    pub q: Sides<N, T>,
    /// Length of the step in s.
    pub h: f64,
}

/// The factorised iteration matrix of steps of one length. Of several robots, if `T` is lanes.
#[derive(Clone, Debug)]
pub(crate) struct StageSolver<const S: usize, const N: usize, T = f64> {
    pub(crate) anchor: Anchor<N, T>,
    /// Number of joints, at most N; nothing is kept of others.
    joints: usize,
    /// How each motor moves on its own.
    pub(crate) damped: [Damped<S, T>; N],
    /// (M_m + h² K A_m²)⁻¹ per joint, A_m² the damped motor's.
    motor: [StageMap<S, T>; N],
    /// How an acceleration of a link loads its motor through the spring, h² K A², per joint.
    of_link: [StageMap<S, T>; N],
    /// How what accelerates a motor loads its link through the spring, h² K A_m², per joint.
    of_motor: [StageMap<S, T>; N],
    /// How it loads the other through coupled rotors: a row per link, a column per motor [kg m²].
    coupling: Option<Matrix<T, N, N>>,
    /// Block LU of the links' matrix: unit lower part below the diagonal, inverses of pivots on it.
    link: [[StageMap<S, T>; N]; N],
    /// The mass matrix alone.
    pub(crate) mass: Ldl<T, N>,
    /// The fastest rate at which springs and dampers of links let a joint move by itself, in 1/h.
    pub(crate) fastest: T,
}

/// The polynomials of one step: accelerations of the links and what accelerates the motors beside their dampers, a joint each, at the stages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepSolution<const S: usize, const N: usize, T = f64> {
    pub(crate) link: [Stages<S, T>; N],
    pub(crate) motor: [Stages<S, T>; N],
}

impl<const S: usize, const N: usize> StageSolver<S, N> {
    pub(crate) fn new<L: Links<f64, N>>(scheme: &Scheme<S>, plant: &Plant<L, N>, anchor: Anchor<N>) -> Self {
        Self::of(scheme, plant, anchor, damped_motors(scheme, plant, anchor.h), inverse)
    }

    /// Makes the matrix anew at another anchor, of the same plant but for pushes. Coefficients of motors for lengths that come back are in
    /// `lengths`.
    pub(crate) fn move_to<L: Links<f64, N>>(
        &mut self,
        scheme: &Scheme<S>,
        plant: &Plant<L, N>,
        anchor: Anchor<N>,
        lengths: &mut Lengths<S, N>,
    ) {
        #[expect(clippy::float_cmp, reason = "coefficients of another length are others")]
        if self.anchor.h != anchor.h {
            lengths.keep(self.anchor.h, &self.damped);
            self.anchor.h = anchor.h;
            self.damped = lengths.of(anchor.h).unwrap_or_else(|| damped_motors(scheme, plant, anchor.h));
        }
        self.renew(scheme, plant, anchor.q, inverse);
    }
}

/// Lengths of steps in s, with how each motor moves on its own in them: those of the last few. A drive that is late by a part of a period has
/// two of them a period.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lengths<const S: usize, const N: usize> {
    known: Vec<(f64, [Damped<S>; N])>,
    /// The place of the one that has been there longest.
    oldest: usize,
}

/// How many are kept.
const LENGTHS: usize = 4;

impl<const S: usize, const N: usize> Lengths<S, N> {
    fn of(&self, h: f64) -> Option<[Damped<S>; N]> {
        self.known.iter().find(|(of, _)| of.to_bits() == h.to_bits()).map(|(_, damped)| *damped)
    }

    fn keep(&mut self, h: f64, damped: &[Damped<S>; N]) {
        if self.of(h).is_some() {
            return;
        }
        if self.known.len() < LENGTHS {
            self.known.push((h, *damped));
        } else {
            self.known[self.oldest] = (h, *damped);
            self.oldest = (self.oldest + 1) % LENGTHS;
        }
    }

    /// Motors are others now.
    pub(crate) fn clear(&mut self) {
        self.known.clear();
        self.oldest = 0;
    }
}

/// How each motor moves on its own in steps of length `h` s.
fn damped_motors<L: Links<f64, N>, const S: usize, const N: usize>(
    scheme: &Scheme<S>,
    plant: &Plant<L, N>,
    h: f64,
) -> [Damped<S>; N] {
    let robot = &plant.robot;
    let joints = robot.links.joints();
    std::array::from_fn(|k| {
        let rate = if k < joints { robot.motor_damping[k] / robot.motor_inertia[k] } else { 0.0 };
        Damped::new(scheme, h * rate)
    })
}

impl<const S: usize, const N: usize, T: Piecewise + Over<T> + Over<f64>> StageSolver<S, N, T> {
    /// With motors that are `damped` for steps of that length, and `inverse` for the blocks. What the inverse is worth shows in how
    /// fast corrections shrink, and nowhere else.
    pub(crate) fn of<L: Links<T, N>>(
        scheme: &Scheme<S>,
        plant: &Plant<L, N, T>,
        anchor: Anchor<N, T>,
        damped: [Damped<S, T>; N],
        inverse: impl Fn(&Block<S, T>) -> Block<S, T>,
    ) -> Self {
        let none = [StageMap::ZERO; N];
        let mut solver = Self {
            anchor,
            joints: plant.robot.links.joints(),
            damped,
            motor: none,
            of_link: none,
            of_motor: none,
            coupling: None,
            link: [none; N],
            mass: Matrix::identity().ldl(),
            fastest: T::ZERO,
        };
        solver.renew(scheme, plant, anchor.q, inverse);
        solver
    }

    /// Makes the matrix anew at the positions `q` in rad of links and motors, for steps of the same length.
    pub(crate) fn renew<L: Links<T, N>>(
        &mut self,
        scheme: &Scheme<S>,
        plant: &Plant<L, N, T>,
        q: Sides<N, T>,
        inverse: impl Fn(&Block<S, T>) -> Block<S, T>,
    ) {
        self.anchor.q = q;
        let (robot, Self { joints, damped, anchor: Anchor { q: [q_l, q_m], h }, .. }) =
            (&plant.robot, &*self);
        let (joints, q_l, h) = (*joints, *q_l, *h);
        let stiffness = plant.tangent_stiffness(&Motion { q_m: *q_m, ..Motion::at_rest(q_l) });
        let of_link = per_joint(joints, |k| times(&scheme.twice, stiffness[k].scale(h * h)));
        let of_motor =
            per_joint(joints, |k: usize| damped[k].twice.block().scaled(stiffness[k].scale(h * h)));
        let motor = per_joint(joints, |k: usize| {
            inverse(&(Matrix::identity().scaled(robot.motor_inertia[k]) + of_motor[k]))
        });
        let matrix = robot.links.mass_matrix(&q_l);
        let mass = matrix.ldl();
        let coupling = plant.coupling_matrix(&q_l);
        let mut link = [[Block::<S, T>::ZERO; N]; N];
        for (k, row) in link[..joints].iter_mut().enumerate() {
            for (l, block) in row[..joints].iter_mut().enumerate() {
                *block = Matrix::identity().scaled(matrix[(k, l)]);
                if k == l {
                    let own = times(&scheme.once, robot.link_damping[k].scale(h)) + of_link[k];
                    *block = *block + own - of_motor[k] * motor[k] * of_link[k];
                }
                if let Some(shared) = &coupling {
                    // What the motors' elimination adds to the springs' part beside S.
                    *block = *block
                        + (of_motor[k] * motor[k]).scaled(shared[(l, k)])
                        + (damped[l].acceleration.block() * motor[l] * of_link[l]).scaled(shared[(k, l)]);
                    for (j, motor) in motor[..joints].iter().enumerate() {
                        *block = *block
                            - (damped[j].acceleration.block() * *motor)
                                .scaled(shared[(k, j)] * shared[(l, j)]);
                    }
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
        let fastest = (0..joints).fold(T::ZERO, |fastest: T, k| {
            let free = mass.solve(&Vector::from_fn(|i| if i == k { T::ONE } else { T::ZERO }))[k];
            let spring = stiffness[k] * (free + T::ONE / robot.motor_inertia[k]);
            fastest.max(spring.sqrt().scale(h)).max(free.scale(h) * robot.link_damping[k])
        });
        for (maps, blocks) in
            [(&mut self.motor, &motor), (&mut self.of_link, &of_link), (&mut self.of_motor, &of_motor)]
                .into_iter()
                .chain(self.link.iter_mut().zip(&link))
        {
            for (map, block) in maps.iter_mut().zip(blocks).take(joints) {
                *map = StageMap::new(block);
            }
        }
        (self.coupling, self.mass, self.fastest) = (coupling, mass, fastest);
    }

    /// What improves a solution that leaves the torques `link` and `motor` unbalanced at the stages, a joint each [N m].
    #[inline]
    pub(crate) fn correction<V: AtStages<S, T>>(&self, link: &[V; N], motor: &[V; N]) -> [[V; N]; 2] {
        // Motors out, links solved, motors back.
        let mut free = [V::ZERO; N];
        let mut loaded = *link;
        for k in 0..self.joints {
            free[k] = self.motor[k].of(&motor[k]);
            loaded[k] += self.of_motor[k].of(&free[k]);
        }
        if let Some(shared) = &self.coupling {
            for j in 0..self.joints {
                let acceleration = self.damped[j].acceleration.of(&free[j]);
                for k in 0..self.joints {
                    loaded[k] -= acceleration.scaled(shared[(k, j)]);
                }
            }
        }
        let link = self.solve_links(loaded);
        for k in 0..self.joints {
            let mut load = self.of_link[k].of(&link[k]);
            if let Some(shared) = &self.coupling {
                for (j, link) in link[..self.joints].iter().enumerate() {
                    load -= link.scaled(shared[(j, k)]);
                }
            }
            free[k] += self.motor[k].of(&load);
        }
        [link, free]
    }

    fn solve_links<V: AtStages<S, T>>(&self, mut b: [V; N]) -> [V; N] {
        for i in 0..self.joints {
            for j in 0..i {
                let known = self.link[i][j].of(&b[j]);
                b[i] -= known;
            }
        }
        for i in (0..self.joints).rev() {
            for j in i + 1..self.joints {
                let known = self.link[i][j].of(&b[j]);
                b[i] -= known;
            }
            b[i] = self.link[i][i].of(&b[i]);
        }
        b
    }
}

/// `entry(k)` for each of the first `joints` joints.
fn per_joint<const S: usize, const N: usize, T: Scalar>(
    joints: usize,
    entry: impl Fn(usize) -> Block<S, T>,
) -> [Block<S, T>; N] {
    std::array::from_fn(|k| if k < joints { entry(k) } else { Block::ZERO })
}

/// Coefficients of the scheme times `factor`.
fn times<const S: usize, T: Over<f64>>(block: &Block<S>, factor: T) -> Block<S, T> {
    block.map(|x| factor.scale(x))
}

/// Inverse by Gauss–Jordan elimination with row pivoting.
fn inverse<const S: usize>(a: &Block<S>) -> Block<S> {
    let (mut a, mut inverse) = (*a, Block::identity());
    for j in 0..S {
        let pivot = (j..S).max_by(|&r, &s| a[(r, j)].abs().total_cmp(&a[(s, j)].abs())).unwrap_or(j);
        a.0.swap(j, pivot);
        inverse.0.swap(j, pivot);
        let reciprocal = 1.0 / a[(j, j)];
        for k in 0..S {
            a[(j, k)] *= reciprocal;
            inverse[(j, k)] *= reciprocal;
        }
        for i in (0..S).filter(|&i| i != j) {
            let factor = a[(i, j)];
            for k in 0..S {
                a[(i, k)] -= factor * a[(j, k)];
                inverse[(i, k)] -= factor * inverse[(j, k)];
            }
        }
    }
    inverse
}
