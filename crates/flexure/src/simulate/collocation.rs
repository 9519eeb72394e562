//! One step of collocation. The stages of one robot go through its dynamics side by side, a SIMD lane each: to lanes one robot at several
//! instants is several robots.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Lane, Lanes, Over as _, Piecewise as _, Scalar as _};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::error_of_defect;
use crate::simulate::ledger::Ledger;
use crate::simulate::local_error::{Torques, Values, estimate};
use crate::simulate::newton::{Anchor, Lengths, StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};
use crate::simulate::span::{EachAtStages, Span, ahead, damping_rate, half, weighted};

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
    /// The polynomials at the stages, a joint each: links, motors. What is beyond the number of stages is 0.
    pub(crate) link: [Stages<4>; N],
    pub(crate) motor: [Stages<4>; N],
}

impl<const N: usize> Past<N> {
    /// Nothing.
    pub(crate) const NONE: Self = Self {
        anchor: Anchor { q: [Vector::ZERO; 2], h: 0.0 },
        contraction: 1.0,
        stages: 0,
        link: [Stages::ZERO; N],
        motor: [Stages::ZERO; N],
    };
}

/// Collocation at `S` points: its scheme and the iteration matrix of the last steps, which the anchor of the [`Past`] restores.
#[derive(Clone, Debug)]
pub(crate) struct Collocation<const S: usize, const N: usize> {
    pub(crate) scheme: Scheme<S>,
    /// What a step of the same length leads on to at the stages, less its end.
    ahead: [Stages<S>; S],
    /// What stage values are multiplied by to have their polynomial at the end.
    at_end: Stages<S>,
    /// What stage values are multiplied by to have at 0 the polynomial through half as many points.
    half: Stages<S>,
    solver: Option<Box<StageSolver<S, N>>>,
    lengths: Lengths<S, N>,
    /// Damping rates of the motors that it is for [1/s].
    rate: Vector<f64, N>,
    /// Length of a step in s, and what [`error_of_defect`] is for that length and half as many stages, a motor each.
    of_coarser: (f64, [f64; N]),
}

/// What is moved, from where, when, how far, and under which torque.
pub(crate) struct Task<'a, L, const N: usize> {
    pub(crate) plant: &'a Plant<L, N>,
    pub(crate) x: &'a Motion<f64, N>,
    pub(crate) t: f64,
    pub(crate) h: f64,
    pub(crate) torque: &'a dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
}

