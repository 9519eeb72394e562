//! A computer that stands still.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};

/// The computer does nothing for a while: no sensor is read, nobody decides, no command comes, and the clock goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stall {
    /// First control instant at which it stands still ≥ 0 \[s\].
    pub from: f64,
    /// First one at which it runs again \[s\].
    pub until: f64,
}

impl Kind for Stall {
    const NAME: &'static str = "stall";
    const SUMMARY: &'static str = "a computer that stands still for a while, as its clock does not";
    const KEYS: &'static [&'static str] = &["from", "until"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths =
        Strengths { none: None, little: "from = 0.4\nuntil = 0.404", much: "from = 0.4\nuntil = 0.412" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let (from, until) = (table.number("from", &quantity::FROM), table.number("until", &quantity::UNTIL));
        let (from, until) = (from?, until?);
        context.begins_before_it_ends(table, Self::NAME, from, until)?;
        Some(Self { from, until })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        None
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Stall([self.from, self.until])
    }
}
