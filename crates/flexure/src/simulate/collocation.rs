//! One step of collocation.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion, Power};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::{Damped, Reach, error_of_defect};
use crate::simulate::ledger::Ledger;
use crate::simulate::local_error::{Values, estimate, speeds};
use crate::simulate::newton::{Anchor, StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};

/// Corrections of this size relative to the speeds of a step are rounding.
const ROUNDING: f64 = 1e-14;

/// So are corrections of this size in rad/s whatever the speeds: at rest, torques of finite size still cancel.
const STILL: f64 = 1e-13;

/// What is left of the corrections is at most this part of rounding.
const NOTHING: f64 = 0.001;

/// Corrections within this factor of rounding do not show how fast they shrink.
const NOISE: f64 = 100.0;

/// Steps that are longer than the last one by more than this factor are not begun with its polynomials.
const FARTHEST: f64 = 4.0;

const MAX_ITERATIONS: usize = 25;

/// Corrections that no longer shrink are rounding if they are within this factor of the floor: residuals are
/// differences of torques that can be much larger than what accelerates the joint.
const STALL: f64 = 1e4;

/// What corrections are believed to shrink by with a new iteration matrix, until it is seen.
const FRESH: f64 = 0.02;

/// An iteration matrix whose corrections shrink less than this is made anew.
const WORN: f64 = 0.05;

/// A solved step.
#[derive(Clone, Copy)]
pub(crate) struct Step<const S: usize, const N: usize> {
    pub(crate) end: Motion<f64, N>,
    pub(crate) work: Ledger,
    /// What accelerates links and motors at the start.
    pub(crate) start: Sides<N>,
    pub(crate) solution: StepSolution<S, N>,
    pub(crate) torques: Torques<S, N>,
    /// Estimated local error, relative to the speeds of the joints.
    pub(crate) error: f64,
}

/// Motor torques at the stages and at the end of a step [N m].
#[derive(Clone, Copy)]
pub(crate) struct Torques<const S: usize, const N: usize> {
    pub(super) stages: [Vector<f64, N>; S],
    pub(super) end: Vector<f64, N>,
}

/// What a step leaves for the next: where its iteration matrix was made and how it converges, and its polynomials.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Past<const N: usize> {
    pub(crate) anchor: Anchor<N>,
    /// What the last corrections shrank by.
    pub(crate) contraction: f64,
    /// Number of stages of the polynomials; none are known if 0.
    pub(crate) stages: usize,
    /// The polynomials at the stages: links, motors. Those beyond the number of stages are 0.
    pub(crate) link: [Vector<f64, N>; 4],
    pub(crate) motor: [Vector<f64, N>; 4],
}

impl<const N: usize> Past<N> {
    /// Nothing.
    pub(crate) const NONE: Self = Self {
        anchor: Anchor { q: [Vector::ZERO; 2], h: 0.0 },
        contraction: 1.0,
        stages: 0,
        link: [Vector::ZERO; 4],
        motor: [Vector::ZERO; 4],
    };
}

/// Collocation at `S` points: its scheme and the iteration matrix of the last steps, which the anchor of the [`Past`] restores.
#[derive(Clone, Debug)]
pub(crate) struct Collocation<const S: usize, const N: usize> {
    pub(crate) scheme: Scheme<S>,
    /// What a step of the same length leads on to at the stages, less its end.
    ahead: [Stages<S>; S],
    /// What stage values are multiplied by to have at 0 the polynomial through half as many points.
    half: Stages<S>,
    solver: Option<Box<StageSolver<S, N>>>,
}

/// What is moved, from where, when, how far, and under which torque.
pub(crate) struct Task<'a, L, const N: usize> {
    pub(crate) plant: &'a Plant<L, N>,
    pub(crate) x: &'a Motion<f64, N>,
    pub(crate) t: f64,
    pub(crate) h: f64,
    pub(crate) torque: &'a dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
}

