//! From motion to reading.

use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::Motion;

use crate::imperfections::stages::{PerSide, Tick};

/// What the controller reads at a control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<const N: usize> {
    /// Readings; NaN where nothing came, or nothing is placed.
    pub motion: Motion<f64, N>,
    /// Control periods since the readings were delivered: 0 for fresh ones.
    pub age: PerSide<u32>,
    /// Where encoders are: a side without them always reads NaN.
    pub placed: PerSide<bool>,
}

impl<const N: usize> Measured<N> {
    /// The motion itself, as ideal sensors deliver it.
    pub fn exactly(motion: Motion<f64, N>) -> Self {
        Self { motion, age: [0; 2], placed: [true; 2] }
    }

    /// What is read of the first `joints` joints.
    fn readings(&mut self, joints: usize) -> Readings<'_> {
        let Motion { q_l, q_m, v_l, v_m } = &mut self.motion;
        let [q_l, q_m, v_l, v_m] = [q_l, q_m, v_l, v_m].map(|Vector(all)| &mut all[..joints]);
        Readings { of: [[q_l, v_l], [q_m, v_m]], age: &mut self.age }
    }
}

/// Readings on their way through the stages, one entry per joint of the robot.
pub struct Readings<'a> {
    /// Positions in rad and velocities [rad/s] of links, then of motors.
    pub of: PerSide<[&'a mut [f64]; 2]>,
    /// Control periods since the readings were delivered.
    pub age: &'a mut PerSide<u32>,
}

/// A stage between the motion and what is read of it.
pub trait Sensing: Memory<f64> + Send + Sync {
    /// Turns what the stage before delivers into what this one does. Nothing is allocated.
    fn sense(&mut self, instant: &Tick, readings: &mut Readings<'_>);

    /// Where it puts sensors, if it says so: what no stage puts sensors on is not measured once some stage says so.
    fn placed(&self) -> Option<PerSide<bool>> {
        None
    }
}

/// From motion to reading; ideal sensors by default.
#[derive(Default)]
pub struct Sensors {
    joints: usize,
    /// Each with the kind that it is of.
    stages: Vec<(&'static str, Box<dyn Sensing>)>,
    missing: PerSide<bool>,
}

impl Sensors {
    /// Of a robot with so many `joints`, with `stages` of named kinds in order.
    pub fn new(joints: usize, stages: Vec<(&'static str, Box<dyn Sensing>)>) -> Self {
        let mut places = stages.iter().filter_map(|(_, stage)| stage.placed()).peekable();
        let missing = if places.peek().is_none() {
            [false; 2]
        } else {
            places.fold([true; 2], |[link, motor], placed| [link && !placed[0], motor && !placed[1]])
        };
        Self { joints, stages, missing }
    }

    /// Whether they read how the robot moves, as it is.
    pub(crate) fn are_ideal(&self) -> bool {
        self.stages.is_empty() && self.missing == [false; 2]
    }

    /// What is read while the robot is at `motion`. Joints beyond those of the robot are read as they are: at rest. Nothing is
    /// allocated.
    ///
    /// # Panics
    /// If the robot has more joints than `N`.
    pub fn sense<const N: usize>(&mut self, instant: &Tick, motion: &Motion<f64, N>) -> Measured<N> {
        let mut measured = Measured::exactly(*motion);
        measured.placed = self.missing.map(|missing| !missing);
        let mut readings = measured.readings(self.joints);
        for (of, _) in readings.of.iter_mut().zip(self.missing).filter(|(_, missing)| *missing) {
            for reading in of {
                reading.fill(f64::NAN);
            }
        }
        for (_, stage) in &mut self.stages {
            stage.sense(instant, &mut readings);
        }
        measured
    }
}

/// What each stage remembers, in order, under the name of its kind.
impl Memory<f64> for Sensors {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (kind, stage) in &mut self.stages {
            port.part(kind, stage.as_mut());
        }
    }
}
