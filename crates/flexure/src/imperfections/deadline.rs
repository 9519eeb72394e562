//! A computer that is late at times.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{Missing, Random, Tick};

/// Control instants that the law misses: the last command stays for a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deadline {
    /// Each with this probability in [0, 1], which is drawn from one number a control instant.
    Random {
        /// Per control instant.
        probability: f64,
    },
    /// Each `every`-th, ≥ 2, counted from 1 at t = 0.
    Every(u32),
}

impl Kind for Deadline {
    const NAME: &'static str = "deadline";
    const SUMMARY: &'static str = "control instants that the law misses";
    const KEYS: &'static [&'static str] = &["probability", "every"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("probability = 0.0"),
        little: "probability = 0.05",
        much: "probability = 0.5",
    };

    fn read(table: &Table<'_>, _: &Context<'_>) -> Option<Self> {
        match (table.get("probability"), table.get("every")) {
            (Some(field), None) => Some(Self::Random { probability: field.number(&quantity::PROBABILITY)? }),
            (None, Some(field)) => {
                let every =
                    field.whole("each so many-th control instant is missed", 2, u64::from(u32::MAX))?;
                Some(Self::Every(u32::try_from(every).ok()?))
            }
            _ => {
                table.error(
                    "missing-key",
                    "deadline: either probability or every must be given",
                    "probability per control instant, or every = 10 for each tenth",
                );
                None
            }
        }
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn draws(&self) -> bool {
        matches!(self, Self::Random { probability } if *probability > 0.0)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        Effect::Missing(Box::new(Late { deadline: *self, random: setup.random }))
    }
}

/// Keeps commands back.
struct Late {
    deadline: Deadline,
    random: Random,
}

impl Missing for Late {
    fn misses(&mut self, instant: &Tick) -> bool {
        match self.deadline {
            Deadline::Random { probability } => self.random.uniform() < probability,
            Deadline::Every(every) => (instant.k + 1).is_multiple_of(u64::from(every)),
        }
    }
}

/// `random`, the state of the stream.
impl Memory<f64> for Late {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.part("random", &mut self.random);
    }
}
