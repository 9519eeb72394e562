//! Torque from outside on the links.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::plant::{self, Shape};
use crate::robot::vector;

/// Torque from outside on the links.
#[derive(Clone, Debug, PartialEq)]
pub struct Push {
    /// Its largest value [N m].
    pub torque: Vec<f64>,
    /// When it begins ≥ 0 \[s\].
    pub from: f64,
    /// How long it lasts > 0 \[s\].
    pub duration: f64,
    /// Its course in time.
    pub shape: Shape,
}

impl Push {
    /// The same on the links of a plant.
    pub(crate) fn on_links<const N: usize>(&self) -> plant::Push<N> {
        let Self { torque, from, duration, shape } = self;
        plant::Push { torque: vector(torque), from: *from, duration: *duration, shape: *shape }
    }
}

impl Kind for Push {
    const NAME: &'static str = "push";
    const SUMMARY: &'static str = "torque from outside on the links";
    const KEYS: &'static [&'static str] = &["side", "torque", "from", "duration", "shape"];
    const PLACE: Place = Place::Mechanics;
    const STRENGTHS: Strengths = Strengths {
        none: Some("torque = 0.0\nfrom = 0.0\nduration = 1.0"),
        little: "torque = 0.1\nfrom = 0.3\nduration = 0.2\nshape = \"half-sine\"",
        much: "torque = 0.5\nfrom = 0.3\nduration = 0.2",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        // Only links can be reached from outside.
        let side = table.optional("side", |field| field.choice(&[("link", ())]));
        let torque = table.per_joint("torque", context.joints, &quantity::PUSH);
        let from = table.number("from", &quantity::FROM);
        let duration = table.number("duration", &quantity::DURATION);
        let shapes = [("rectangle", Shape::Rectangle), ("half-sine", Shape::HalfSine)];
        let shape = table.optional("shape", |field| field.choice(&shapes));
        side?;
        if let (Some(from), Some((end, _))) = (from, context.times)
            && from >= end
        {
            let field = table.get("from")?;
            let message = format!("{} is {from} s, after the end of the run at {end} s", field.path);
            field.warn("unused", message, "nobody pushes");
        }
        let shape = shape?.unwrap_or(Shape::Rectangle);
        Some(Self { torque: torque?, from: from?, duration: duration?, shape })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        None
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Push(self)
    }
}