impl<const S: usize, const N: usize> Collocation<S, N>
where
    f64: Lane<S>,
{
    pub(crate) fn new() -> Self {
        let scheme = Scheme::gauss();
        Self {
            ahead: ahead(&scheme, 1.0),
            at_end: scheme.at(1.0),
            half: half(&scheme),
            scheme,
            solver: None,
            lengths: Lengths::default(),
            rate: Vector::ZERO,
            of_coarser: (0.0, [0.0; N]),
        }
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
        if self.rate != *rate {
            (self.rate, self.solver, self.of_coarser.0) = (*rate, None, 0.0);
            self.lengths.clear();
        }
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
            match &mut self.solver {
                Some(solver) if solver.anchor == anchor => {}
                Some(solver) => solver.move_to(&self.scheme, plant, anchor, &mut self.lengths),
                None => self.solver = Some(Box::new(StageSolver::new(&self.scheme, plant, anchor))),
            }
            let Some(solver) = self.solver.as_deref() else { break };
            let span = Span { scheme: &self.scheme, plant, x, h, solver, rate };
            let extrapolated = past.stages == S && ratio <= FARTHEST;
            let start = self.start(&span, &u, extrapolated.then_some(&*past));
            let mut solution = if extrapolated {
                self.extrapolated(past, ratio, &start)
            } else {
                let [link, motor] = start.map(|side| side.0.map(|value| Vector([value; S])));
                StepSolution { link, motor }
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
                for (past, solved) in [(&mut past.link, &solution.link), (&mut past.motor, &solution.motor)] {
                    for (past, solved) in past.iter_mut().zip(solved) {
                        past.0[..S].copy_from_slice(&solved.0);
                    }
                }
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
        let weights = &self.at_end;
        let led_to =
            |values: &[Stages<4>; N]| Vector(values.map(|values| weighted(weights, &first(&values))));
        span.start(u, [led_to(&past.link), led_to(&past.motor)])
    }

    /// The polynomials of the last step, `ratio` times shorter than this one, led on and shifted to what they are at the start of this one.
    fn extrapolated(&self, past: &Past<N>, ratio: f64, start: &Sides<N>) -> StepSolution<S, N> {
        #[expect(clippy::float_cmp, reason = "exactly the same length")]
        let ahead = if ratio == 1.0 { self.ahead } else { ahead(&self.scheme, ratio) };
        let on = |values: &[Stages<4>; N], start: &Vector<f64, N>| {
            let mut led = [Stages::ZERO; N];
            for (led, (values, start)) in led.iter_mut().zip(values.iter().zip(start.iter())) {
                let values = first(values);
                *led = Vector::from_fn(|i| start + weighted(&ahead[i], &values));
            }
            led
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
    ) -> Option<EachAtStages<S, N>> {
        let Task { t, h, torque, .. } = *task;
        let speeds = span.speeds(start);
        // Corrections below this are rounding of velocities.
        let floor = (ROUNDING * (largest(&speeds[0]) + largest(&speeds[1])) + STILL) / h;
        let felt = span.felt(start);
        // What corrections count by.
        let unit = speeds.map(|side| side.map(|speed| h / speed));
        let mut found = in_lanes(solution);
        let (mut previous, mut previous_size) = (f64::INFINITY, f64::INFINITY);
        for iteration in 0..MAX_ITERATIONS {
            let motion = span.lanes(&found);
            let torques = at_stages(&motion, |i, motion| torque(t + h * span.scheme.nodes[i], motion));
            let [link, motor] = span.unbalanced_at_once(&found, &motion, &felt, &torques);
            let corrections = span.solver.correction(&link.0, &motor.0);
            // The largest correction as it is, and relative to the speed of its joint.
            let [mut worst, mut size, mut total] = [Lanes::ZERO; 3];
            for (side, (found, corrections)) in found.iter_mut().zip(&corrections).enumerate() {
                for (k, (found, correction)) in found.iter_mut().zip(corrections).enumerate() {
                    *found += *correction;
                    let magnitude = correction.abs();
                    worst = worst.max(magnitude);
                    size = size.max(magnitude.scale(unit[side][k]));
                    total += *correction;
                }
            }
            let [worst, size] = [worst, size].map(|each| each.to_array().into_iter().fold(0.0, f64::max));
            let total: f64 = total.to_array().iter().sum();
            // NaN does not win a maximum.
            if !total.is_finite() {
                return None;
            }
            let stalled = iteration > 3 && worst > 0.5 * previous;
            // Rounding is what is left of the corrections, not what they are: an old matrix leaves more of them.
            let rounded = worst <= floor && worst * *contraction <= NOTHING * floor;
            if rounded || (stalled && worst <= STALL * floor) {
                return Some(solved(solution, &found, &torques));
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
                return Some(solved(solution, &found, &torques));
            }
            (previous, previous_size) = (worst, size);
        }
        None
    }

    /// The error that a step of half as many stages, those of `coarser`, would have had where this one was.
    pub(crate) fn error_of_coarser<L: Links<f64, N>, const C: usize>(
        &mut self,
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
        #[expect(clippy::float_cmp, reason = "coefficients of another length are others")]
        if self.of_coarser.0 != task.h {
            self.of_coarser = (task.h, rate.map(|rate| error_of_defect(&coarser.scheme, task.h * rate)).0);
        }
        estimate::<C, _, S, N, f64>(&span, &span.speeds(start), &values, |k| self.of_coarser.1[k])
    }
}

/// The numbers of links and motors at the stages, a lane each.
fn in_lanes<const S: usize, const N: usize>(solution: &StepSolution<S, N>) -> [[Lanes<f64, S>; N]; 2]
where
    f64: Lane<S>,
{
    let StepSolution { link, motor } = solution;
    [link, motor].map(|side| side.map(|stages| Lanes::from_array(stages.0)))
}

/// The torque that `torque` gives at each stage, told which and the motion there.
fn at_stages<const S: usize, const N: usize>(
    motion: &Motion<Lanes<f64, S>, N>,
    torque: impl Fn(usize, &Motion<f64, N>) -> Vector<f64, N>,
) -> Vector<Lanes<f64, S>, N>
where
    f64: Lane<S>,
{
    let Motion { q_l, q_m, v_l, v_m } = motion;
    let [q_l, q_m, v_l, v_m] = [q_l, q_m, v_l, v_m].map(|each| each.map(Lanes::to_array));
    let torques: [Vector<f64, N>; S] = std::array::from_fn(|i| {
        let at = |each: &Vector<[f64; S], N>| Vector::from_fn(|k| each[k][i]);
        torque(i, &Motion { q_l: at(&q_l), q_m: at(&q_m), v_l: at(&v_l), v_m: at(&v_m) })
    });
    Vector::from_fn(|k| Lanes::from_array(std::array::from_fn(|i| torques[i][k])))
}

/// Writes what was found to `solution`, and gives the torques.
fn solved<const S: usize, const N: usize>(
    solution: &mut StepSolution<S, N>,
    [link, motor]: &[[Lanes<f64, S>; N]; 2],
    torques: &Vector<Lanes<f64, S>, N>,
) -> EachAtStages<S, N>
where
    f64: Lane<S>,
{
    let stages = |side: &[Lanes<f64, S>; N]| side.map(|stages| Vector(stages.to_array()));
    *solution = StepSolution { link: stages(link), motor: stages(motor) };
    stages(&torques.0)
}

/// Those of the first stages.
fn first<const S: usize>(values: &Stages<4>) -> Stages<S> {
    Vector::from_fn(|i| values[i])
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub(crate) fn is_finite<const N: usize>(x: &Motion<f64, N>) -> bool {
    [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|v| v.iter().all(f64::is_finite))
}
