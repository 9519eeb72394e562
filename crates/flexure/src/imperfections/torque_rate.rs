//! Drives whose torque changes so fast and no faster.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{Actuating, Tick};
use crate::robot::Robot;

/// How much the motor torque changes from one control period to the next is limited.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueRate {
    /// Largest rate > 0 [N m/s].
    pub limit: Vec<f64>,
}

impl Kind for TorqueRate {
    const NAME: &'static str = "torque-rate";
    const SUMMARY: &'static str = "largest rate of the motor torque";
    const KEYS: &'static [&'static str] = &["limit"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("limit = 1e8"), little: "limit = 50.0", much: "limit = 20.0" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let default = ("torque_rate_limit", |robot: &Robot| robot.limits.torque_rate.clone());
        let limit = context.limit(table, &quantity::TORQUE_RATE_LIMIT, default)?;
        Some(Self { limit })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        Effect::Actuating(Box::new(Slew { rate: self.limit.clone(), last: vec![0.0; setup.joints] }))
    }
}

/// Limits how much torque changes.
struct Slew {
    rate: Vec<f64>,
    last: Vec<f64>,
}

impl Actuating for Slew {
    fn start(&mut self, torque: &[f64]) {
        self.last.copy_from_slice(torque);
    }

    fn actuate(&mut self, instant: &Tick, torque: &mut [f64]) {
        for ((torque, last), rate) in torque.iter_mut().zip(&mut self.last).zip(&self.rate) {
            let most = rate * instant.period;
            *torque = torque.clamp(*last - most, *last + most);
            // From a number that is none there is no way back.
            if torque.is_finite() {
                *last = *torque;
            }
        }
    }
}

/// The last `torque` [N m].
impl Memory<f64> for Slew {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.joints("torque", "N m", &mut self.last);
    }
}
