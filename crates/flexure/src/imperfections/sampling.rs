//! Sensors that are slower than the law.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDES, Side, Sides};
use crate::imperfections::stages::{Held, PerSide, Readings, Sensing, Tick};

/// Sensors deliver every so many control periods, at t = 0 first, and are held in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Whose sensors.
    pub sides: Sides,
    /// Control periods from one delivery to the next, ≥ 1.
    pub periods: u32,
}

/// Largest part of a control period that a sensor period may be off a multiple without an error: decimals are inexact.
const UNEVEN: f64 = 1e-6;

impl Kind for Sampling {
    const NAME: &'static str = "sampling";
    const SUMMARY: &'static str = "sensors that deliver every so many control periods";
    const KEYS: &'static [&'static str] = &["side", "period"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: Some("period = 0.002"), little: "period = 0.006", much: "period = 0.020" };

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 5e6 periods in a run")]
    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let sides = table.optional("side", |field| field.choice(SIDES));
        let period = table.number("period", &quantity::SENSOR_PERIOD);
        let (sides, period) = (sides?.unwrap_or(Sides::Both), period?);
        let (duration, control) = context.times?;
        let field = table.get("period")?;
        let periods = (period / control).round();
        if (period / control - periods).abs() > UNEVEN || periods < 1.0 {
            let near = control * periods.max(1.0);
            field.error(
                "range",
                format!("{} is {period} s, must be a multiple of control_period, {control} s", field.path),
                format!("the nearest is {} s", quantity::shortest((near * 1e9).round() / 1e9)),
            );
            return None;
        }
        if period > duration {
            let message = format!("{} is {period} s, must be <= duration, {duration} s", field.path);
            field.error("range", message, "sensors would deliver once, at t = 0 s");
            return None;
        }
        Some(Self { sides, periods: periods as u32 })
    }

    fn overlap(&self, earlier: &Self) -> Option<Overlap> {
        Overlap::sides(|side| self.sides.contain(side) && earlier.sides.contain(side))
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let held = [(); 2].map(|()| Held::nothing(setup.joints));
        Effect::Sensing(Box::new(Slow { sampling: *self, held }))
    }
}

/// Holds the readings of slow sensors.
struct Slow {
    sampling: Sampling,
    held: PerSide<Held>,
}

impl Sensing for Slow {
    fn sense(&mut self, instant: &Tick, readings: &mut Readings<'_>) {
        let delivers = instant.k.is_multiple_of(u64::from(self.sampling.periods));
        let sides = self.sampling.sides;
        let slow = self.held.iter_mut().enumerate().filter(|(i, _)| sides.contain(Side::ALL[*i]));
        for (side, held) in slow {
            if delivers {
                held.keep(readings, side);
            } else {
                held.give(readings, side);
            }
        }
    }
}

/// What is held of `link` and `motor`: `position`, `velocity` and `age`.
impl Memory<f64> for Slow {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (side, held) in Side::ALL.into_iter().zip(&mut self.held) {
            port.part(side.name(), held);
        }
    }
}
