//! Drives whose current comes in steps.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::encoder::rounded;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{Actuating, Tick};

/// Motor torque comes in steps, the nearest.
#[derive(Clone, Debug, PartialEq)]
pub struct CurrentQuantisation {
    /// One step ≥ 0 [N m].
    pub step: Vec<f64>,
}

impl Kind for CurrentQuantisation {
    const NAME: &'static str = "current-quantisation";
    const SUMMARY: &'static str = "motor torque in steps";
    const KEYS: &'static [&'static str] = &["step"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("step = 0.0"), little: "step = 0.05", much: "step = 0.5" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let step = table.per_joint("step", context.joints, &quantity::TORQUE_STEP)?;
        Some(Self { step })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Actuating(Box::new(self.clone()))
    }
}

impl Actuating for CurrentQuantisation {
    fn start(&mut self, _: &[f64]) {}

    fn actuate(&mut self, _: &Tick, torque: &mut [f64]) {
        for (torque, step) in torque.iter_mut().zip(&self.step) {
            *torque = rounded(*torque, *step, 0.0);
        }
    }
}

/// Nothing.
impl Memory<f64> for CurrentQuantisation {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}
