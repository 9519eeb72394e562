//! Gauss–Legendre collocation of order 8 for flexible-joint plants.
//!
//! Symplectic, so that an undamped robot neither gains nor loses energy systematically; A-stable, so that a motor
//! damper of 9000 1/s or a stiff spring on a light wrist cannot blow up; and of high order, so that fast transients
//! are resolved rather than damped away. The stage equations are solved for accelerations in torque form, which
//! needs inverse dynamics only. Hairer, Lubich & Wanner, *Geometric Numerical Integration*, chapters II and VI.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::{Plant, Sides};
use crate::simulate::ledger::Ledger;
use crate::simulate::newton::StageSolver;
use crate::simulate::scheme::{STAGES, Scheme, Stages};

/// A step that cannot be made: the state or the torque is not finite, or the step would have to be too small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFailure {
    /// Time into the interval at which it happened in s.
    pub after: f64,
}

/// Integrates a plant over intervals, with steps chosen for accuracy.
#[derive(Clone, Debug)]
pub struct Integrator {
    pub(crate) scheme: Scheme,
    /// Tolerated local error of a step, relative to the speed of the joint.
    pub(crate) tolerance: f64,
    /// Last good step in s: the first guess for the next.
    pub(crate) step: f64,
    pub(crate) steps: u64,
}

/// Speed [rad/s] below which errors count as absolute.
const SLOW: f64 = 1e-3;

/// Steps of this fraction of the interval are taken whatever their error: a torque that jumps cannot be resolved, only
/// stepped across.
const SHORTEST: f64 = 1e-5;

/// More steps than this in one interval are a failure: a run ends in bounded time whatever happens in it.
const MOST_STEPS: u32 = 200_000;

/// Corrections of this size relative to the speeds of a step are rounding.
const ROUNDING: f64 = 1e-14;

/// So are corrections of this size in rad/s whatever the speeds: at rest, torques of finite size still cancel.
const STILL: f64 = 1e-13;

/// A solved step.
#[derive(Clone, Copy)]
struct Step<const N: usize> {
    end: Motion<f64, N>,
    work: Ledger,
    /// By how much the step could have been longer; below 1 it was too long.
    factor: f64,
}

/// The collocation polynomial of one step: accelerations at the stages.
pub(crate) struct StepSolution<const N: usize> {
    pub(crate) link: [Vector<f64, N>; STAGES],
    pub(crate) motor: [Vector<f64, N>; STAGES],
}

