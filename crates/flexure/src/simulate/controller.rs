//! What stands between the motion of the robot and the torque on its motors: sensors, estimator, law, guard and drive.

use std::cell::Cell;

use flexure_core::estimate::{DisturbanceObserver, Estimator, FilteredDifference};
use flexure_core::guard::{Age, Certificate, Guard, Phase};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::{Reference, SmoothStart, Stop};
use flexure_core::scalar::Jet;

use crate::imperfections::stages::{Actuator, Measured, Pieces, Sensors, Tick};
use crate::laws::{self, AnyLaw};

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
    /// From command to torque.
    pub actuator: Actuator,
    pub(crate) state: State<N>,
}

/// A law as the loop asks it.
pub trait Feedback<L, const N: usize> {
    /// Motor torque [N m] for the robot `robot` that moves as `x` at the time `t` in s, with the reference `q_ld` in rad to
    /// order 4.
    fn torque(
        &self,
        robot: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> Vector<f64, N>;
}

impl<L: Links<f64, N>, const N: usize> Feedback<L, N> for AnyLaw<f64, N> {
    fn torque(
        &self,
        robot: &Fjr<f64, L, N>,
        _: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> Vector<f64, N> {
        laws::torque(self, robot, x, q_ld)
    }
}

/// A law that brings its own model along.
impl<L, F, const N: usize> Feedback<L, N> for F
where
    F: Fn(f64, &Motion<f64, N>, &Vector<Jet<f64, 5>, N>) -> Vector<f64, N>,
{
    fn torque(
        &self,
        _: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> Vector<f64, N> {
        self(t, x, q_ld)
    }
}

/// A disturbance observer and what is made of its estimate.
#[derive(Clone, Debug)]
pub struct Compensation<const N: usize> {
    /// The observer.
    pub observer: DisturbanceObserver<f64, N>,
    /// Whether its estimate of the torque on the motors is taken from the command; or it is only recorded.
    pub compensate: bool,
}

/// A guard and how the reference is joined again after a stop.
#[derive(Clone, Debug)]
pub struct Guarded<const N: usize> {
    /// The guard.
    pub guard: Guard<f64, N>,
    /// Time in which the reference is joined in s.
    pub rejoin: f64,
}

/// What the controller remembers from one instant to the next.
#[derive(Clone, Debug)]
pub(crate) struct State<const N: usize> {
    /// Mean motor torque since the last instant, as the drive reports it: after its delays and limits, with the torque constant that
    /// it believes in [N m].
    pub(crate) applied: Vector<f64, N>,
    /// Where the robot was when the law took over from the guard.
    pub(crate) rejoined: Option<Stop<f64, N>>,
}

/// What a controller does at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Action<const N: usize> {
    /// Where the links shall be, q_ld in rad to order 4.
    pub reference: Vector<Jet<f64, 5>, N>,
    /// The motion that the law goes by; not a number where nothing was read.
    pub seen: Motion<f64, N>,
    /// Torque on the motors that the model does not explain, as estimated [N m]; zero without an observer.
    pub disturbance: Vector<f64, N>,
    /// Torque that leaves the controller [N m].
    pub u_m: Vector<f64, N>,
    /// Torque on the motors until the next instant [N m]: what the drive believes to give when it comes from
    /// [`step`](Controller::step), what the motors give when a loop shows it.
    pub applied: Pieces<N>,
    /// Whether a certificate of the law can hold: the motors give what the law asks of them at what it sees, no more, no less
    /// and no later, and no guard limits torques or stops the robot.
    pub certificate: bool,
    /// Whether the guard has stopped the robot.
    pub stopped: bool,
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
        let state = State { applied: Vector::ZERO, rejoined: None };
        let (sensors, actuator) = (Sensors::default(), Actuator::default());
        Self {
            robot,
            reference,
            law,
            sensors,
            estimator: None,
            disturbance: None,
            guard: None,
            actuator,
            state,
        }
    }

