//! Torque that comes late.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};

/// Times that pass between a control instant and the torque that it commands, ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delay {
    /// Of the law \[s\].
    pub computation: f64,
    /// Of the drive \[s\].
    pub actuation: f64,
}

impl Delay {
    /// From the control instant to the torque \[s\].
    pub fn total(&self) -> f64 {
        self.computation + self.actuation
    }
}

impl Kind for Delay {
    const NAME: &'static str = "delay";
    const SUMMARY: &'static str = "torque that comes late, by any fraction of control periods";
    const KEYS: &'static [&'static str] = &["computation", "actuation"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("actuation = 0.0"),
        little: "computation = 4e-4",
        much: "computation = 4e-4\nactuation = 2.3e-3",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let read = |key| table.optional(key, |field| field.number(&quantity::DELAY));
        let (computation, actuation) = (read("computation"), read("actuation"));
        let (computation, actuation) = (computation?, actuation?);
        if computation.is_none() && actuation.is_none() {
            table.error(
                "missing-key",
                "delay: neither computation nor actuation is given",
                "give at least one, in s; they add up, and need be no multiples of the control period",
            );
            return None;
        }
        let delay = Self { computation: computation.unwrap_or(0.0), actuation: actuation.unwrap_or(0.0) };
        if let Some((duration, _)) = context.times
            && delay.total() >= duration
        {
            let message = format!("the delay is {} s, must be < duration, {duration} s", delay.total());
            table.error("range", message, "no torque would arrive during the run; is it in milliseconds?");
            return None;
        }
        Some(delay)
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Delay(self.total())
    }
}
