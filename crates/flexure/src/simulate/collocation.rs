//! One step of collocation.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::error_of_defect;
use crate::simulate::ledger::Ledger;
use crate::simulate::local_error::{Torques, Values, estimate};
use crate::simulate::newton::{Anchor, StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};
use crate::simulate::span::{Span, ahead, damping_rate, half, sum};

/// Corrections of this size relative to the speeds of a step are rounding.
const ROUNDING: f64 = 1e-14;

/// So are corrections of this size in rad/s whatever the speeds: at rest, torques of finite size still cancel.
const STILL: f64 = 1e-13;

/// What is left of the corrections is at most this part of rounding.
const NOTHING: f64 = 0.001;

/// Corrections within this factor of rounding do not show how fast they shrink.
const NOISE: f64 = 100.0;

/// Steps that are longer than the last one by more than this factor are not begun with its polynomials.
pub(super) const FARTHEST: f64 = 4.0;

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
        let rate = &damping_rate(plant);
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
            let span = Span { scheme: &self.scheme, plant, x, h, solver, rate };
            let extrapolated = past.stages == S && ratio <= FARTHEST;
            let start = self.start(&span, &u, extrapolated.then_some(&*past));
            let mut solution = if extrapolated {
                self.extrapolated(past, ratio, &start)
            } else {
                StepSolution { link: [start[0]; S], motor: [start[1]; S] }
            };
            past.stages = 0;
            let solved = Self::solve(task, &span, &start, &mut solution, &mut past.contraction, accuracy);
            let Some(stages) = solved else { continue };
            let end = span.end(&solution);
            let work = span.work(&solution, &end, &stages);
            let torques = Torques { stages, end: (task.torque)(task.t + h, &end) };
            let at_start = [self.scheme.start, self.half];
            let values = Values { start: &start, solution: &solution, torques: Some(&torques), at_start };
            let damped = |k: usize| solver.damped[k].error_of_defect;
            let error = estimate::<S, _, S, N, f64>(&span, &span.speeds(&start), &values, damped);
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
        span: &Span<'_, L, S, N>,
        u: &Vector<f64, N>,
        past: Option<&Past<N>>,
    ) -> Sides<N> {
        let Span { plant, x, rate, .. } = *span;
        let Some(past) = past.filter(|_| plant.rotor_coupling.is_none()) else {
            let [a_l, a_m] = plant.accelerations(x, u);
            return [a_l, a_m + rate.diag_mul(&x.v_m)];
        };
        // One correction of what the last step leads to, by its own mass matrix.
        let weights = self.scheme.at(1.0);
        span.start(u, [&past.link, &past.motor].map(|values| sum(&weights, values)))
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
        task: &Task<'_, L, N>,
        span: &Span<'_, L, S, N>,
        start: &Sides<N>,
        solution: &mut StepSolution<S, N>,
        contraction: &mut f64,
        accuracy: f64,
    ) -> Option<[Vector<f64, N>; S]> {
        let Task { t, h, torque, .. } = *task;
        let speeds = span.speeds(start);
        // Corrections below this are rounding of velocities.
        let floor = (ROUNDING * (largest(&speeds[0]) + largest(&speeds[1])) + STILL) / h;
        let felt = span.felt(start);
        let mut torques = [Vector::ZERO; S];
        let (mut previous, mut previous_size) = (f64::INFINITY, f64::INFINITY);
        for iteration in 0..MAX_ITERATIONS {
            let (mut link, mut motor) = ([Stages::ZERO; N], [Stages::ZERO; N]);
            for i in 0..S {
                let motion = span.stage(solution, i);
                let u = torque(t + h * span.scheme.nodes[i], &motion);
                let [missing_l, missing_m] = span.unbalanced(solution, i, &motion, &felt[i], &u);
                for k in 0..N {
                    link[k][i] = missing_l[k];
                    motor[k][i] = missing_m[k];
                }
                torques[i] = u;
            }
            let (link, motor) = span.solver.correction(&link, &motor);
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
        let rate = &rate;
        let span = Span { scheme: &self.scheme, plant: task.plant, x: task.x, h: task.h, solver, rate };
        let values = Values { start, solution, torques: Some(torques), at_start };
        let damped = |k: usize| error_of_defect(&coarser.scheme, task.h * rate[k]);
        estimate::<C, _, S, N, f64>(&span, &span.speeds(start), &values, damped)
    }
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub(crate) fn is_finite<const N: usize>(x: &Motion<f64, N>) -> bool {
    [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|v| v.iter().all(f64::is_finite))
}