impl<const S: usize, const N: usize> Collocation<S, N> {
    pub(crate) fn new() -> Self {
        let scheme = Scheme::gauss();
        Self { ahead: ahead(&scheme, 1.0), half: half(&scheme), scheme, solver: None }
    }

    /// A step whose equations are solved to `accuracy`, relative to the speeds; none if they cannot be solved in finite numbers.
    pub(crate) fn step<L: Links<f64, N>>(
        &mut self,
        task: &Task<'_, L, N>,
        past: &mut Past<N>,
        accuracy: f64,
    ) -> Option<Step<S, N>> {
        let Task { plant, x, h, .. } = *task;
        let u = (task.torque)(task.t, x);
        // Where a matrix from some way back does not lead on, one from here may.
        let here = Anchor { q: [x.q_l, x.q_m], h };
        let ratio = h / past.anchor.h;
        #[expect(clippy::float_cmp, reason = "a matrix of another length is another one")]
        let fresh = past.stages != S || past.anchor.h != h || past.contraction > WORN;
        let anchors = [(!fresh).then_some(past.anchor), Some(here)];
        for anchor in anchors.into_iter().flatten() {
            if anchor == here {
                (past.anchor, past.contraction) = (here, FRESH);
            }
            if self.solver.as_ref().is_none_or(|solver| solver.anchor != anchor) {
                self.solver = Some(Box::new(StageSolver::new(&self.scheme, plant, anchor)));
            }
            let Some(solver) = self.solver.as_deref() else { break };
            let extrapolated = past.stages == S && ratio <= FARTHEST;
            let start = self.start(task, &u, solver, extrapolated.then_some(&*past));
            let mut solution = if extrapolated {
                self.extrapolated(past, ratio, &start)
            } else {
                StepSolution { link: [start[0]; S], motor: [start[1]; S] }
            };
            past.stages = 0;
            let solved = self.solve(task, solver, &start, &mut solution, &mut past.contraction, accuracy);
            let Some(stages) = solved else { continue };
            let end = self.end(x, h, solver, &solution);
            let work = self.work(task, solver, &solution, &end, &stages);
            let torques = Torques { stages, end: (task.torque)(task.t + h, &end) };
            let error = self.error(task, solver, &start, &solution, &torques);
            if is_finite(&end) {
                past.stages = S;
                past.link[..S].copy_from_slice(&solution.link);
                past.motor[..S].copy_from_slice(&solution.motor);
                return Some(Step { end, work, start, solution, torques, error });
            }
        }
        None
    }

    /// What accelerates links and motors at the start under the torque `u`.
    fn start<L: Links<f64, N>>(
        &self,
        task: &Task<'_, L, N>,
        u: &Vector<f64, N>,
        solver: &StageSolver<S, N>,
        past: Option<&Past<N>>,
    ) -> Sides<N> {
        let Task { plant, x, .. } = *task;
        let rate = damping_rate(plant);
        let of_damper = rate.diag_mul(&x.v_m);
        let Some(past) = past.filter(|_| plant.rotor_coupling.is_none()) else {
            let [a_l, a_m] = plant.accelerations(x, u);
            return [a_l, a_m + of_damper];
        };
        // One correction of what the last step leads to, by its own mass matrix.
        let weights = self.scheme.at(1.0);
        let [a_l, f] = [&past.link, &past.motor].map(|values| sum(&weights, values));
        let [link, motor] = plant.unbalanced(x, u, [a_l, f - of_damper]);
        let inertia = &plant.robot.motor_inertia;
        [a_l + solver.mass.solve(&link), Vector::from_fn(|k| f[k] + motor[k] / inertia[k])]
    }

