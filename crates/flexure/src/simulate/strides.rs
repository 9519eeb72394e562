//! Several plants moved together, a SIMD lane each, by steps of fixed work.
//!
//! The equations, the iteration matrix and the estimate of the error are those of [`Collocation`](super::collocation::Collocation); what
//! differs is who decides. There errors choose the steps; lanes would choose differently, so here every step has the same length and
//! the same number of corrections, and errors say afterwards, for each lane, whether it can be trusted at the tolerance. What cannot is
//! done again by the [`Integrator`].

mod effort;

use std::array;

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Lane, Lanes, Piecewise, Scalar};

pub(crate) use self::effort::Effort;
pub(crate) use self::effort::likely;
use crate::plant::Plant;
use crate::simulate::collocation::FARTHEST;
use crate::simulate::damped::Damped;
use crate::simulate::gauss::{Integrator, SOLVED};
use crate::simulate::ledger::Ledger;
use crate::simulate::local_error::{Values, estimate};
use crate::simulate::newton::{Anchor, StageSolver, StepSolution};
use crate::simulate::scheme::{Block, Scheme, Stages};
use crate::simulate::span::{Span, ahead, damping_rate, half, weighted};

/// Corrections of this size in rad/s are rounding whatever the speeds: at rest, torques of finite size still cancel.
const STILL: f64 = 1e-13;

/// Corrections more where no polynomials lead on.
const UNKNOWN: usize = 2;

/// Lengths of steps whose coefficients are kept: a delay divides periods in two.
const LENGTHS: usize = 4;

/// `W` plants, a lane each, moved by collocation at `S` points in steps of fixed work.
///
/// For smooth plants without coupled rotors ([`Plant::together`]); springs may harden. Plants with friction, play, hysteresis or coupled
/// rotors stay with the [`Stepper`](super::Stepper), one by one. All lanes have robots of the same kind and the same intervals. What becomes
/// of a lane is a function of that lane's numbers and of the lengths of the intervals, to the last bit: nothing that is computed from
/// one lane is looked at by another.
#[derive(Clone, Debug)]
pub(crate) struct Strides<const S: usize, const N: usize, const W: usize>
where
    f64: Lane<W>,
{
    scheme: Scheme<S>,
    /// What a step of the same length leads on to at the stages, less its end.
    ahead: [Stages<S>; S],
    /// What stage values are multiplied by to have the polynomial at the end of the step.
    at_end: Stages<S>,
    /// What they are multiplied by to have at 0 the polynomial through half as many points.
    half: Stages<S>,
    tolerance: f64,
    effort: Effort,
    /// Iteration matrices, one a length of steps, that of the last step first.
    solvers: Vec<Box<StageSolver<S, N, Lanes<f64, W>>>>,
    /// Steps that the first of them has served.
    served: u32,
    /// Polynomials of the last step; 0 in a lane where they lead on to nothing.
    past: StepSolution<S, N, Lanes<f64, W>>,
    /// Length of the last step in s; 0 before the first.
    last: f64,
}

/// Where an interval leads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strode<const N: usize, const W: usize>
where
    f64: Lane<W>,
{
    pub end: Motion<Lanes<f64, W>, N>,
    pub work: Ledger<Lanes<f64, W>>,
    /// Whether a lane is as accurate as was asked for. Numbers of other lanes are of no use.
    pub trusted: [bool; W],
    /// The largest estimated local error of a step, relative to the speeds of the joints.
    pub error: Lanes<f64, W>,
}

