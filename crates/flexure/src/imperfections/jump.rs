//! Sensors that lose count.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDES, Side, Sides};
use crate::imperfections::stages::{Readings, Sensing, Tick};

/// Measured positions jump, and stay there for a while or for good: a turn counter that slips, an encoder that loses its zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Whose sensors.
    pub sides: Sides,
    /// By how much \[rad\].
    pub size: Vec<f64>,
    /// First instant with the wrong position ≥ 0 \[s\].
    pub from: f64,
    /// First instant with the right one again \[s\]; infinite for never.
    pub until: f64,
}

impl Kind for Jump {
    const NAME: &'static str = "jump";
    const SUMMARY: &'static str = "encoders that jump and stay there, for a while or for good";
    const KEYS: &'static [&'static str] = &["side", "size", "from", "until"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("size = 0.0\nfrom = 0.3"),
        little: "size = 1e-3\nfrom = 0.3\nside = \"motor\"",
        much: "size = 1e-2\nfrom = 0.3\nside = \"motor\"",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let sides = table.optional("side", |field| field.choice(SIDES));
        let size = table.per_joint("size", context.joints, &quantity::OFFSET);
        let from = table.number("from", &quantity::FROM);
        let until = table.optional("until", |field| field.number(&quantity::UNTIL));
        let (from, until) = (from?, until?.unwrap_or(f64::INFINITY));
        context.begins_before_it_ends(table, Self::NAME, from, until)?;
        Some(Self { sides: sides?.unwrap_or(Sides::Both), size: size?, from, until })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        None
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Sensing(Box::new(Jumping { jump: self.clone() }))
    }
}

/// Adds the jump while it lasts.
struct Jumping {
    jump: Jump,
}

impl Sensing for Jumping {
    fn sense(&mut self, instant: &Tick, readings: &mut Readings<'_>) {
        let Jump { sides, size, from, until } = &self.jump;
        if !instant.is_within(*from, *until) {
            return;
        }
        let jumping = readings.of.iter_mut().zip(Side::ALL).filter(|(_, side)| sides.contain(*side));
        for ([position, _], _) in jumping {
            // Adding a zero may change the sign of one.
            for (q, size) in position.iter_mut().zip(size).filter(|(_, size)| **size != 0.0) {
                *q += size;
            }
        }
    }
}

/// Nothing is remembered: the time says whether it lasts.
impl Memory<f64> for Jumping {
    fn memory(&mut self, _: &mut dyn Port<f64>) {}
}
