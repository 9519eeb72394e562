//! Imperfections of joints and springs, and what pushes from outside.

use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::{Context, Imperfection, SIDE, Side};

/// Dry friction in the joints of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Where.
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

/// What springs do beside K ζ.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// k ≥ 0 in K ζ + k ζ³ [N m/rad³].
    pub hardening: Vec<f64>,
    /// Deflection ≥ 0 to either side in which the spring gives no torque \[rad\].
    pub dead_zone: Vec<f64>,
    /// Stiffness ≥ 0 of the element that slips [N m/rad].
    pub hysteresis_stiffness: Vec<f64>,
    /// Torque ≥ 0 at which it slips [N m].
    pub hysteresis_torque: Vec<f64>,
}

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
    pub shape: PushShape,
}

/// The course of a push in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PushShape {
    /// Constant.
    #[default]
    Rectangle,
    /// Half a sine.
    HalfSine,
}

pub(crate) const FRICTION: &[&str] = &["kind", "side", "coulomb", "static", "stribeck_velocity"];

pub(crate) fn friction(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let side = table.choice("side", SIDE);
    let coulomb = table.per_joint("coulomb", context.joints, &quantity::FRICTION);
    let breakaway =
        table.optional("static", |field| field.per_joint(context.joints, &quantity::STATIC_FRICTION));
    let velocity = match (table.get("static"), table.get("stribeck_velocity")) {
        (Some(_), _) => {
            table.per_joint("stribeck_velocity", context.joints, &quantity::STRIBECK_VELOCITY).map(Some)
        }
        (None, Some(field)) => {
            let message = format!("{} is given, but static is not: the friction does not rise", field.path);
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
    Some(Imperfection::Friction(Friction { side: side?, coulomb, stribeck }))
}

pub(crate) const SPRING: &[&str] =
    &["kind", "hardening", "dead_zone", "hysteresis_stiffness", "hysteresis_torque"];

pub(crate) fn spring(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    if SPRING.iter().skip(1).all(|key| table.get(key).is_none()) {
        let hint = "give at least one of hardening in N m/rad^3, dead_zone in rad, hysteresis_stiffness in N m/rad \
                    with hysteresis_torque in N m";
        table.error("missing-key", "spring: nothing is given", hint);
        return None;
    }
    let read = |key, quantity: &Quantity| table.per_joint_or_zero(key, context.joints, quantity);
    let hardening = read("hardening", &quantity::SPRING_HARDENING);
    let dead_zone = read("dead_zone", &quantity::DEAD_ZONE);
    let hysteresis = ["hysteresis_stiffness", "hysteresis_torque"];
    if let [Some(field), None] | [None, Some(field)] = hysteresis.map(|key| table.get(key)) {
        let message = format!("{} is given alone", field.path);
        field.error(
            "missing-key",
            message,
            "hysteresis needs hysteresis_stiffness in N m/rad and hysteresis_torque in N m",
        );
        return None;
    }
    let stiffness = read("hysteresis_stiffness", &quantity::HYSTERESIS_STIFFNESS);
    let torque = read("hysteresis_torque", &quantity::HYSTERESIS_TORQUE);
    Some(Imperfection::Spring(Spring {
        hardening: hardening?,
        dead_zone: dead_zone?,
        hysteresis_stiffness: stiffness?,
        hysteresis_torque: torque?,
    }))
}

pub(crate) const PUSH: &[&str] = &["kind", "side", "torque", "from", "duration", "shape"];

pub(crate) fn push(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    // Only links can be reached from outside.
    let side = table.optional("side", |field| field.choice(&[("link", ())]));
    let torque = table.per_joint("torque", context.joints, &quantity::PUSH);
    let from = table.number("from", &quantity::FROM);
    let duration = table.number("duration", &quantity::DURATION);
    let shapes = [("rectangle", PushShape::Rectangle), ("half-sine", PushShape::HalfSine)];
    let shape = table.optional("shape", |field| field.choice(&shapes));
    side?;
    if let (Some(from), Some((end, _))) = (from, context.times)
        && from >= end
    {
        let field = table.get("from")?;
        let message = format!("{} is {from} s, after the end of the run at {end} s", field.path);
        field.warn("unused", message, "nobody pushes");
    }
    Some(Imperfection::Push(Push {
        torque: torque?,
        from: from?,
        duration: duration?,
        shape: shape?.unwrap_or_default(),
    }))
}