impl Integrator {
    /// With a tolerated local error relative to the joint speeds; 1e-10 is a good start.
    pub fn new(tolerance: f64) -> Self {
        Self { scheme: Scheme::gauss(), tolerance, step: f64::INFINITY, steps: 0 }
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Moves `x` over `[t, t + interval]` under the torque `u_m(t, x)` and books the work in `ledger`.
    ///
    /// # Errors
    /// [`StepFailure`] if the solution leaves the finite numbers or the stage equations cannot be solved: the loop
    /// diverged, or its torque is no function of the state.
    pub fn advance<L: Links<f64, N>, const N: usize>(
        &mut self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        t: f64,
        interval: f64,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
        ledger: &mut Ledger,
    ) -> Result<Motion<f64, N>, StepFailure> {
        let mut done = 0.0;
        let shortest = SHORTEST * interval;
        for _ in 0..MOST_STEPS {
            // Equal steps to the end of the interval, of at most the length that is good now.
            let remaining = steps_in(interval - done, self.step);
            let h = (interval - done) / f64::from(remaining);
            match self.try_step(plant, &x, t + done, h, torque) {
                Some(step) if step.factor >= 1.0 || h <= shortest => {
                    x = step.end;
                    ledger.add(&step.work);
                    self.steps += 1;
                    self.step = (h * step.factor.min(2.0)).max(shortest);
                    if remaining == 1 {
                        return Ok(x);
                    }
                    done += h;
                }
                Some(step) => self.step = (h * step.factor.clamp(0.1, 0.9)).max(shortest),
                None if h > shortest => self.step = (0.5 * h).max(shortest),
                None => break,
            }
        }
        Err(StepFailure { after: done })
    }

    /// Moves `x` by `count` equal steps whatever their error: for convergence studies.
    ///
    /// # Errors
    /// [`StepFailure`] if the stage equations of a step cannot be solved.
    pub fn advance_uniformly<L: Links<f64, N>, const N: usize>(
        &mut self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        interval: f64,
        count: u32,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
    ) -> Result<Motion<f64, N>, StepFailure> {
        let h = interval / f64::from(count);
        for i in 0..count {
            let t = h * f64::from(i);
            x = self.try_step(plant, &x, t, h, torque).ok_or(StepFailure { after: t })?.end;
            self.steps += 1;
        }
        Ok(x)
    }

    /// A step of `h`; none if its stage equations cannot be solved in finite numbers.
    fn try_step<L: Links<f64, N>, const N: usize>(
        &self,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        t: f64,
        h: f64,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
    ) -> Option<Step<N>> {
        let start = plant.accelerations(x, &torque(t, x));
        let at_stage = |i: usize, solution: &StepSolution<N>| {
            let motion = self.stage(x, h, solution, i);
            let u = torque(t + h * self.scheme.nodes[i], &motion);
            (motion, u)
        };
        let mut solution = StepSolution { link: [start[0]; STAGES], motor: [start[1]; STAGES] };
        // Corrections below this are rounding of velocities.
        let speeds = largest(&x.v_l) + largest(&x.v_m) + h * (largest(&start[0]) + largest(&start[1]));
        let floor = ROUNDING * speeds + STILL;
        StageSolver::new(&self.scheme, plant, x, h).solve(plant, &mut solution, floor / h, at_stage)?;

        let mut work = Ledger::default();
        for i in 0..STAGES {
            let (motion, u) = at_stage(i, &solution);
            work.book(h * self.scheme.weights[i], &plant.power(&motion, &u));
        }
        let end = self.end_of_step(x, h, &solution);
        let factor = self.step_factor(x, h, &start, &solution);
        is_finite(&end).then_some(Step { end, work, factor })
    }

    /// Position and velocity at stage `i`.
    #[inline]
    fn stage<const N: usize>(
        &self,
        x: &Motion<f64, N>,
        h: f64,
        solution: &StepSolution<N>,
        i: usize,
    ) -> Motion<f64, N> {
        let scheme = &self.scheme;
        moved(x, h, scheme.nodes[i], &scheme.once.row(i), &scheme.twice.row(i), solution)
    }

    fn end_of_step<const N: usize>(
        &self,
        x: &Motion<f64, N>,
        h: f64,
        solution: &StepSolution<N>,
    ) -> Motion<f64, N> {
        moved(x, h, 1.0, &self.scheme.weights, &self.scheme.end_twice, solution)
    }

    /// How much longer the step may be. The defect of the collocation polynomial at the start, a difference of
    /// accelerations of order h⁴, gives a velocity error of order h⁵; the true local error is of order h⁹, so in units
    /// of the tolerance the defect may be its 5/9 power.
    fn step_factor<const N: usize>(
        &self,
        x: &Motion<f64, N>,
        h: f64,
        start: &Sides<N>,
        solution: &StepSolution<N>,
    ) -> f64 {
        let defect = |v: &Vector<f64, N>, a: &Vector<f64, N>, stages: &[Vector<f64, N>; STAGES]| {
            (0..N).fold(0.0, |worst: f64, k| {
                let extrapolated: f64 = (0..STAGES).map(|i| self.scheme.start[i] * stages[i][k]).sum();
                let speed = stages.iter().fold(v[k].abs(), |m, a| m.max(h * a[k].abs())) + SLOW;
                worst.max(h * (a[k] - extrapolated).abs() / speed)
            })
        };
        let worst = defect(&x.v_l, &start[0], &solution.link).max(defect(&x.v_m, &start[1], &solution.motor));
        let allowed = self.tolerance.powf(5.0 / 9.0);
        // A margin of 0.8 when lengthening keeps the next step from being rejected.
        let factor = (allowed / worst).powf(0.2);
        if factor >= 1.25 {
            0.8 * factor
        } else if factor >= 1.0 {
            1.0
        } else {
            0.8 * factor
        }
    }
}

/// `x` moved to the instant `at` of a step by quadrature weights for velocity and position.
#[inline]
fn moved<const N: usize>(
    x: &Motion<f64, N>,
    h: f64,
    at: f64,
    once: &Stages,
    twice: &Stages,
    solution: &StepSolution<N>,
) -> Motion<f64, N> {
    let sum = |weights: &Stages, values: &[Vector<f64, N>; STAGES]| {
        let mut total = Vector::ZERO;
        for (w, value) in weights.iter().zip(values) {
            total += value.scaled(w);
        }
        total
    };
    let velocity = |v: &Vector<f64, N>, a| *v + sum(once, a).scaled(h);
    let position =
        |q: &Vector<f64, N>, v: &Vector<f64, N>, a| *q + (v.scaled(at) + sum(twice, a).scaled(h)).scaled(h);
    Motion {
        q_l: position(&x.q_l, &x.v_l, &solution.link),
        q_m: position(&x.q_m, &x.v_m, &solution.motor),
        v_l: velocity(&x.v_l, &solution.link),
        v_m: velocity(&x.v_m, &solution.motor),
    }
}

/// Number of steps of at most `step` that fill `interval`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 1e8]")]
pub(crate) fn steps_in(interval: f64, step: f64) -> u32 {
    (interval / step * (1.0 - 1e-12)).ceil().clamp(1.0, 1e8) as u32
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub(crate) fn is_finite<const N: usize>(x: &Motion<f64, N>) -> bool {
    [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|v| v.iter().all(f64::is_finite))
}
