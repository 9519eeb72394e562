//! A controller on a robot: sampled with a zero-order hold, or continuous.

use flexure_core::estimate::Estimator;
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::reference::Reference;
use flexure_core::scalar::Jet;

use crate::imperfections::stages::{Pieces, Tick};
use crate::plant::{Plant, Push};
use crate::simulate::controller::{Action, Controller};
use crate::simulate::gauss::StepFailure;
use crate::simulate::ledger::Ledger;
use crate::simulate::stepper::Stepper;

/// How the torque behaves between control instants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Constant over the control period.
    ZeroOrder,
    /// The law is evaluated at every integration stage: the continuous-time loop of the theory.
    Continuous,
}

/// A closed loop to simulate.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLoop {
    /// Length of the run in s.
    pub duration: f64,
    /// Control period in s; also the interval at which the run is observed.
    pub period: f64,
    /// Torque between control instants.
    pub hold: Hold,
    /// Tolerated local error of the integrator of smooth plants, relative to the joint speeds.
    pub tolerance: f64,
    /// Longest step of the integrator of other plants in s.
    pub longest_step: f64,
}

/// What a control instant looks like to an observer.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a, const N: usize> {
    /// Time in s.
    pub t: f64,
    /// Motion of the robot.
    pub motion: &'a Motion<f64, N>,
    /// What the controller does.
    pub action: &'a Action<N>,
    /// Total energy H in J.
    pub energy: f64,
    /// H(t) − H(0) − supplied + dissipated in J: zero up to integration errors.
    pub residual: f64,
    /// Work so far.
    pub ledger: &'a Ledger,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// |H(T) − H(0) − supplied + dissipated|, its largest value over the run, relative to the energy that went through
    /// the robot.
    pub energy_drift: f64,
    /// Integration steps.
    pub steps: u64,
    /// Set if the loop diverged before the end.
    pub divergence: Option<Divergence>,
}

/// A loop that left the finite numbers, or any sensible range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// Time at which the run had to stop, in s.
    pub time: f64,
    /// Largest link position or velocity seen at the last good instant [rad, rad/s].
    pub magnitude: f64,
    /// What stopped the run.
    pub cause: Cause,
}

/// What stopped a run before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Positions, speeds or torques left every sensible range, or the finite numbers.
    Unbounded,
    /// The torque left the finite numbers while the robot was still in range: a reading was no number, or a gain too high.
    Torque,
    /// The motion between two control instants could not be integrated.
    Unsolvable,
}

/// A position in rad or speed [rad/s] beyond this is a diverged loop, not a robot.
const BEYOND: f64 = 1e6;

impl ClosedLoop {
    /// Runs `controller` on `plant` from `x`, pushed by `pushes`, and shows every control instant to `observe`, the last included.
    pub fn run<L, R, F, E, const N: usize>(
        &self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        pushes: &[Push<N>],
        controller: &mut Controller<'_, L, R, F, E, N>,
        observe: &mut impl FnMut(&Instant<'_, N>),
    ) -> Outcome
    where
        L: Links<f64, N> + Clone,
        R: Reference<f64, N>,
        F: Fn(f64, &Motion<f64, N>, &Vector<Jet<f64, 5>, N>) -> Vector<f64, N>,
        E: Estimator<f64, N>,
    {
        let stepper = Stepper::new(plant, self.tolerance, self.longest_step);
        let mut world = World { plant: plant.clone(), pushes, stepper, ledger: Ledger::default() };
        let start = world.energy(&x);
        let (mut worst, mut scale) = (0.0_f64, start.abs());
        let periods = self.periods();
        let mut divergence = None;
        for k in 0..=periods {
            let tick = Tick::new(u64::from(k), self.period);
            let t = tick.t;
            let mut action = controller.step(&tick, &x);
            action.applied = action.applied.map(|torque| plant.torque_gain.diag_mul(&torque));
            let (energy, ledger) = (world.energy(&x), world.ledger);
            let residual = energy - start - ledger.supplied + ledger.dissipated;
            scale = scale.max(energy.abs()).max(ledger.throughput).max(ledger.dissipated);
            worst = worst.max(residual.abs());
            let magnitude = largest(&x);
            if !(magnitude < BEYOND && action.applied.last().iter().all(f64::is_finite)) {
                let cause = if magnitude < BEYOND { Cause::Torque } else { Cause::Unbounded };
                divergence = Some(Divergence { time: t, magnitude, cause });
                break;
            }
            observe(&Instant { t, motion: &x, action: &action, energy, residual, ledger: &ledger });
            if k == periods {
                break;
            }
            let next = match self.hold {
                Hold::ZeroOrder => world.advance_pieces(x, &tick, &action.applied),
                Hold::Continuous => world.advance(x, t, self.period, &|t, x| controller.torque(t, x)),
            };
            match next {
                Ok(next) => x = next,
                Err(failure) => {
                    let time = t + failure.after;
                    divergence = Some(Divergence { time, magnitude, cause: Cause::Unsolvable });
                    break;
                }
            }
        }
        let energy_drift = if scale > 0.0 { worst / scale } else { worst };
        Outcome { energy_drift, steps: world.stepper.steps(), divergence }
    }

    /// Number of control periods in the run.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 1e9]")]
    fn periods(&self) -> u32 {
        (self.duration / self.period).round().clamp(1.0, 1e9) as u32
    }
}

/// Largest position in rad or speed [rad/s]; NaN if one is.
fn largest<const N: usize>(x: &Motion<f64, N>) -> f64 {
    let parts = [&x.q_l, &x.q_m, &x.v_l, &x.v_m];
    parts.iter().flat_map(|v| v.iter()).fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
}

/// The robot and what acts on it.
struct World<'a, L, const N: usize> {
    plant: Plant<L, N>,
    pushes: &'a [Push<N>],
    stepper: Stepper<N>,
    ledger: Ledger,
}

impl<L: Links<f64, N>, const N: usize> World<'_, L, N> {
    fn energy(&self, x: &Motion<f64, N>) -> f64 {
        self.stepper.total_energy(&self.plant, x)
    }

    /// Over a control period with the torque constant on `pieces` of it.
    fn advance_pieces(
        &mut self,
        mut x: Motion<f64, N>,
        tick: &Tick,
        pieces: &Pieces<N>,
    ) -> Result<Motion<f64, N>, StepFailure> {
        for (offset, length, torque) in pieces.spans(tick.period) {
            let begin = tick.t + offset;
            let after = |failure: StepFailure| StepFailure { after: offset + failure.after };
            x = self.advance(x, begin, length, &|_, _| torque).map_err(after)?;
        }
        Ok(x)
    }

    /// Over `[t, t + interval]`, divided where pushes begin and end. A push is constant between: its mean.
    fn advance(
        &mut self,
        mut x: Motion<f64, N>,
        t: f64,
        interval: f64,
        torque: &impl Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
    ) -> Result<Motion<f64, N>, StepFailure> {
        let mut done = 0.0;
        while done < interval {
            let edges = self.pushes.iter().flat_map(|push| [push.from, push.until()]).map(|edge| edge - t);
            let next = edges.filter(|&edge| edge > done).fold(interval, f64::min);
            let (begin, length) = (t + done, next - done);
            self.plant.external =
                self.pushes.iter().fold(Vector::ZERO, |sum, push| sum + push.mean(begin, length));
            let moved = self.stepper.advance(&self.plant, x, begin, length, torque, &mut self.ledger);
            x = moved.map_err(|failure| StepFailure { after: done + failure.after })?;
            done = next;
        }
        Ok(x)
    }
}
