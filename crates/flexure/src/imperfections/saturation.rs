//! Drives that give so much torque and no more.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{Actuating, Tick};
use crate::robot::Robot;

/// Motor torque is cut at a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Saturation {
    /// Largest torque > 0 [N m].
    pub limit: Vec<f64>,
}

impl Kind for Saturation {
    const NAME: &'static str = "saturation";
    const SUMMARY: &'static str = "largest motor torque";
    const KEYS: &'static [&'static str] = &["limit"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("limit = 1e9"), little: "limit = 1.9", much: "limit = 1.0" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let default = ("torque_limit", |robot: &Robot| robot.limits.torque.clone());
        let limit = context.limit(table, &quantity::TORQUE_LIMIT, default)?;
        Some(Self { limit })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Actuating(Box::new(self.clone()))
    }
}

impl Actuating for Saturation {
    fn start(&mut self, _: &[f64]) {}

    fn actuate(&mut self, _: &Tick, torque: &mut [f64]) {
        for (torque, limit) in torque.iter_mut().zip(&self.limit) {
            *torque = torque.clamp(-limit, *limit);
        }
    }

    fn limits(&self) -> Option<&[f64]> {
        Some(&self.limit)
    }
}

/// Nothing.
impl Memory<f64> for Saturation {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}