impl<const S: usize, const N: usize, const W: usize> Strides<S, N, W>
where
    f64: Lane<W>,
{
    /// With the tolerated local error of a step, relative to the speeds of the joints.
    pub(crate) fn new(tolerance: f64, effort: Effort) -> Self {
        let scheme = Scheme::gauss();
        Self {
            ahead: ahead(&scheme, 1.0),
            at_end: scheme.at(1.0),
            half: half(&scheme),
            scheme,
            tolerance,
            effort,
            solvers: Vec::with_capacity(LENGTHS),
            served: 0,
            past: StepSolution { link: [Stages::ZERO; N], motor: [Stages::ZERO; N] },
            last: 0.0,
        }
    }

    /// Moves `x` over `interval` s under the constant torque `u_m` [N m]. `plant` is the same one in every call but for pushes.
    pub(crate) fn advance<L: Links<Lanes<f64, W>, N>>(
        &mut self,
        plant: &Plant<L, N, Lanes<f64, W>>,
        x: &Motion<Lanes<f64, W>, N>,
        u_m: &Vector<Lanes<f64, W>, N>,
        interval: f64,
    ) -> Strode<N, W> {
        let h = interval / f64::from(self.effort.parts);
        let mut strode = Strode { end: *x, work: Ledger::ZERO, trusted: [true; W], error: Lanes::ZERO };
        for _ in 0..self.effort.parts {
            self.step(plant, u_m, h, &mut strode);
        }
        strode
    }

    /// The next step has a new iteration matrix: when is a matter of the instant, not of who has been moved before.
    pub(crate) fn renew(&mut self) {
        self.served = self.effort.kept;
    }

    /// Polynomials of this lane lead on to nothing: it has been moved by other means.
    pub(crate) fn forget(&mut self, lane: usize) {
        for value in self.past.link.iter_mut().chain(&mut self.past.motor).flat_map(|v| &mut v.0) {
            put(value, lane, 0.0);
        }
    }

    /// This lane has been moved over the last interval by `integrator`: what its last step leads on to, this leads on to.
    pub(crate) fn resume(&mut self, lane: usize, integrator: &Integrator<N>) {
        let past = &integrator.past;
        let ratio = self.last / past.anchor.h;
        let known = past.stages > 0 && ratio <= FARTHEST;
        if !known {
            return self.forget(lane);
        }
        for i in 0..S {
            // The same instant in that step, whose end is the end of this one.
            let at = 1.0 + (self.scheme.nodes[i] - 1.0) * ratio;
            let weights: Stages<4> = match past.stages {
                2 => {
                    let two = integrator.low.scheme.at(at);
                    Vector([two[0], two[1], 0.0, 0.0])
                }
                _ => integrator.high.scheme.at(at),
            };
            for (own, values) in [(&mut self.past.link, &past.link), (&mut self.past.motor, &past.motor)] {
                for (own, values) in own.iter_mut().zip(values) {
                    put(&mut own[i], lane, weighted(&weights, values));
                }
            }
        }
    }

    fn step<L: Links<Lanes<f64, W>, N>>(
        &mut self,
        plant: &Plant<L, N, Lanes<f64, W>>,
        u_m: &Vector<Lanes<f64, W>, N>,
        h: f64,
        strode: &mut Strode<N, W>,
    ) {
        let x = &strode.end;
        let rate = &damping_rate(plant);
        self.prepare(plant, x, rate, h);
        let Some(solver) = self.solvers.first() else { return };
        let span = Span { scheme: &self.scheme, plant, x, h, solver, rate };
        let ratio = h / self.last;
        // Not of a number, before the first step.
        let led_on = ratio <= FARTHEST;
        if !led_on {
            self.past = StepSolution { link: [Stages::ZERO; N], motor: [Stages::ZERO; N] };
        }
        let past = [&self.past.link, &self.past.motor];
        let led_to = |values: &[Stages<S, Lanes<f64, W>>; N]| {
            let mut led = Vector::ZERO;
            for (led, values) in led.0.iter_mut().zip(values) {
                *led = weighted(&self.at_end, values);
            }
            led
        };
        let start = span.start(u_m, past.map(led_to));
        let other;
        #[expect(clippy::float_cmp, reason = "exactly the same length")]
        let ahead = if ratio == 1.0 || !led_on {
            &self.ahead
        } else {
            other = ahead(&self.scheme, ratio);
            &other
        };
        let [link, motor] = array::from_fn(|side| {
            let mut led = [Stages::ZERO; N];
            for (k, led) in led.iter_mut().enumerate() {
                *led = Vector::from_fn(|i| start[side][k] + weighted(&ahead[i], &past[side][k]));
            }
            led
        });
        let mut solution = StepSolution { link, motor };
        let speeds = span.speeds(&start);
        let felt = span.felt(&start);
        // What a correction counts by: where it is rounding, it is as small as it has to be.
        let accuracy = SOLVED * self.tolerance;
        let unit = speeds
            .map(|speeds| speeds.map(|speed| Lanes::splat(h) / (speed + Lanes::splat(STILL / accuracy))));
        let (mut before, mut size) = (Lanes::ZERO, Lanes::ZERO);
        for _ in 0..self.effort.corrections + if led_on { 0 } else { UNKNOWN } {
            let [mut link, mut motor] = [[Stages::ZERO; N]; 2];
            for i in 0..S {
                let [missing_l, missing_m] = span.unbalanced(&solution, i, &felt, u_m);
                for k in 0..N {
                    link[k][i] = missing_l[k];
                    motor[k][i] = missing_m[k];
                }
            }
            let [link, motor] = solver.correction(&link, &motor);
            (before, size) = (size, Lanes::ZERO);
            for k in 0..plant.robot.links.joints() {
                let (mut of_link, mut of_motor) = (Lanes::ZERO, Lanes::ZERO);
                for i in 0..S {
                    solution.link[k][i] += link[k][i];
                    solution.motor[k][i] += motor[k][i];
                    of_link = of_link.max(link[k][i].abs());
                    of_motor = of_motor.max(motor[k][i].abs());
                }
                size = size.max(unit[0][k] * of_link).max(unit[1][k] * of_motor);
            }
        }
        let end = span.end(&solution);
        let values = Values {
            start: &start,
            solution: &solution,
            torques: None,
            at_start: [self.scheme.start, self.half],
        };
        let error = estimate::<S, _, S, N, Lanes<f64, W>>(&span, &speeds, &values, |k| {
            solver.damped[k].error_of_defect
        });
        strode.work.add(&span.work(&solution, &end, &u_m.0.map(|u| Vector([u; S]))));
        let (each, finite) = ([before, size, error].map(Lanes::to_array), finite(&end));
        strode.trusted = array::from_fn(|w| {
            let [before, size, error] = each.map(|lanes| lanes[w]);
            strode.trusted[w] && is_solved(before, size, accuracy) && error <= self.tolerance && finite[w]
        });
        (strode.end, strode.error) = (end, strode.error.max(error));
        (self.past, self.last) = (solution, h);
    }

    /// Has the iteration matrix for steps of length `h` from `x` be the first.
    fn prepare<L: Links<Lanes<f64, W>, N>>(
        &mut self,
        plant: &Plant<L, N, Lanes<f64, W>>,
        x: &Motion<Lanes<f64, W>, N>,
        rate: &Vector<Lanes<f64, W>, N>,
        h: f64,
    ) {
        let q = [x.q_l, x.q_m];
        #[expect(clippy::float_cmp, reason = "coefficients of another length are others")]
        let known = self.solvers.iter().position(|solver| solver.anchor.h == h);
        match known {
            Some(0) if self.served < self.effort.kept => {}
            Some(found) => {
                self.solvers.swap(0, found);
                self.solvers[0].renew(&self.scheme, plant, q, inverse);
                self.served = 0;
            }
            None => {
                let damped = array::from_fn(|k| {
                    let rates = if k < plant.robot.links.joints() { rate[k].to_array() } else { [0.0; W] };
                    let each = rates.map(|rate| Damped::new(&self.scheme, h * rate));
                    Damped::together(|find| Lanes::from_array(array::from_fn(|w| find(&each[w]))))
                });
                let solver = StageSolver::of(&self.scheme, plant, Anchor { q, h }, damped, inverse);
                self.solvers.truncate(LENGTHS - 1);
                self.solvers.insert(0, Box::new(solver));
                self.served = 0;
            }
        }
        self.served += 1;
    }
}

