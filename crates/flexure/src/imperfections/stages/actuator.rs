//! From command to torque.

use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};

use crate::imperfections::stages::late::Late;
use crate::imperfections::stages::{Pieces, Tick};

/// A stage between commanded torque and motor.
pub trait Actuating: Memory<f64> + Send + Sync {
    /// Starts with the torque [N m] that acts until the first command does.
    fn start(&mut self, torque: &[f64]);

    /// Turns the torque [N m] that the stage before gives into what this one does. Nothing is allocated.
    fn actuate(&mut self, instant: &Tick, torque: &mut [f64]);

    /// Largest torques [N m], one a joint, if all that it does is to cut others to them.
    fn limits(&self) -> Option<&[f64]> {
        None
    }
}

/// From command to torque; an ideal drive by default.
#[derive(Default)]
pub struct Actuator {
    joints: usize,
    /// Each with the kind that it is of.
    stages: Vec<(&'static str, Box<dyn Actuating>)>,
    late: Late,
}

impl Actuator {
    /// Of a robot with so many `joints`: `stages` of named kinds in order, and a `delay` in a loop with control periods of
    /// `period` \[s\]. A delay changes no torque, only its time, and each torque lasts for a control period: it makes no
    /// difference where among the stages it is. Until it is [started](Self::start), no torque acts.
    pub fn new(
        joints: usize,
        stages: Vec<(&'static str, Box<dyn Actuating>)>,
        delay: f64,
        period: f64,
    ) -> Self {
        Self { joints, stages, late: Late::new(joints, delay, period) }
    }

    /// Starts with the torque [N m] that acts until the first command does.
    ///
    /// # Panics
    /// If the robot has more joints than `N`.
    pub fn start<const N: usize>(&mut self, torque: &Vector<f64, N>) {
        let torque = &torque.0[..self.joints];
        for (_, stage) in &mut self.stages {
            stage.start(torque);
        }
        self.late.start(torque);
    }

    /// Largest torques [N m] that act at once, as they are commanded, in both directions, infinite for joints without; none if something else than
    /// limits is between command and torque.
    pub(crate) fn limits<const N: usize>(&self) -> Option<Vector<f64, N>> {
        let mut limits = Vector([f64::INFINITY; N]);
        for (_, stage) in &self.stages {
            for (least, limit) in limits.0.iter_mut().zip(stage.limits()?) {
                *least = least.min(*limit);
            }
        }
        self.late.is_none().then_some(limits)
    }

    /// Motor torque over the control period that begins now, when `torque` [N m] is commanded. Nothing is allocated.
    ///
    /// # Panics
    /// If the robot has more joints than `N`.
    pub fn actuate<const N: usize>(&mut self, instant: &Tick, mut torque: Vector<f64, N>) -> Pieces<N> {
        for (_, stage) in &mut self.stages {
            stage.actuate(instant, &mut torque.0[..self.joints]);
        }
        let mut then = torque;
        let change = self.late.pass(&mut torque.0[..self.joints], &mut then.0[..self.joints]);
        match change {
            None => Pieces::constant(torque),
            Some(offset) => Pieces::changing(torque, offset, then),
        }
    }
}

/// What each stage remembers, in order, under the name of its kind, then `delay`: torques on their way.
impl Memory<f64> for Actuator {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (kind, stage) in &mut self.stages {
            port.part(kind, stage.as_mut());
        }
        port.part("delay", &mut self.late);
    }
}
