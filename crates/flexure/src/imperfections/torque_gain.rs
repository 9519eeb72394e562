//! Drives whose torque constant is another than they believe.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};

/// Motors give more or less torque than their drives believe to give.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueGain {
    /// What the torque is multiplied by > 0.
    pub factor: Vec<f64>,
}

impl Kind for TorqueGain {
    const NAME: &'static str = "torque-gain";
    const SUMMARY: &'static str = "drives that give more or less torque than is asked for";
    const KEYS: &'static [&'static str] = &["factor"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("factor = 1.0"), little: "factor = 0.95", much: "factor = 0.6" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let factor = table.per_joint("factor", context.joints, &quantity::TORQUE_FACTOR)?;
        Some(Self { factor })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Joints(Box::new(|joints| joints.torque_gain.copy_from_slice(&self.factor)))
    }
}
