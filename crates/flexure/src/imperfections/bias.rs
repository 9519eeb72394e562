//! Sensors that are off by the same everywhere.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{PerSide, Readings, Sensing, Tick};

/// What is added to every measured position, as by an encoder that was not calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Bias {
    /// To those of the links \[rad\].
    pub link: Vec<f64>,
    /// To those of the motors \[rad\].
    pub motor: Vec<f64>,
}

impl Kind for Bias {
    const NAME: &'static str = "bias";
    const SUMMARY: &'static str = "encoders that are off by the same everywhere";
    const KEYS: &'static [&'static str] = &["link", "motor"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("link = 0.0"), little: "motor = 1e-3", much: "motor = 1e-2" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        if Self::KEYS.iter().all(|key| table.get(key).is_none()) {
            table.error(
                "missing-key",
                "bias: neither link nor motor is given",
                "give at least one, in rad per joint",
            );
            return None;
        }
        let read = |key| table.per_joint_or_zero(key, context.joints, &quantity::OFFSET);
        let (link, motor) = (read("link"), read("motor"));
        Some(Self { link: link?, motor: motor? })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Sensing(Box::new(Off { by: [self.link.clone(), self.motor.clone()] }))
    }
}

/// Adds the same to every position.
struct Off {
    by: PerSide<Vec<f64>>,
}

impl Sensing for Off {
    fn sense(&mut self, _: &Tick, readings: &mut Readings<'_>) {
        for ([position, _], by) in readings.of.iter_mut().zip(&self.by) {
            // Adding a zero may change the sign of one.
            for (q, by) in position.iter_mut().zip(by).filter(|(_, by)| **by != 0.0) {
                *q += by;
            }
        }
    }
}

/// Nothing is remembered.
impl Memory<f64> for Off {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}