/// Whether equations are solved whose last two corrections were `before` and `size`: what is left of a correction that shrinks is a part of it,
/// and what was solved before it is solved.
fn is_solved(before: f64, size: f64, accuracy: f64) -> bool {
    size <= accuracy || (size < 0.5 * before && size * size <= accuracy * before)
}

/// Inverse by Gauss–Jordan elimination without pivoting.
fn inverse<const S: usize, T: Scalar>(a: &Block<S, T>) -> Block<S, T> {
    let (mut a, mut inverse) = (*a, Matrix::identity());
    for j in 0..S {
        let reciprocal = a[(j, j)].recip();
        for k in 0..S {
            a[(j, k)] *= reciprocal;
            inverse[(j, k)] *= reciprocal;
        }
        for i in (0..S).filter(|&i| i != j) {
            let factor = a[(i, j)];
            for k in 0..S {
                let (of_a, of_inverse) = (a[(j, k)], inverse[(j, k)]);
                a[(i, k)] -= factor * of_a;
                inverse[(i, k)] -= factor * of_inverse;
            }
        }
    }
    inverse
}

/// Whether the motion of each lane is of finite numbers.
pub(crate) fn finite<const N: usize, const W: usize>(x: &Motion<Lanes<f64, W>, N>) -> [bool; W]
where
    f64: Lane<W>,
{
    let numbers = [&x.q_l, &x.q_m, &x.v_l, &x.v_m].into_iter().flat_map(Vector::iter);
    numbers.fold(Lanes::ZERO, |sum: Lanes<f64, W>, x| sum + x).to_array().map(f64::is_finite)
}

/// The number of one lane.
pub(crate) fn put<const W: usize>(lanes: &mut Lanes<f64, W>, lane: usize, value: f64)
where
    f64: Lane<W>,
{
    let mut each = lanes.to_array();
    each[lane] = value;
    *lanes = Lanes::from_array(each);
}

/// The motion of one lane.
pub(crate) fn taken<const N: usize, const W: usize>(
    x: &Motion<Lanes<f64, W>, N>,
    lane: usize,
) -> Motion<f64, N>
where
    f64: Lane<W>,
{
    let each = |v: &Vector<Lanes<f64, W>, N>| v.map(|x| x.to_array()[lane]);
    Motion { q_l: each(&x.q_l), q_m: each(&x.q_m), v_l: each(&x.v_l), v_m: each(&x.v_m) }
}

/// Has one lane move as `one`.
pub(crate) fn replace<const N: usize, const W: usize>(
    x: &mut Motion<Lanes<f64, W>, N>,
    lane: usize,
    one: &Motion<f64, N>,
) where
    f64: Lane<W>,
{
    let sides =
        [(&mut x.q_l, &one.q_l), (&mut x.q_m, &one.q_m), (&mut x.v_l, &one.v_l), (&mut x.v_m, &one.v_m)];
    for (lanes, one) in sides {
        for (lanes, one) in lanes.0.iter_mut().zip(one.0) {
            put(lanes, lane, one);
        }
    }
}

#[cfg(test)]
mod tests;
