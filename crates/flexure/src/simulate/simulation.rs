//! A controller on a robot: sampled with a zero-order hold, or continuous.

use flexure_core::estimate::Estimator;
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::reference::Reference;

use crate::imperfections::stages::{Pieces, Tick};
use crate::plant::{Plant, Push};
use crate::scenario::Integration;
use crate::simulate::assembly;
use crate::simulate::controller::{Action, Controller};
use crate::simulate::feedback::Feedback;
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

/// How a loop is run in time.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    /// Control period in s; also the interval at which the run is observed.
    pub period: f64,
    /// What the torque does between control instants.
    pub hold: Hold,
    /// How smooth plants are moved.
    pub integration: Integration,
    /// Longest step of other plants in s.
    pub longest_step: f64,
}

impl Timing {
    /// Torques held for a control `period` in s, and plants moved as a scenario that says nothing of it has them moved.
    pub fn sampled(period: f64) -> Self {
        let (integration, longest_step) = (Integration::default(), assembly::LONGEST_STEP);
        Self { period, hold: Hold::ZeroOrder, integration, longest_step }
    }
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
    /// Energy supplied and dissipated so far.
    pub ledger: &'a Ledger,
}

/// A loop that left the finite numbers, or any sensible range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{} at t = {time:.4} s; the last control instant has positions or speeds up to {magnitude:.3e} rad or rad/s",
    cause.words()
)]
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

impl Cause {
    /// Every cause, in the order of their numbers in saved states.
    pub const ALL: [Self; 3] = [Self::Unbounded, Self::Torque, Self::Unsolvable];

    fn words(self) -> &'static str {
        match self {
            Self::Unbounded => "the loop diverged",
            Self::Torque => "the torque is no number",
            Self::Unsolvable => "the motion diverged or became too wild to integrate",
        }
    }
}

/// A position in rad or speed [rad/s] beyond this is a diverged loop, not a robot.
pub(crate) const BEYOND: f64 = 1e6;

/// A controller on a plant, moved from one control instant to the next.
pub struct Simulation<L, R, F, E, const N: usize> {
    pub(crate) controller: Controller<L, R, F, E, N>,
    pub(crate) world: World<L, N>,
    pub(crate) timing: Timing,
    /// Motion at the last control instant.
    pub(crate) motion: Motion<f64, N>,
    /// What happened there; none before the first.
    pub(crate) last: Option<Happened<N>>,
    pub(crate) balance: Balance,
    pub(crate) divergence: Option<Divergence>,
}

/// Motion and energy that went through until a control instant.
pub(crate) type Kept<const N: usize> = (Motion<f64, N>, Ledger);

/// What happened at a control instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Happened<const N: usize> {
    pub(crate) tick: Tick,
    pub(crate) action: Action<N>,
    pub(crate) energy: f64,
    pub(crate) residual: f64,
}

/// The energy balance of a run, all in J. Of several, if `T` is lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balance<T = f64> {
    /// Energy at the start.
    pub(crate) start: T,
    /// Largest residual so far.
    pub(crate) worst: T,
    /// Energy that went through the robot.
    pub(crate) scale: T,
}