    /// The polynomials of the last step, `ratio` times shorter than this one, led on and shifted to what they are at the start of this one.
    fn extrapolated(&self, past: &Past<N>, ratio: f64, start: &Sides<N>) -> StepSolution<S, N> {
        #[expect(clippy::float_cmp, reason = "exactly the same length")]
        let ahead = if ratio == 1.0 { self.ahead } else { ahead(&self.scheme, ratio) };
        let on = |values: &[Vector<f64, N>; 4], start: &Vector<f64, N>| {
            ahead.map(|weights| *start + sum(&weights, values))
        };
        StepSolution { link: on(&past.link, &start[0]), motor: on(&past.motor, &start[1]) }
    }

    /// Solves the stage equations and gives the torques at the stages; none if they cannot be solved.
    fn solve<L: Links<f64, N>>(
        &self,
        task: &Task<'_, L, N>,
        solver: &StageSolver<S, N>,
        start: &Sides<N>,
        solution: &mut StepSolution<S, N>,
        contraction: &mut f64,
        accuracy: f64,
    ) -> Option<[Vector<f64, N>; S]> {
        let Task { plant, x, t, h, torque } = *task;
        let rate = damping_rate(plant);
        let speeds = speeds(x, h, solver, start);
        // Corrections below this are rounding of velocities.
        let floor = (ROUNDING * (largest(&speeds[0]) + largest(&speeds[1])) + STILL) / h;
        let felt = felt(x, &rate, solver, start);
        let mut torques = [Vector::ZERO; S];
        let (mut previous, mut previous_size) = (f64::INFINITY, f64::INFINITY);
        for iteration in 0..MAX_ITERATIONS {
            let (mut link, mut motor) = ([Stages::ZERO; N], [Stages::ZERO; N]);
            for i in 0..S {
                let motion = self.stage(x, h, solver, solution, i);
                let u = torque(t + h * self.scheme.nodes[i], &motion);
                let motion = Motion { q_m: motion.q_m + felt[i], ..motion };
                let a_m = solution.motor[i] - rate.diag_mul(&motion.v_m);
                let [missing_l, missing_m] = plant.unbalanced(&motion, &u, [solution.link[i], a_m]);
                for k in 0..N {
                    link[k][i] = missing_l[k];
                    motor[k][i] = missing_m[k];
                }
                torques[i] = u;
            }
            let (link, motor) = solver.correction(&link, &motor);
            // The largest correction as it is, and relative to the speed of its joint.
            let (mut worst, mut size, mut total) = (0.0_f64, 0.0_f64, 0.0);
            for k in 0..N {
                let (mut of_link, mut of_motor) = (0.0_f64, 0.0_f64);
                for i in 0..S {
                    solution.link[i][k] += link[k][i];
                    solution.motor[i][k] += motor[k][i];
                    of_link = of_link.max(link[k][i].abs());
                    of_motor = of_motor.max(motor[k][i].abs());
                    total += link[k][i] + motor[k][i];
                }
                worst = worst.max(of_link).max(of_motor);
                size = size.max(h * of_link / speeds[0][k]).max(h * of_motor / speeds[1][k]);
            }
            // NaN does not win a maximum.
            if !total.is_finite() {
                return None;
            }
            let stalled = iteration > 3 && worst > 0.5 * previous;
            // Rounding is what is left of the corrections, not what they are: an old matrix leaves more of them.
            let rounded = worst <= floor && worst * *contraction <= NOTHING * floor;
            if rounded || (stalled && worst <= STALL * floor) {
                return Some(torques);
            }
            if stalled && worst > previous {
                return None;
            }
            // Quotients of rounding errors say nothing.
            let rate = if iteration > 0 { size / previous_size } else { *contraction };
            if iteration > 0 && worst > NOISE * floor {
                *contraction = rate;
            }
            if rate < 0.5 && size * rate <= accuracy {
                // What was not seen again for a while may have become worse.
                if iteration == 0 {
                    *contraction *= 1.25;
                }
                return Some(torques);
            }
            (previous, previous_size) = (worst, size);
        }
        None
    }

