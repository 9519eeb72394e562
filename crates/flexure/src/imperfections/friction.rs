//! Dry friction in the joints.

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::side::{SIDE, Side};

/// Dry friction in the joints of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Between a link and the one before, or in the motors.
    pub side: Side,
    /// Torque while sliding fast ≥ 0 [N m].
    pub coulomb: Vec<f64>,
    /// How it rises towards rest; none for Coulomb friction alone.
    pub stribeck: Option<Stribeck>,
}

/// Friction at speed v is coulomb + (breakaway − coulomb) exp(−(v/velocity)²).
#[derive(Clone, Debug, PartialEq)]
pub struct Stribeck {
    /// Torque that breaks it loose, at least the Coulomb torque [N m]; key `static`.
    pub breakaway: Vec<f64>,
    /// Speed at which a part 1/e of the rise is left > 0 [rad/s].
    pub velocity: Vec<f64>,
}

impl Kind for Friction {
    const NAME: &'static str = "friction";
    const SUMMARY: &'static str = "Coulomb and Stribeck friction of links or motors";
    const KEYS: &'static [&'static str] = &["side", "coulomb", "static", "stribeck_velocity"];
    const PLACE: Place = Place::Mechanics;
    const STRENGTHS: Strengths = Strengths {
        none: Some("side = \"link\"\ncoulomb = 0.0"),
        little: "side = \"motor\"\ncoulomb = 0.03",
        much: "side = \"motor\"\ncoulomb = 0.1\nstatic = 0.2\nstribeck_velocity = 0.1",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let side = table.choice("side", SIDE);
        let coulomb = table.per_joint("coulomb", context.joints, &quantity::FRICTION);
        let breakaway =
            table.optional("static", |field| field.per_joint(context.joints, &quantity::STATIC_FRICTION));
        let velocity = match (table.get("static"), table.get("stribeck_velocity")) {
            (Some(_), _) => {
                table.per_joint("stribeck_velocity", context.joints, &quantity::STRIBECK_VELOCITY).map(Some)
            }
            (None, Some(field)) => {
                let message =
                    format!("{} is given, but static is not: the friction does not rise", field.path);
                field.error("unused", message, "give static in N m, or remove it");
                None
            }
            (None, None) => Some(None),
        };
        let (coulomb, breakaway) = (coulomb?, breakaway?);
        if let Some((i, (low, high))) = breakaway
            .as_ref()
            .and_then(|high| coulomb.iter().zip(high).enumerate().find(|(_, (low, high))| high < low))
        {
            let message =
                format!("static friction of joint {} is {high} N m, must be >= coulomb, {low} N m", i + 1);
            table.get("static")?.error("range", message, "dry friction is largest at rest");
            return None;
        }
        let stribeck = breakaway.zip(velocity?).map(|(breakaway, velocity)| Stribeck { breakaway, velocity });
        Some(Self { side: side?, coulomb, stribeck })
    }

    fn overlap(&self, earlier: &Self) -> Option<Overlap> {
        Overlap::sides(|side| self.side == side && earlier.side == side)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Joints(Box::new(|joints| {
            let dry = match self.side {
                Side::Link => &mut joints.link_friction,
                Side::Motor => &mut joints.motor_friction,
            };
            dry.coulomb.copy_from_slice(&self.coulomb);
            dry.stiction.copy_from_slice(&self.coulomb);
            if let Some(stribeck) = &self.stribeck {
                dry.stiction.copy_from_slice(&stribeck.breakaway);
                dry.stribeck_velocity.copy_from_slice(&stribeck.velocity);
            }
        }))
    }
}
