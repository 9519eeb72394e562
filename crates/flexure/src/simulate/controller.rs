//! What stands between the motion of the robot and the torque on its motors: sensors, estimator, law, guard and drive.

use std::cell::Cell;

use flexure_core::estimate::{DisturbanceObserver, Estimator, FilteredDifference};
use flexure_core::guard::{Age, Certificate, Fault, Phase, Place, Status, Watchdog};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::{Reference, Stop};
use flexure_core::scalar::Jet;

use crate::imperfections::stages::{Actuator, Computer, Measured, Pieces, Sensors, Tick};
use crate::simulate::feedback::Feedback;
use crate::simulate::guarded::{Asked, Guarded};
use crate::simulate::remembered::Remembered;

/// A law with everything between it and the robot; without any of that, an ideal loop.
///
/// `robot` is the model that law, estimator and guard go by: the simulated robot may be another.
pub struct Controller<L, R, F, E, const N: usize> {
    /// The robot as the controller knows it.
    pub robot: Fjr<f64, L, N>,
    /// Positions of the links over time that the law shall follow, in rad.
    pub reference: R,
    /// From motion and reference to motor torque.
    pub law: F,
    /// From motion to readings.
    pub sensors: Sensors,
    /// From readings to motion; without one the law sees the readings, velocities included.
    pub estimator: Option<E>,
    /// Torque that the model does not explain.
    pub disturbance: Option<Compensation<N>>,
    /// Limits and safe stops.
    pub guard: Option<Guarded<N>>,
    /// When it runs, and whether commands get out.
    pub computer: Computer,
    /// What the drive does while no command comes; none where one always does.
    pub watchdog: Option<Watchdog<f64, N>>,
    /// From command to torque.
    pub actuator: Actuator,
    pub(crate) state: State<N>,
}

/// A disturbance observer and what is made of its estimate.
#[derive(Clone, Debug)]
pub struct Compensation<const N: usize> {
    /// The observer.
    pub observer: DisturbanceObserver<f64, N>,
    /// Whether its estimate of the torque on the motors is taken from the command; or it is only recorded.
    pub compensate: bool,
}

/// What the controller remembers from one instant to the next.
#[derive(Clone, Debug)]
pub(crate) struct State<const N: usize> {
    /// Mean motor torque since the last instant, as the drive reports it: after its delays and limits, with the torque constant that
    /// it believes in [N m].
    pub(crate) applied: Vector<f64, N>,
    /// How the robot moved when the law took over from the guard, and how it would have come to rest.
    pub(crate) rejoined: Option<Stop<f64, N>>,
    /// Of a law with memory, while it has the robot.
    pub(crate) remembered: Option<Remembered<N>>,
}

/// What a controller knows at an instant before its law is asked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensed<const N: usize> {
    measured: Measured<N>,
    age: Age,
    /// The motion that the law goes by.
    pub(crate) seen: Motion<f64, N>,
    /// Torque on the motors that the model does not explain [N m], and whether the law's is less by it.
    disturbance: Option<(Vector<f64, N>, bool)>,
    /// Where the links shall be, q_ld in rad to order 4.
    pub(crate) reference: Vector<Jet<f64, 5>, N>,
}

/// What a controller does at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Action<const N: usize> {
    /// Where the links shall be, q_ld in rad to order 4.
    pub reference: Vector<Jet<f64, 5>, N>,
    /// What the sensors deliver, before any estimator; not a number where nothing was read or nothing is measured.
    pub measured: Motion<f64, N>,
    /// The motion that the law goes by; not a number where nothing was read.
    pub seen: Motion<f64, N>,
    /// Torque on the motors that the model does not explain, as estimated [N m]; zero without an observer.
    pub disturbance: Vector<f64, N>,
    /// Torque that leaves the controller [N m].
    pub u_m: Vector<f64, N>,
    /// Torque on the motors until the next instant [N m]: what the drive believes to give when it comes from
    /// [`step`](Controller::step), what the motors give when a loop shows it.
    pub applied: Pieces<N>,
    /// Mean motor torque until the next instant as the drive reports it [N m]: with the torque constant that it believes in.
    pub reported: Vector<f64, N>,
    /// Whether a certificate of the law can hold: the motors give what the law asks of them at what it sees, no more, no less
    /// and no later, and no guard limits torques or stops the robot.
    pub certificate: bool,
    /// Whether the guard has stopped the robot.
    pub stopped: bool,
    /// What the guard says, if there is one.
    pub guard: Option<Said>,
}

