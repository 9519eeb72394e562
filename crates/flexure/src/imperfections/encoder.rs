//! Encoders: positions in whole counts.

use flexure_core::memory::{Memory, Port};

use crate::files::field::Field;
use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDES, Side, Sides};
use crate::imperfections::stages::{PerSide, Random, Readings, Sensing, Tick};
use crate::robot::JointKind;

/// Positions come in whole counts, the nearest. Where some encoder is described, a side without one is not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoder {
    /// One count ≥ 0 of the link encoders \[rad\]; none if this entry places none there.
    pub link: Option<Vec<f64>>,
    /// One count ≥ 0 of the motor encoders, link side of the gear \[rad\]; none if this entry places none there.
    pub motor: Option<Vec<f64>>,
    /// Whether noise of half a count to either side, uniform, is added before rounding: it makes the mean of many readings
    /// exact.
    pub dither: bool,
}

impl Encoder {
    /// One count on `side` \[rad\], if the entry places an encoder there.
    pub fn resolution(&self, side: Side) -> Option<&[f64]> {
        match side {
            Side::Link => self.link.as_deref(),
            Side::Motor => self.motor.as_deref(),
        }
    }
}

impl Kind for Encoder {
    const NAME: &'static str = "encoder";
    const SUMMARY: &'static str = "positions in counts, with or without dither, on links, motors or both";
    const KEYS: &'static [&'static str] = &["placement", "counts_per_turn", "resolution", "dither"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: Some("resolution = 0.0"),
        little: "resolution = 1e-3",
        much: "resolution = 1e-2\ndither = true",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let placement = table.optional("placement", |field| field.choice(SIDES));
        let dither = table.optional("dither", Field::boolean);
        let counts =
            table.optional("counts_per_turn", |field| field.per_joint(context.joints, &quantity::COUNTS));
        let resolution =
            table.optional("resolution", |field| field.per_joint(context.joints, &quantity::RESOLUTION));
        let sides = placement?.unwrap_or(Sides::Both);
        let (counts, resolution) = (counts?, resolution?);
        let of = |side: Side| match (&counts, &resolution) {
            _ if !sides.contain(side) => Some(None),
            (Some(counts), None) => of_counts(table, context, side, counts).map(Some),
            (None, Some(resolution)) => Some(Some(resolution.clone())),
            _ => None,
        };
        if counts.is_some() == resolution.is_some() {
            let (have, code) = if counts.is_some() { ("both", "unused") } else { ("neither", "missing-key") };
            table.error(
                code,
                format!("encoder: {have} of counts_per_turn and resolution given, must be one of them"),
                "counts_per_turn of the shaft that the encoder sits on, or resolution in rad on the link side of the gear",
            );
        }
        let (link, motor) = (of(Side::Link), of(Side::Motor));
        Some(Self { link: link?, motor: motor?, dither: dither?.unwrap_or(false) })
    }

    fn overlap(&self, earlier: &Self) -> Option<Overlap> {
        Overlap::sides(|side| self.resolution(side).is_some() && earlier.resolution(side).is_some())
    }

    fn draws(&self) -> bool {
        self.dither
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let dither = self.dither.then_some(setup.random);
        Effect::Sensing(Box::new(Rounding { encoder: self.clone(), dither }))
    }
}

/// One count in rad on the link side of the gear, of encoders with so many counts per turn of their shaft.
fn of_counts(table: &Table<'_>, context: &Context<'_>, side: Side, counts: &[f64]) -> Option<Vec<f64>> {
    let robot = context.robot?;
    let field = table.get("counts_per_turn")?;
    let turn = 2.0 * std::f64::consts::PI;
    match (side, &robot.gear_ratio) {
        (Side::Motor, Some(gears)) => {
            Some(counts.iter().zip(gears).map(|(counts, gear)| turn / (counts * gear.abs())).collect())
        }
        (Side::Motor, None) => {
            field.error(
                "missing-key",
                format!("{} is per motor turn, but robot {} has no gear ratios", field.path, robot.name),
                "add gear_ratio to [joints] of the robot file, motor turns per joint turn, or give resolution in rad",
            );
            None
        }
        (Side::Link, _) => {
            if let Some(joint) = robot.joints.iter().find(|joint| joint.kind == JointKind::Prismatic) {
                let message = format!("{}: joint {} does not turn its link", field.path, joint.name);
                field.error("unused", message, "give resolution, in m for a prismatic joint");
                return None;
            }
            Some(counts.iter().map(|counts| turn / counts).collect())
        }
    }
}

/// Rounds positions, with dither from a number for each joint with an encoder.
struct Rounding {
    encoder: Encoder,
    dither: Option<Random>,
}

impl Sensing for Rounding {
    fn sense(&mut self, _: &Tick, readings: &mut Readings<'_>) {
        for (side, [position, _]) in Side::ALL.into_iter().zip(&mut readings.of) {
            let Some(resolution) = self.encoder.resolution(side) else { continue };
            for (x, step) in position.iter_mut().zip(resolution) {
                let dither = self.dither.as_mut().map_or(0.0, |random| random.uniform() - 0.5);
                *x = rounded(*x, *step, dither);
            }
        }
    }

    fn placed(&self) -> Option<PerSide<bool>> {
        Some(Side::ALL.map(|side| self.encoder.resolution(side).is_some()))
    }
}

/// `random`: the state of the stream that dither comes from, if there is dither.
impl Memory<f64> for Rounding {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        if let Some(random) = &mut self.dither {
            port.part("random", random);
        }
    }
}

/// `x` and `shift` steps, to the nearest multiple of `step`; `x` itself if that is 0.
pub(super) fn rounded(x: f64, step: f64, shift: f64) -> f64 {
    if step > 0.0 { (x / step + shift).round() * step } else { x }
}
