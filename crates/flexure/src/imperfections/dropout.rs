//! Sensors that fall silent for a while.

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDES, Side, Sides};
use crate::imperfections::stages::{Held, PerSide, Random, Readings, Sensing, Tick};

/// Sensors deliver nothing for a while; all that drops out in one entry drops out together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dropout {
    /// Whose sensors.
    pub sides: Sides,
    /// What is read meanwhile.
    pub mode: DropoutMode,
    /// When.
    pub outage: Outage,
}

/// What is read while nothing is delivered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropoutMode {
    /// The last reading.
    Hold,
    /// NaN.
    Nan,
}

/// When sensors deliver nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outage {
    /// At control instants in [`from`, `until`).
    Window {
        /// First instant without a reading \[s\].
        from: f64,
        /// First instant with one again \[s\].
        until: f64,
    },
    /// By chance, which is drawn from one number a control instant.
    Random {
        /// That a sound sensor drops out, per control instant, in [0, 1].
        probability: f64,
        /// Mean length of an outage ≥ 1 [control periods]; lengths are geometric.
        mean_length: f64,
    },
}

impl Kind for Dropout {
    const NAME: &'static str = "dropout";
    const SUMMARY: &'static str = "sensors that fall silent for a while, holding or giving NaN";
    const KEYS: &'static [&'static str] = &["side", "mode", "from", "until", "probability", "mean_length"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("probability = 0.0"),
        little: "mode = \"hold\"\nprobability = 0.01\nmean_length = 4.0",
        much: "mode = \"hold\"\nprobability = 0.2\nmean_length = 4.0",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let sides = table.optional("side", |field| field.choice(SIDES));
        let modes = [("hold", DropoutMode::Hold), ("nan", DropoutMode::Nan)];
        let mode = table.optional("mode", |field| field.choice(&modes));
        let by_chance = ["probability", "mean_length"].map(|key| table.get(key));
        let by_time = ["from", "until"].iter().any(|key| table.get(key).is_some());
        let outage = match (by_time, by_chance) {
            (true, [None, None]) => window(table, context),
            (false, [Some(probability), mean_length]) => {
                let probability = probability.number(&quantity::PROBABILITY);
                let mean_length = mean_length.map_or(Some(1.0), |field| field.number(&quantity::MEAN_LENGTH));
                Some(Outage::Random { probability: probability?, mean_length: mean_length? })
            }
            _ => {
                table.error(
                    "missing-key",
                    "dropout: either from and until, or probability and mean_length must be given",
                    "from and until in s; probability per control period; mean_length in control periods",
                );
                None
            }
        };
        Some(Self {
            sides: sides?.unwrap_or(Sides::Both),
            mode: mode?.unwrap_or(DropoutMode::Nan),
            outage: outage?,
        })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        None
    }

    fn draws(&self) -> bool {
        matches!(self.outage, Outage::Random { probability, .. } if probability > 0.0)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let held = [(); 2].map(|()| Held::nothing(setup.joints));
        Effect::Sensing(Box::new(Silence { dropout: *self, random: setup.random, is_out: false, held }))
    }
}

fn window(table: &Table<'_>, context: &Context<'_>) -> Option<Outage> {
    let from = table.number("from", &quantity::FROM);
    let until = table.number("until", &quantity::UNTIL);
    let (from, until) = (from?, until?);
    context.begins_before_it_ends(table, Dropout::NAME, from, until)?;
    Some(Outage::Window { from, until })
}

/// Withholds readings during outages.
struct Silence {
    dropout: Dropout,
    random: Random,
    is_out: bool,
    held: PerSide<Held>,
}

impl Outage {
    /// Whether nothing comes now, if at the last control instant that `was_out`.
    fn goes_on(self, instant: &Tick, was_out: bool, random: &mut Random) -> bool {
        match self {
            Self::Window { from, until } => instant.is_within(from, until),
            Self::Random { probability, mean_length } => {
                let chance = random.uniform();
                if was_out { chance >= 1.0 / mean_length } else { chance < probability }
            }
        }
    }
}

impl Sensing for Silence {
    fn sense(&mut self, instant: &Tick, readings: &mut Readings<'_>) {
        self.is_out = self.dropout.outage.goes_on(instant, self.is_out, &mut self.random);
        let sides = self.dropout.sides;
        let silent = self.held.iter_mut().enumerate().filter(|(i, _)| sides.contain(Side::ALL[*i]));
        for (side, held) in silent {
            if !self.is_out {
                held.keep(readings, side);
                continue;
            }
            held.give(readings, side);
            if self.dropout.mode == DropoutMode::Nan {
                for reading in &mut readings.of[side] {
                    reading.fill(f64::NAN);
                }
            }
        }
    }
}

/// `random`, the state of the stream; whether it is `out`; what is held of `link` and `motor`: `position`, `velocity` and
/// `age`.
impl Memory<f64> for Silence {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.part("random", &mut self.random);
        port.flag("out", &mut self.is_out);
        for (side, held) in Side::ALL.into_iter().zip(&mut self.held) {
            port.part(side.name(), held);
        }
    }
}
