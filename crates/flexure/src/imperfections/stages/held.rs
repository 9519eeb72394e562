//! Readings that are kept while no new ones come.

use flexure_core::memory::{Memory, Port};

use crate::imperfections::stages::Readings;

/// The last readings of one side.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    position: Vec<f64>,
    velocity: Vec<f64>,
    age: u32,
}

impl Held {
    /// Before anything came of so many `joints`.
    pub fn nothing(joints: usize) -> Self {
        let nothing = vec![f64::NAN; joints];
        Self { position: nothing.clone(), velocity: nothing, age: 0 }
    }

    /// Keeps what is read of `side`.
    pub fn keep(&mut self, readings: &Readings<'_>, side: usize) {
        let [position, velocity] = &readings.of[side];
        self.position.copy_from_slice(position);
        self.velocity.copy_from_slice(velocity);
        self.age = readings.age[side];
    }

    /// Gives what was kept instead of what is read of `side`, a control period older than last time.
    pub fn give(&mut self, readings: &mut Readings<'_>, side: usize) {
        self.age = self.age.saturating_add(1);
        readings.age[side] = self.age;
        let [position, velocity] = &mut readings.of[side];
        position.copy_from_slice(&self.position);
        velocity.copy_from_slice(&self.velocity);
    }
}

/// `position` in rad, `velocity` [rad/s], `age` in control periods.
impl Memory<f64> for Held {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.joints("position", "rad", &mut self.position);
        port.joints("velocity", "rad/s", &mut self.velocity);
        port.word("age", &mut self.age);
    }
}