/// What a guard says of an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    /// Who decides.
    pub phase: Phase,
    /// The first thing that is wrong, and where.
    pub fault: Option<(Fault, Place)>,
}

impl<L, R, F, const N: usize> Controller<L, R, F, FilteredDifference<f64, N>, N>
where
    L: Links<f64, N>,
    R: Reference<f64, N>,
    F: Feedback<L, N>,
{
    /// The law on true states, its torque on the motors at once.
    pub fn ideal(robot: Fjr<f64, L, N>, reference: R, law: F) -> Self {
        Self::new(robot, reference, law)
    }
}

impl<L, R, F, E, const N: usize> Controller<L, R, F, E, N>
where
    L: Links<f64, N>,
    R: Reference<f64, N>,
    F: Feedback<L, N>,
    E: Estimator<f64, N>,
{
    /// The law with nothing between it and the robot yet.
    pub fn new(robot: Fjr<f64, L, N>, reference: R, law: F) -> Self {
        let state = State { applied: Vector::ZERO, rejoined: None, remembered: None };
        let (sensors, computer, actuator) = (Sensors::default(), Computer::default(), Actuator::default());
        Self {
            robot,
            reference,
            law,
            sensors,
            estimator: None,
            disturbance: None,
            guard: None,
            computer,
            watchdog: None,
            actuator,
            state,
        }
    }

    /// Torques [N m] up to which nothing stands between the law and the robot: the law sees how it moves, and what it asks for acts at once. None if
    /// something does anyway.
    pub(crate) fn ideal_up_to(&self) -> Option<Vector<f64, N>> {
        let is_ideal = self.sensors.are_ideal()
            && self.estimator.is_none()
            && self.disturbance.is_none()
            && self.guard.is_none()
            && self.computer.is_in_time()
            && self.watchdog.is_none();
        is_ideal.then(|| self.actuator.limits())?
    }

    /// Starts estimator and disturbance observer at the motion `x`, held by the motor torque `applied` [N m] until now. Sensors,
    /// guard and drive start when they are made.
    pub fn start(&mut self, x: &Motion<f64, N>, applied: Vector<f64, N>) {
        self.state = State { applied, rejoined: None, remembered: None };
        if let Some(estimator) = &mut self.estimator {
            estimator.start(x);
        }
        if let Some(disturbance) = &mut self.disturbance {
            disturbance.observer.restart();
        }
        if let Some(guarded) = &mut self.guard {
            guarded.coasting.saw(x);
        }
    }

    /// What happens at a control instant at which the robot moves as `x`. Nothing is allocated.
    pub fn step(&mut self, tick: &Tick, x: &Motion<f64, N>) -> Action<N> {
        match self.sense(tick, x, None) {
            None => self.silent(tick),
            Some(sensed) => self.act(tick, &sensed, None),
        }
    }

    /// What is known at a control instant before the law is asked; nothing if the computer stands still. `path` is the reference then, if
    /// it is known already.
    pub(crate) fn sense(
        &mut self,
        tick: &Tick,
        x: &Motion<f64, N>,
        path: Option<&Vector<Jet<f64, 5>, N>>,
    ) -> Option<Sensed<N>> {
        if self.computer.is_still(tick) {
            return None;
        }
        let measured = self.sensors.sense(tick, x);
        let applied = self.state.applied;
        let (read, age) = match &mut self.guard {
            None => (measured.motion, Age::FRESH),
            Some(guarded) => guarded.fill(&self.robot, &measured, &applied),
        };
        let seen = match &mut self.estimator {
            None => read,
            Some(estimator) => estimator.update(&self.robot, &read.q_l, &read.q_m, &applied),
        };
        let disturbance = self.disturbance.as_mut().map(|disturbance| {
            (disturbance.observer.update(&self.robot, &seen, &applied).motor, disturbance.compensate)
        });
        let reference = match path {
            Some(known) if !self.has_rejoined() => *known,
            _ => self.reference_at(tick.t),
        };
        Some(Sensed { measured, age, seen, disturbance, reference })
    }

    /// What is done at a control instant at which this was `sensed`. `torque` is what the law asks there [N m], if it was asked already.
    pub(crate) fn act(
        &mut self,
        tick: &Tick,
        sensed: &Sensed<N>,
        torque: Option<Vector<f64, N>>,
    ) -> Action<N> {
        let Sensed { measured, age, seen, disturbance, reference } = sensed;
        let applied = self.state.applied;
        let compensated = match disturbance {
            Some((torque, true)) => *torque,
            _ => Vector::ZERO,
        };
        self.remember(tick.t, seen, reference);
        let Self { robot, reference: path, law, guard, state, .. } = self;
        let mut asked = Asked {
            robot,
            path,
            law,
            memory: state.remembered.as_ref().map(|remembered| &remembered.z),
            t: tick.t,
            reference,
            compensated,
            known: torque.map(|torque| (*seen, torque)),
            wanted: Cell::new(None),
        };
        let (u_m, status) = match guard {
            None => (asked.follow(seen), None),
            Some(guarded) => {
                let decision = guarded.decide(tick, measured, *age, seen, &applied, &mut asked);
                (decision.torque, Some(decision.status))
            }
        };
        let wanted = asked.wanted.get();
        if let (Some(Status { phase: Phase::Rejoined, .. }), Some(guarded)) = (status, &self.guard) {
            self.state.rejoined = Some(guarded.joined(&self.robot, tick.t, seen));
        }
        match (&mut self.state.remembered, status) {
            // The law has not the robot: it will start anew, from how it then moves.
            (_, Some(status)) if !status.phase.is_law_s() || status.phase == Phase::Rejoined => {
                self.state.remembered = None;
            }
            (Some(remembered), _) => remembered.ask(u_m),
            (None, _) => {}
        }
        let command = (!self.computer.misses(tick)).then_some(u_m);
        let pieces = self.driven(tick, command);
        let disturbance = disturbance.map_or(Vector::ZERO, |(torque, _)| torque);
        Action {
            reference: *reference,
            measured: measured.motion,
            seen: *seen,
            disturbance,
            u_m,
            applied: pieces,
            reported: self.state.applied,
            // What the drive gives over the period is what the law asks, to the bit; whoever decided.
            certificate: wanted.is_some_and(|torque| pieces.iter().all(|(_, given)| given == torque))
                && status.is_none_or(|status| status.certificate() == Certificate::Holds),
            stopped: status.is_some_and(|status| !status.phase.is_law_s()),
            guard: status.map(|status| Said { phase: status.phase, fault: status.fault() }),
        }
    }

    /// Takes the memory of the law, if it has one, to the time `t` in s.
    fn remember(&mut self, t: f64, x: &Motion<f64, N>, q_ld: &Vector<Jet<f64, 5>, N>) {
        if !self.law.memory().is_empty() {
            let State { applied, remembered, .. } = &self.state;
            self.state.remembered =
                Remembered::at(&self.law, &self.robot, remembered.as_ref(), t, (x, q_ld), *applied);
        }
    }

    /// An instant at which the computer stands still.
    pub(crate) fn silent(&mut self, tick: &Tick) -> Action<N> {
        let nothing = Motion::at_rest(Vector([f64::NAN; N]));
        let pieces = self.driven(tick, None);
        Action {
            reference: self.reference_at(tick.t),
            measured: nothing,
            seen: nothing,
            disturbance: Vector::ZERO,
            u_m: self.state.applied,
            applied: pieces,
            reported: self.state.applied,
            certificate: false,
            stopped: false,
            guard: None,
        }
    }

    /// What the drive gives over the period, by the `command` of this instant, if it came.
    fn driven(&mut self, tick: &Tick, command: Option<Vector<f64, N>>) -> Pieces<N> {
        let torque = match &mut self.watchdog {
            Some(watchdog) => watchdog.step(command),
            None => command.unwrap_or(self.state.applied),
        };
        let pieces = self.actuator.actuate(tick, torque);
        self.state.applied = pieces.mean(tick.period);
        pieces
    }

    /// Torque of the law [N m] at any time, with the memory that it has; for loops in continuous time, too: no device stands in between.
    pub fn torque(&self, t: f64, x: &Motion<f64, N>) -> Vector<f64, N> {
        let memory = self.state.remembered.as_ref().map(|remembered| &remembered.z);
        self.law.torque(&self.robot, t, x, &self.reference.at(t), memory)
    }

    /// Whether the law has taken over from the guard: it then joins the reference again.
    pub(crate) fn has_rejoined(&self) -> bool {
        self.state.rejoined.is_some()
    }

    /// The reference; after a stop it is joined from how the robot moved when the law took over.
    fn reference_at(&self, t: f64) -> Vector<Jet<f64, 5>, N> {
        match (&self.state.rejoined, &self.guard) {
            (Some(from), Some(guarded)) => guarded.join(*from, &self.reference).at(t),
            _ => self.reference.at(t),
        }
    }
}