    /// Position and velocity at stage `i`.
    #[inline]
    fn stage(
        &self,
        x: &Motion<f64, N>,
        h: f64,
        solver: &StageSolver<S, N>,
        solution: &StepSolution<S, N>,
        i: usize,
    ) -> Motion<f64, N> {
        let Scheme { nodes, once, twice, .. } = &self.scheme;
        moved(x, h, nodes[i], &once.row(i), &twice.row(i), |k| &solver.damped[k].stages[i], solution)
    }

    fn end(
        &self,
        x: &Motion<f64, N>,
        h: f64,
        solver: &StageSolver<S, N>,
        solution: &StepSolution<S, N>,
    ) -> Motion<f64, N> {
        let Scheme { weights, end_twice, .. } = &self.scheme;
        moved(x, h, 1.0, weights, end_twice, |k| &solver.damped[k].end, solution)
    }

    /// The work of the step. What dampers of motors take is what their torques give and their kinetic energy does not keep: exactly
    /// what it is for speeds that are exponentials.
    fn work<L: Links<f64, N>>(
        &self,
        task: &Task<'_, L, N>,
        solver: &StageSolver<S, N>,
        solution: &StepSolution<S, N>,
        end: &Motion<f64, N>,
        torques: &[Vector<f64, N>; S],
    ) -> Ledger {
        let Task { plant, x, h, .. } = *task;
        let robot = &plant.robot;
        let mut work = Ledger::default();
        let mut supplied = Stages::<S>::ZERO;
        for (k, damped) in solver.damped.iter().enumerate().take(robot.links.joints()) {
            let Damped { work: of_f, work_of_speed, .. } = damped;
            let f = Vector::from_fn(|i| solution.motor[i][k]);
            let turned = (work_of_speed.scaled(x.v_m[k]) + (*of_f * f).scaled(h)).scaled(h);
            supplied += Vector::from_fn(|i| torques[i][k] * turned[i]);
            if robot.motor_damping[k] > 0.0 {
                let kept = 0.5 * (end.v_m[k] - x.v_m[k]) * (end.v_m[k] + x.v_m[k]);
                work.dissipated += robot.motor_inertia[k] * (f.dot(&turned) - kept);
            }
        }
        for i in 0..S {
            let mut v_l = x.v_l;
            for (a, weight) in solution.link.iter().zip(self.scheme.once.row(i).iter()) {
                v_l += a.scaled(h * weight);
            }
            let seconds = h * self.scheme.weights[i];
            let pushed = supplied[i] + seconds * v_l.dot(&plant.external);
            let dissipated = seconds * v_l.dot(&robot.link_damping.diag_mul(&v_l));
            work.book(1.0, &Power { supplied: pushed, dissipated });
        }
        work
    }

    /// The estimated local error, relative to the speeds of the joints.
    fn error<L: Links<f64, N>>(
        &self,
        task: &Task<'_, L, N>,
        solver: &StageSolver<S, N>,
        start: &Sides<N>,
        solution: &StepSolution<S, N>,
        torques: &Torques<S, N>,
    ) -> f64 {
        let values = Values { start, solution, torques, at_start: [self.scheme.start, self.half] };
        estimate::<S, S, L, N>(task, solver, &values, |k| solver.damped[k].error_of_defect)
    }

    /// The error that a step of half as many stages, those of `coarser`, would have had where this one was.
    pub(crate) fn error_of_coarser<L: Links<f64, N>, const C: usize>(
        &self,
        task: &Task<'_, L, N>,
        coarser: &Collocation<C, N>,
        step: &Step<S, N>,
    ) -> f64 {
        let Some(solver) = self.solver.as_deref() else { return f64::INFINITY };
        let through = |weights: &Stages<C>| {
            let nodes = coarser.scheme.nodes.iter().zip(weights.iter());
            nodes.fold(Stages::ZERO, |sum: Stages<S>, (node, weight)| {
                sum + self.scheme.at(node).scaled(weight)
            })
        };
        let at_start = [through(&coarser.scheme.start), through(&coarser.half)];
        let Step { start, solution, torques, .. } = step;
        let rate = damping_rate(task.plant);
        let values = Values { start, solution, torques, at_start };
        estimate::<C, S, L, N>(task, solver, &values, |k| error_of_defect(&coarser.scheme, task.h * rate[k]))
    }
}