    /// Starts estimator and disturbance observer at the motion `x`, held by the motor torque `applied` [N m] until now. Sensors,
    /// guard and drive start when they are made.
    pub fn start(&mut self, x: &Motion<f64, N>, applied: Vector<f64, N>) {
        self.state = State { applied, rejoined: None };
        if let Some(estimator) = &mut self.estimator {
            estimator.start(x);
        }
        if let Some(disturbance) = &mut self.disturbance {
            disturbance.observer.restart();
        }
    }

    /// What happens at a control instant at which the robot moves as `x`. Nothing is allocated.
    pub fn step(&mut self, tick: &Tick, x: &Motion<f64, N>) -> Action<N> {
        let measured = self.sensors.sense(tick, x);
        let applied = self.state.applied;
        let seen = match &mut self.estimator {
            None => measured.motion,
            Some(estimator) => {
                estimator.update(&self.robot, &measured.motion.q_l, &measured.motion.q_m, &applied)
            }
        };
        let disturbance = self.disturbance.as_mut().map(|disturbance| {
            (disturbance.observer.update(&self.robot, &seen, &applied).motor, disturbance.compensate)
        });
        let reference = self.reference_at(tick.t);
        let compensated = match disturbance {
            Some((torque, true)) => torque,
            _ => Vector::ZERO,
        };
        let asked = Cell::new(None);
        let law = |x: &Motion<f64, N>| {
            let torque = self.law.torque(&self.robot, tick.t, x, &reference);
            asked.set(Some(torque));
            torque - compensated
        };
        let (u_m, status) = match &mut self.guard {
            None => (law(&seen), None),
            Some(Guarded { guard, .. }) => {
                let links = &self.robot.links;
                let decision = guard.step(&seen, age(&measured), law, |q_l| links.gravity_torque(q_l));
                (decision.torque, Some(decision.status))
            }
        };
        if status.is_some_and(|status| status.phase == Phase::Rejoined) {
            self.rejoin(tick.t, &seen);
        }
        let pieces = self.actuator.actuate(tick, u_m);
        self.state.applied = pieces.mean(tick.period);
        let disturbance = disturbance.map_or(Vector::ZERO, |(torque, _)| torque);
        Action {
            reference,
            seen,
            disturbance,
            u_m,
            applied: pieces,
            // What the drive gives over the period is what the law asks, to the bit; whoever decided.
            certificate: asked.get().is_some_and(|torque| pieces.iter().all(|(_, given)| given == torque))
                && status.is_none_or(|status| status.certificate() == Certificate::Holds),
            stopped: status.is_some_and(|status| status.phase != Phase::Following),
        }
    }

    /// Torque of the law [N m] at any time, for loops in continuous time: no device stands in between.
    pub fn torque(&self, t: f64, x: &Motion<f64, N>) -> Vector<f64, N> {
        self.law.torque(&self.robot, t, x, &self.reference.at(t))
    }

    /// The reference; after a stop it is joined from where the robot was left.
    fn reference_at(&self, t: f64) -> Vector<Jet<f64, 5>, N> {
        match (&self.state.rejoined, &self.guard) {
            (Some(from), Some(guarded)) => {
                SmoothStart { from: *from, duration: guarded.rejoin, then: &self.reference }.at(t)
            }
            _ => self.reference.at(t),
        }
    }

    /// The law takes over from the next instant on: from rest at the posture that is seen now.
    fn rejoin(&mut self, t: f64, seen: &Motion<f64, N>) {
        if let Some(Guarded { rejoin, .. }) = self.guard {
            let from = seen.q_l.map(Jet::value);
            self.state.rejoined = Some(Stop { from, start: t, duration: rejoin });
        }
    }
}

/// How old the readings are; what no encoder delivers never grows old.
fn age<const N: usize>(measured: &Measured<N>) -> Age {
    let [link, motor] = [0, 1].map(|side| if measured.placed[side] { measured.age[side] } else { 0 });
    Age { link, motor }
}
