//! Gauss–Legendre collocation of order 4 or 8 for flexible-joint plants.
//!
//! Symplectic without dampers, so that an undamped robot neither gains nor loses energy systematically; A-stable, so that a stiff
//! spring on a light wrist cannot blow up; exact for dampers of motors, so that one of 9000 1/s takes no short steps; and of high
//! order, so that fast transients are resolved rather than damped away. The order is the lower one where a step across
//! the interval has it accurate enough. The stage equations are solved for accelerations in torque form, which
//! needs inverse dynamics only. Hairer, Lubich & Wanner, *Geometric Numerical Integration*, chapters II and VI.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use crate::plant::Plant;
use crate::simulate::collocation::{Collocation, Past, Task};
use crate::simulate::ledger::Ledger;

/// A step that cannot be made: the state or the torque is not finite, or the step would have to be too small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFailure {
    /// Time into the interval at which it happened in s.
    pub after: f64,
}

/// The order of collocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Two stages.
    Four,
    /// Four stages.
    Eight,
}

/// Integrates a plant over intervals, with steps chosen for accuracy.
#[derive(Clone, Debug)]
pub struct Integrator<const N: usize> {
    pub(crate) low: Collocation<2, N>,
    pub(crate) high: Collocation<4, N>,
    /// Tolerated local error of a step, relative to the speed of the joint.
    pub(crate) tolerance: f64,
    /// The order of the next step.
    pub(crate) order: Order,
    /// Last good step in s: the first guess for the next.
    pub(crate) step: f64,
    pub(crate) steps: u64,
    pub(crate) past: Past<N>,
}

/// Steps of this fraction of the interval are taken whatever their error: a torque that jumps cannot be resolved, only
/// stepped across.
const SHORTEST: f64 = 1e-5;

/// More steps than this in one interval are a failure: a run ends in bounded time whatever happens in it.
const MOST_STEPS: u32 = 200_000;

/// Stage equations are solved to this part of the tolerance.
pub(super) const SOLVED: f64 = 0.001;

/// The lower order is taken where its error would be this part of the tolerance.
const AMPLE: f64 = 0.5;

/// A solved step.
#[derive(Clone, Copy)]
struct Step<const N: usize> {
    end: Motion<f64, N>,
    work: Ledger,
    /// By how much the step could have been longer; below 1 it was too long.
    factor: f64,
}

impl<const N: usize> Integrator<N> {
    /// With a tolerated local error relative to the joint speeds; 1e-7 is a good start.
    pub fn new(tolerance: f64) -> Self {
        Self {
            low: Collocation::new(),
            high: Collocation::new(),
            tolerance,
            order: Order::Eight,
            step: f64::INFINITY,
            steps: 0,
            past: Past::NONE,
        }
    }

    /// What it is moved from next is not where it was moved to.
    pub(crate) fn forget(&mut self) {
        self.past.stages = 0;
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
    pub fn advance<L: Links<f64, N>>(
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
            // Equal steps may be longer than their number says, by rounding.
            let is_shortest = h <= 1.001 * shortest;
            let order = self.order;
            match self.try_step(&Task { plant, x: &x, t: t + done, h, torque }, SOLVED * self.tolerance) {
                Some(step) if step.factor >= 1.0 || is_shortest => {
                    x = step.end;
                    ledger.add(&step.work);
                    self.steps += 1;
                    self.step = (h * step.factor.min(2.0)).max(shortest);
                    if remaining == 1 {
                        return Ok(x);
                    }
                    done += h;
                }
                rejected => {
                    match rejected {
                        // Where the lower order does not do, the higher one may.
                        _ if order == Order::Four => self.order = Order::Eight,
                        Some(step) => self.step = (h * step.factor.clamp(0.1, 0.9)).max(shortest),
                        None if !is_shortest => self.step = (0.5 * h).max(shortest),
                        None => break,
                    }
                    // Its polynomials lead on from where the robot does not get.
                    self.past.stages = 0;
                }
            }
        }
        Err(StepFailure { after: done })
    }

    /// Moves `x` by `count` equal steps of one order whatever their error: for convergence studies.
    ///
    /// # Errors
    /// [`StepFailure`] if the stage equations of a step cannot be solved.
    pub fn advance_uniformly<L: Links<f64, N>>(
        &mut self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        interval: f64,
        (order, count): (Order, u32),
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
    ) -> Result<Motion<f64, N>, StepFailure> {
        let h = interval / f64::from(count);
        for i in 0..count {
            let t = h * f64::from(i);
            self.order = order;
            x = self.try_step(&Task { plant, x: &x, t, h, torque }, 0.0).ok_or(StepFailure { after: t })?.end;
            self.steps += 1;
        }
        Ok(x)
    }

    /// A step; none if its stage equations cannot be solved in finite numbers. The order of the next one may be another.
    fn try_step<L: Links<f64, N>>(&mut self, task: &Task<'_, L, N>, accuracy: f64) -> Option<Step<N>> {
        match self.order {
            Order::Four => {
                let step = self.low.step(task, &mut self.past, accuracy)?;
                Some(Step { end: step.end, work: step.work, factor: self.factor(step.error, 5) })
            }
            Order::Eight => {
                let step = self.high.step(task, &mut self.past, accuracy)?;
                if self.high.error_of_coarser(task, &self.low, &step) <= AMPLE * self.tolerance {
                    self.order = Order::Four;
                }
                Some(Step { end: step.end, work: step.work, factor: self.factor(step.error, 9) })
            }
        }
    }

    /// How much longer a step may be whose error of order `order` is `error`.
    fn factor(&self, error: f64, order: i32) -> f64 {
        if error * 2.5_f64.powi(order) <= self.tolerance {
            return 2.0;
        }
        let factor = (self.tolerance / error).powf(1.0 / f64::from(order));
        // A margin of 0.8 when lengthening keeps the next step from being rejected.
        if factor >= 1.25 {
            0.8 * factor
        } else if factor >= 1.0 {
            1.0
        } else {
            0.8 * factor
        }
    }
}

/// Number of steps of at most `step` that fill `interval`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 1e8]")]
pub(crate) fn steps_in(interval: f64, step: f64) -> u32 {
    (interval / step * (1.0 - 1e-12)).ceil().clamp(1.0, 1e8) as u32
}