/// What stage values are multiplied by to have the value at 0 of the polynomial through their polynomial at the points of half as many
/// stages.
fn half<const S: usize>(scheme: &Scheme<S>) -> Stages<S> {
    if S < 4 {
        return scheme.at(0.5);
    }
    let coarse = Scheme::<2>::gauss();
    let nodes = coarse.nodes.iter().zip(coarse.start.iter());
    nodes.fold(Stages::ZERO, |sum, (node, weight)| sum + scheme.at(node).scaled(weight))
}

/// What stage values are multiplied by to have their polynomial at the stages of the next step, `ratio` times longer, less its end.
fn ahead<const S: usize>(scheme: &Scheme<S>, ratio: f64) -> [Stages<S>; S] {
    std::array::from_fn(|i| scheme.at(1.0 + ratio * scheme.nodes[i]) - scheme.at(1.0))
}

/// λ = D_m / M_m per motor [1/s].
#[inline]
fn damping_rate<L, const N: usize>(plant: &Plant<L, N>) -> Vector<f64, N> {
    Vector::from_fn(|k| plant.robot.motor_damping[k] / plant.robot.motor_inertia[k])
}

/// What springs feel of the motors at the stages beside their positions there: speeds that are damped within the step, in the mean.
fn felt<const S: usize, const N: usize>(
    x: &Motion<f64, N>,
    rate: &Vector<f64, N>,
    solver: &StageSolver<S, N>,
    start: &Sides<N>,
) -> [Vector<f64, N>; S] {
    let mut felt = [Vector::ZERO; S];
    for (k, Damped { excess, .. }) in solver.damped.iter().enumerate() {
        if *excess != Stages::ZERO {
            // Of q_m(t), −e^(−λ t) times this.
            let faded = (x.v_m[k] - start[1][k] / rate[k]) / rate[k];
            for (felt, excess) in felt.iter_mut().zip(excess.iter()) {
                felt[k] = -faded * excess;
            }
        }
    }
    felt
}

#[inline]
fn sum<const S: usize, const N: usize>(weights: &Stages<S>, values: &[Vector<f64, N>]) -> Vector<f64, N> {
    let mut total = Vector::ZERO;
    for (w, value) in weights.iter().zip(values) {
        total += value.scaled(w);
    }
    total
}

/// `x` moved to the instant `at` of a step: links by quadrature weights for velocity and position, motors under their dampers.
#[inline]
fn moved<'a, const S: usize, const N: usize>(
    x: &Motion<f64, N>,
    h: f64,
    at: f64,
    once: &Stages<S>,
    twice: &Stages<S>,
    reach: impl Fn(usize) -> &'a Reach<S>,
    StepSolution { link, motor }: &StepSolution<S, N>,
) -> Motion<f64, N> {
    let mut end = Motion {
        q_l: x.q_l + (x.v_l.scaled(at) + sum(twice, link).scaled(h)).scaled(h),
        q_m: x.q_m,
        v_l: x.v_l + sum(once, link).scaled(h),
        v_m: x.v_m,
    };
    for k in 0..N {
        let Reach { decay, drift, once, twice } = reach(k);
        let (mut speed, mut position) = (0.0, 0.0);
        for (f, (once, twice)) in motor.iter().zip(once.iter().zip(twice.iter())) {
            speed += once * f[k];
            position += twice * f[k];
        }
        end.v_m[k] = decay * x.v_m[k] + h * speed;
        end.q_m[k] = x.q_m[k] + h * (drift * x.v_m[k] + h * position);
    }
    end
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub(crate) fn is_finite<const N: usize>(x: &Motion<f64, N>) -> bool {
    [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|v| v.iter().all(f64::is_finite))
}
