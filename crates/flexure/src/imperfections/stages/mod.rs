//! What sensors, computer and drives do to a control loop: one stage each, none of them there unless asked for.
//!
//! Once a control period [`Sensors`] turn the true motion into what is measured, and an [`Actuator`] turns the commanded
//! torque into what acts on the motors. Stages keep an order of their own whatever the order they are given in: noise,
//! encoders, sampling and dropouts; deadlines, current steps, saturation and torque rate, delay.

mod current;
mod deadlines;
mod delay;
mod dropout;
mod encoder;
mod held;
mod noise;
mod pieces;
mod random;
mod sampling;
mod saturation;
mod slew;

use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::Motion;

pub use current::CurrentQuantisation;
pub use deadlines::{Deadlines, Missed};
pub use delay::Delay;
pub use dropout::{Dropout, Outage};
pub use encoder::Encoder;
pub use noise::Noise;
pub use pieces::Pieces;
pub use random::Random;
pub use sampling::Sampling;
pub use saturation::Saturation;
pub use slew::Slew;

/// Links first, motors second: the order of everything that is given per side.
pub type PerSide<T> = [T; 2];

/// A control instant. Instants come one after the other from k = 0 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Which one.
    pub k: u64,
    /// When \[s\].
    pub t: f64,
    /// Until the next one \[s\].
    pub period: f64,
}

impl Tick {
    /// Instant `k` of a loop with control periods of `period` \[s\].
    pub fn new(k: u64, period: f64) -> Self {
        Self { k, t: k as f64 * period, period }
    }
}

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

    /// Positions in rad and velocities [rad/s] of links (0) or motors (1).
    fn reading(&mut self, side: usize) -> [&mut Vector<f64, N>; 2] {
        let Motion { q_l, q_m, v_l, v_m } = &mut self.motion;
        if side == 0 { [q_l, v_l] } else { [q_m, v_m] }
    }
}

/// A stage between the motion and what is read of it.
pub trait Sensing<const N: usize>: Send + Sync {
    /// Turns what the stage before delivers into what this one does.
    fn sense(&mut self, instant: &Tick, measured: &mut Measured<N>);
}

/// A stage between commanded torque and motor.
pub trait Actuating<const N: usize>: Send + Sync {
    /// Turns the torque [N m] that the stage before gives into what this one does.
    fn actuate(&mut self, instant: &Tick, torque: &mut Vector<f64, N>);
}

/// From motion to reading.
#[derive(Default)]
pub struct Sensors<const N: usize> {
    stages: Vec<Box<dyn Sensing<N>>>,
    missing: PerSide<bool>,
}

impl<const N: usize> Sensors<N> {
    /// `stages` in order, with encoders where `placed` says.
    pub fn new(placed: PerSide<bool>, stages: Vec<Box<dyn Sensing<N>>>) -> Self {
        Self { stages, missing: placed.map(|placed| !placed) }
    }

    /// What is read while the robot is at `motion`.
    pub fn sense(&mut self, instant: &Tick, motion: &Motion<f64, N>) -> Measured<N> {
        let mut measured = Measured::exactly(*motion);
        for side in (0..2).filter(|&side| self.missing[side]) {
            measured.placed[side] = false;
            for reading in measured.reading(side) {
                *reading = Vector([f64::NAN; N]);
            }
        }
        for stage in &mut self.stages {
            stage.sense(instant, &mut measured);
        }
        measured
    }
}

/// From command to torque.
#[derive(Default)]
pub struct Actuator<const N: usize> {
    stages: Vec<Box<dyn Actuating<N>>>,
    delay: Option<Delay<N>>,
}

impl<const N: usize> Actuator<N> {
    /// `stages` in order, and `delay`. A delay changes no torque, only its time, and each torque lasts for a control
    /// period: it makes no difference where among the stages it is.
    pub fn new(stages: Vec<Box<dyn Actuating<N>>>, delay: Option<Delay<N>>) -> Self {
        Self { stages, delay }
    }

    /// Motor torque over the control period that begins now, when `torque` [N m] is commanded.
    pub fn actuate(&mut self, instant: &Tick, mut torque: Vector<f64, N>) -> Pieces<N> {
        for stage in &mut self.stages {
            stage.actuate(instant, &mut torque);
        }
        match &mut self.delay {
            Some(delay) => delay.pieces(torque),
            None => Pieces::constant(torque),
        }
    }
}

impl<const N: usize> Memory<f64> for Sensors<N> {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}

impl<const N: usize> Memory<f64> for Actuator<N> {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}
