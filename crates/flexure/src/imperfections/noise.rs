//! White measurement noise.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{PerSide, Random, Readings, Sensing, Tick};

/// Standard deviations ≥ 0 of white noise, drawn anew at every control instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Of link positions \[rad\].
    pub link: Vec<f64>,
    /// Of motor positions \[rad\].
    pub motor: Vec<f64>,
    /// Of link velocities [rad/s].
    pub link_velocity: Vec<f64>,
    /// Of motor velocities [rad/s].
    pub motor_velocity: Vec<f64>,
}

impl Kind for Noise {
    const NAME: &'static str = "noise";
    const SUMMARY: &'static str = "white noise on measured positions and velocities";
    const KEYS: &'static [&'static str] = &["link", "motor", "link_velocity", "motor_velocity"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("link = 0.0"),
        little: "link = 1e-3\nmotor = 1e-3\nlink_velocity = 1e-3\nmotor_velocity = 1e-3",
        much: "link = 1e-2\nmotor = 1e-2\nlink_velocity = 1e-2\nmotor_velocity = 1e-2",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        if Self::KEYS.iter().all(|key| table.get(key).is_none()) {
            table.error(
                "missing-key",
                "noise: no standard deviation is given",
                "give at least one of link and motor in rad, link_velocity and motor_velocity in rad/s",
            );
            return None;
        }
        let read = |key, quantity: &Quantity| table.per_joint_or_zero(key, context.joints, quantity);
        let (link, motor) = (read("link", &quantity::NOISE), read("motor", &quantity::NOISE));
        let link_velocity = read("link_velocity", &quantity::VELOCITY_NOISE);
        let motor_velocity = read("motor_velocity", &quantity::VELOCITY_NOISE);
        Some(Self {
            link: link?,
            motor: motor?,
            link_velocity: link_velocity?,
            motor_velocity: motor_velocity?,
        })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn draws(&self) -> bool {
        let Self { link, motor, link_velocity, motor_velocity } = self;
        [link, motor, link_velocity, motor_velocity].into_iter().flatten().any(|&deviation| deviation > 0.0)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let Self { link, motor, link_velocity, motor_velocity } = self.clone();
        let deviations = [[link, link_velocity], [motor, motor_velocity]];
        Effect::Sensing(Box::new(Noisy { deviations, random: setup.random }))
    }
}

/// Adds independent normal numbers: 4 for each joint at every control instant, whatever the deviations.
struct Noisy {
    /// Standard deviations of positions and velocities.
    deviations: PerSide<[Vec<f64>; 2]>,
    random: Random,
}

impl Sensing for Noisy {
    fn sense(&mut self, _: &Tick, readings: &mut Readings<'_>) {
        let reading = readings.of.as_flattened_mut().iter_mut();
        for (reading, deviations) in reading.zip(self.deviations.as_flattened()) {
            for (x, deviation) in reading.iter_mut().zip(deviations) {
                let normal = self.random.normal();
                // Adding a zero may change the sign of one.
                if *deviation > 0.0 {
                    *x += deviation * normal;
                }
            }
        }
    }
}

/// `random`: the state of the stream.
impl Memory<f64> for Noisy {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.part("random", &mut self.random);
    }
}
