//! A guard in a loop: what it is shown, the torques that it chooses from, and how the law takes over after a stop.

use std::cell::Cell;

use flexure_core::estimate::{Disturbance, DisturbanceObserver};
use flexure_core::guard::{Age, Coasting, Decision, Guard, Seen, Torques};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::{Reference, SmoothStart, Stop};
use flexure_core::scalar::Jet;

use crate::imperfections::stages::{Measured, Tick};
use crate::laws::LawMemory;
use crate::simulate::feedback::Feedback;

/// A guard with what it needs around it.
#[derive(Clone, Debug)]
pub struct Guarded<const N: usize> {
    /// The guard.
    pub guard: Guard<f64, N>,
    /// What goes on for a while without readings.
    pub coasting: Coasting<f64, N>,
    /// What finds collisions, and readings that contradict each other; none if nobody asks.
    pub residual: Option<DisturbanceObserver<f64, N>>,
    /// Time in which the reference is joined after a stop in s.
    pub rejoin: f64,
    /// Time in which the robot's own motion comes to rest meanwhile in s.
    pub settle: f64,
}

impl<const N: usize> Guarded<N> {
    /// The readings with predictions where they are lost, and for how many control periods they have been.
    pub(crate) fn fill<L: Links<f64, N>>(
        &mut self,
        robot: &Fjr<f64, L, N>,
        measured: &Measured<N>,
        applied: &Vector<f64, N>,
    ) -> (Motion<f64, N>, Age) {
        let [link, motor] = measured.age;
        self.coasting.fill(robot, &measured.motion, Age { link, motor }, measured.placed, applied)
    }

    /// What the guard decides at an instant at which the controller sees the motion `seen`.
    pub(crate) fn decide<L, R, F>(
        &mut self,
        tick: &Tick,
        measured: &Measured<N>,
        age: Age,
        seen: &Motion<f64, N>,
        applied: &Vector<f64, N>,
        asked: &mut Asked<'_, L, R, F, N>,
    ) -> Decision<f64, N>
    where
        L: Links<f64, N>,
        R: Reference<f64, N>,
        F: Feedback<L, N>,
    {
        self.coasting.saw(seen);
        let residual = match &mut self.residual {
            None => Disturbance::ZERO,
            Some(observer) => observer.update(asked.robot, seen, applied),
        };
        let delivered = |q: &Vector<f64, N>, age| if age == 0 { *q } else { Vector([f64::NAN; N]) };
        let Motion { q_l, q_m, .. } = &measured.motion;
        let seen = Seen {
            x: *seen,
            read: [delivered(q_l, age.link), delivered(q_m, age.motor)],
            age,
            stamp: Some(tick.k),
            target: Some(asked.reference.map(|jet| jet.coefficient(0))),
            residual,
        };
        self.guard.step(&seen, &mut Joining { asked, join: (self.rejoin, self.settle) })
    }

    /// How the robot moves at the time `t` in s, and how it would come to rest.
    pub(crate) fn joined<L: Links<f64, N>>(
        &self,
        robot: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
    ) -> Stop<f64, N> {
        coming_to_rest(robot, t, x, self.settle)
    }

    /// The reference `then`, joined `from` a motion.
    pub(crate) fn join<R>(&self, from: Stop<f64, N>, then: R) -> SmoothStart<f64, R, N> {
        SmoothStart { from, duration: self.rejoin, then }
    }
}

/// How far the accelerations that a robot has when the law takes over may carry the reference on in rad: a robot that is stopped is slow,
/// and links that swing on their springs stay where they are.
const FARTHEST: f64 = 0.1;

/// From the whole motion of the links, position to jerk, which positions and velocities of both sides decide.
fn coming_to_rest<L: Links<f64, N>, const N: usize>(
    robot: &Fjr<f64, L, N>,
    t: f64,
    x: &Motion<f64, N>,
    settle: f64,
) -> Stop<f64, N> {
    let from = robot.link_motion(&robot.links.factor(&x.q_l), x);
    Stop { from, start: t, duration: settle }.within(FARTHEST)
}

/// The law of a loop at a control instant.
pub(crate) struct Asked<'a, L, R, F, const N: usize> {
    pub robot: &'a Fjr<f64, L, N>,
    /// The reference over time, as the scenario has it.
    pub path: &'a R,
    pub law: &'a F,
    /// What the law remembers, if it has the robot.
    pub memory: Option<&'a LawMemory<f64, N>>,
    pub t: f64,
    /// The reference now, as it is followed.
    pub reference: &'a Vector<Jet<f64, 5>, N>,
    /// Torque of a disturbance observer [N m].
    pub compensated: Vector<f64, N>,
    /// What the law asks for [N m] of a robot that moves as this, if that is known already.
    pub known: Option<(Motion<f64, N>, Vector<f64, N>)>,
    /// What the law alone asks for [N m], once it was asked to follow.
    pub wanted: Cell<Option<Vector<f64, N>>>,
}

impl<L, R, F: Feedback<L, N>, const N: usize> Asked<'_, L, R, F, N> {
    /// Motor torque [N m] for a robot that moves as `x` and follows the reference.
    pub fn follow(&self, x: &Motion<f64, N>) -> Vector<f64, N> {
        let torque = match self.known {
            Some((known, torque)) if known == *x => torque,
            _ => self.law.torque(self.robot, self.t, x, self.reference, self.memory),
        };
        self.wanted.set(Some(torque));
        torque - self.compensated
    }

    /// Motor torque [N m] for a robot that moves as `x` and shall be at `q_ld`, of a law that starts there.
    fn torque(&self, x: &Motion<f64, N>, q_ld: &Vector<Jet<f64, 5>, N>) -> Vector<f64, N> {
        self.law.torque(self.robot, self.t, x, q_ld, None) - self.compensated
    }
}

/// The law, and how it takes over: in a time and a time to settle in s.
struct Joining<'a, 'b, L, R, F, const N: usize> {
    asked: &'a Asked<'b, L, R, F, N>,
    join: (f64, f64),
}

impl<L, R, F, const N: usize> Torques<f64, N> for Joining<'_, '_, L, R, F, N>
where
    L: Links<f64, N>,
    R: Reference<f64, N>,
    F: Feedback<L, N>,
{
    fn law(&mut self, x: &Motion<f64, N>) -> Vector<f64, N> {
        self.asked.follow(x)
    }

    fn holding(&mut self, q_l: &Vector<f64, N>) -> Vector<f64, N> {
        self.asked.robot.links.gravity_torque(q_l)
    }

    fn joining(&mut self, x: &Motion<f64, N>, _: &Vector<f64, N>) -> Vector<f64, N> {
        let Asked { robot, path, t, .. } = *self.asked;
        let (duration, settle) = self.join;
        let from = coming_to_rest(robot, t, x, settle);
        self.asked.torque(x, &SmoothStart { from, duration, then: path }.at(t))
    }
}