impl<L, R, F, E, const N: usize> Simulation<L, R, F, E, N>
where
    L: Links<f64, N>,
    R: Reference<f64, N>,
    F: Feedback<L, N>,
    E: Estimator<f64, N>,
{
    /// `controller` on `plant`, which moves as `x` at t = 0 and is pushed by `pushes`. Nothing has happened yet.
    pub fn new(
        timing: Timing,
        plant: Plant<L, N>,
        x: Motion<f64, N>,
        pushes: Vec<Push<N>>,
        controller: Controller<L, R, F, E, N>,
    ) -> Self {
        let stepper = Stepper::new(&plant, timing.integration, timing.longest_step);
        let world = World { plant, pushes, stepper, ledger: Ledger::default() };
        let start = world.energy(&x);
        let balance = Balance { start, worst: 0.0, scale: start.abs() };
        Self { controller, world, timing, motion: x, last: None, balance, divergence: None }
    }

    /// Moves on to the next control instant, the first at t = 0, and does what the controller does there: from the end of one
    /// step to the next the torque of the [instant](Self::instant) acts.
    ///
    /// # Errors
    /// If the loop diverged, now or before; the instant is then the last good one.
    pub fn step(&mut self) -> Result<(), Divergence> {
        if let Some(divergence) = self.divergence {
            return Err(divergence);
        }
        let kept = self.kept();
        self.next().inspect_err(|divergence| self.end(*divergence, kept))
    }

    /// What is seen of the last good instant once the loop has diverged.
    pub(crate) fn kept(&self) -> Kept<N> {
        (self.motion, self.world.ledger)
    }

    /// The loop has diverged: what is seen is still the last good instant.
    pub(crate) fn end(&mut self, divergence: Divergence, kept: Kept<N>) {
        self.divergence = Some(divergence);
        (self.motion, self.world.ledger) = kept;
    }

    fn next(&mut self) -> Result<(), Divergence> {
        let tick = self.tick();
        self.advance()?;
        let action = self.controller.step(&tick, &self.motion);
        self.arrive(tick, action, self.world.energy(&self.motion))
    }

    /// The next control instant.
    pub(crate) fn tick(&self) -> Tick {
        Tick::new(self.last.as_ref().map_or(0, |last| last.tick.k + 1), self.timing.period)
    }

    /// Books what the controller does at an instant at which the robot has moved there and has the total energy `energy` in J.
    pub(crate) fn arrive(
        &mut self,
        tick: Tick,
        mut action: Action<N>,
        energy: f64,
    ) -> Result<(), Divergence> {
        let given = action.applied.map(|torque| self.world.plant.torque_gain.diag_mul(&torque));
        // A drive that does not give what it believes voids what is proved of the law.
        action.certificate &= given == action.applied;
        action.applied = given;
        let ledger = self.world.ledger;
        let residual = energy - self.balance.start - ledger.supplied + ledger.dissipated;
        self.balance.scale =
            self.balance.scale.max(energy.abs()).max(ledger.throughput).max(ledger.dissipated);
        self.balance.worst = self.balance.worst.max(residual.abs());
        let magnitude = largest(&self.motion);
        if !(magnitude < BEYOND && action.applied.last().iter().all(f64::is_finite)) {
            let cause = if magnitude < BEYOND { Cause::Torque } else { Cause::Unbounded };
            return Err(Divergence { time: tick.t, magnitude, cause });
        }
        self.last = Some(Happened { tick, action, energy, residual });
        Ok(())
    }

    /// The last control instant; none before the first.
    pub(crate) fn last_tick(&self) -> Option<Tick> {
        self.last.as_ref().map(|last| last.tick)
    }

    /// The motor torque until the next instant [N m], if it is one from beginning to end and no push begins or ends meanwhile; none before the
    /// first instant.
    pub(crate) fn held_torque(&self) -> Option<Vector<f64, N>> {
        let Happened { tick, action, .. } = self.last.as_ref()?;
        let mut edges = self.world.pushes.iter().flat_map(|push| [push.from, push.until()]);
        let is_cut = edges.any(|edge| edge > tick.t && edge < tick.t + tick.period);
        (!is_cut && action.applied.change.is_none()).then_some(action.applied.first)
    }

    /// Whether the motor torque changes before the next instant.
    pub(crate) fn is_in_pieces(&self) -> bool {
        self.last.as_ref().is_some_and(|last| last.action.applied.change.is_some())
    }

    /// Mean torque on the links from outside until the next instant [N m].
    pub(crate) fn pushed(&self) -> Vector<f64, N> {
        let Some(Happened { tick, .. }) = &self.last else { return Vector::ZERO };
        self.world.pushes.iter().fold(Vector::ZERO, |sum, push| sum + push.mean(tick.t, tick.period))
    }

    /// Over the control period after the last instant, if there was one.
    pub(crate) fn advance(&mut self) -> Result<(), Divergence> {
        let Self { controller, world, timing, motion, last: Some(Happened { tick, action, .. }), .. } = self
        else {
            return Ok(());
        };
        let next = match timing.hold {
            Hold::ZeroOrder => world.advance_pieces(*motion, tick, &action.applied),
            Hold::Continuous => {
                world.advance(*motion, tick.t, timing.period, &|t, x| controller.torque(t, x))
            }
        };
        match next {
            Ok(next) => {
                *motion = next;
                Ok(())
            }
            Err(failure) => {
                let time = tick.t + failure.after;
                Err(Divergence { time, magnitude: largest(motion), cause: Cause::Unsolvable })
            }
        }
    }

    /// What happened at the last control instant; none before the first.
    pub fn instant(&self) -> Option<Instant<'_, N>> {
        let Happened { tick, action, energy, residual } = self.last.as_ref()?;
        Some(Instant {
            t: tick.t,
            motion: &self.motion,
            action,
            energy: *energy,
            residual: *residual,
            ledger: &self.world.ledger,
        })
    }

    /// The controller, as it is now.
    pub fn controller(&self) -> &Controller<L, R, F, E, N> {
        &self.controller
    }

    /// The plant, as it is now.
    pub fn plant(&self) -> &Plant<L, N> {
        &self.world.plant
    }

    /// Pushes on the links, past and to come.
    pub fn pushes(&self) -> &[Push<N>] {
        &self.world.pushes
    }

    /// Integration steps so far.
    pub fn steps(&self) -> u64 {
        self.world.stepper.steps()
    }

    /// |H(t) − H(0) − supplied + dissipated|, its largest value so far, relative to the energy that went through the robot.
    pub fn energy_drift(&self) -> f64 {
        let Balance { worst, scale, .. } = self.balance;
        if scale > 0.0 { worst / scale } else { worst }
    }
}

/// Largest position in rad or speed [rad/s]; NaN if one is.
fn largest<const N: usize>(x: &Motion<f64, N>) -> f64 {
    let parts = [&x.q_l, &x.q_m, &x.v_l, &x.v_m];
    parts.iter().flat_map(|v| v.iter()).fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
}

/// The robot and what acts on it.
#[derive(Debug)]
pub(crate) struct World<L, const N: usize> {
    pub(crate) plant: Plant<L, N>,
    pub(crate) pushes: Vec<Push<N>>,
    pub(crate) stepper: Stepper<N>,
    pub(crate) ledger: Ledger,
}

impl<L: Links<f64, N>, const N: usize> World<L, N> {
    pub(crate) fn energy(&self, x: &Motion<f64, N>) -> f64 {
        self.stepper.total_energy(&self.plant, x)
    }

    /// Over a control period with the torque constant on `pieces` of it.
    pub(crate) fn advance_pieces(
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
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
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
