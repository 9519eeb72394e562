//! Sensors that get stuck and do not say so.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDES, Side, Sides};
use crate::imperfections::stages::{Held, PerSide, Readings, Sensing, Tick};

/// Measured positions and velocities stay what they are, for a while or for good, and look as fresh as ever: a dropout says that it is
/// one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freeze {
    /// Whose sensors.
    pub sides: Sides,
    /// First instant with the reading of the instant before ≥ 0 \[s\].
    pub from: f64,
    /// First instant with one of its own again \[s\]; infinite for never.
    pub until: f64,
}

impl Kind for Freeze {
    const NAME: &'static str = "freeze";
    const SUMMARY: &'static str = "sensors that get stuck and look fresh, for a while or for good";
    const KEYS: &'static [&'static str] = &["side", "from", "until"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: None,
        little: "from = 0.4\nuntil = 0.404\nside = \"motor\"",
        much: "from = 0.4\nuntil = 0.44\nside = \"motor\"",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let sides = table.optional("side", |field| field.choice(SIDES));
        let from = table.number("from", &quantity::FROM);
        let until = table.optional("until", |field| field.number(&quantity::UNTIL));
        let (from, until) = (from?, until?.unwrap_or(f64::INFINITY));
        context.begins_before_it_ends(table, Self::NAME, from, until)?;
        Some(Self { sides: sides?.unwrap_or(Sides::Both), from, until })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        None
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let held = [(); 2].map(|()| Held::nothing(setup.joints));
        Effect::Sensing(Box::new(Stuck { freeze: *self, held }))
    }
}

/// Gives the last reading from before, at the age that a fresh one has.
struct Stuck {
    freeze: Freeze,
    held: PerSide<Held>,
}

impl Sensing for Stuck {
    fn sense(&mut self, instant: &Tick, readings: &mut Readings<'_>) {
        let Freeze { sides, from, until } = self.freeze;
        let stuck = self.held.iter_mut().enumerate().filter(|(i, _)| sides.contain(Side::ALL[*i]));
        for (side, held) in stuck {
            if instant.is_within(from, until) {
                let age = readings.age[side];
                held.give(readings, side);
                readings.age[side] = age;
            } else {
                held.keep(readings, side);
            }
        }
    }
}

/// What is held of `link` and `motor`: `position`, `velocity` and `age`.
impl Memory<f64> for Stuck {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (side, held) in Side::ALL.into_iter().zip(&mut self.held) {
            port.part(side.name(), held);
        }
    }
}
