//! Imperfections of the sensors.

use crate::files::field::Field;
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::{Context, Imperfection, SIDES, Side, Sides};
use crate::robot::JointKind;

/// Positions come in whole counts. Where some encoder is described, a side without one is not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoder {
    /// One count ≥ 0 of the link encoders \[rad\]; none if this entry places none there.
    pub link: Option<Vec<f64>>,
    /// One count ≥ 0 of the motor encoders, link side of the gear \[rad\]; none if this entry places none there.
    pub motor: Option<Vec<f64>>,
    /// Whether half a count of uniform noise is added before rounding.
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

/// Standard deviations ≥ 0 of white noise, drawn anew at every control instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Of link positions \[rad\].
    pub link: Vec<f64>,
    /// Of motor positions \[rad\].
    pub motor: Vec<f64>,
    /// Of link velocities [rad/s].
    pub link_velocity: Vec<f64>,
    /// Of motor velocities [rad/s].
    pub motor_velocity: Vec<f64>,
}

/// Sensors deliver every so many control periods, at t = 0 first, and are held in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Where.
    pub sides: Sides,
    /// Control periods from one delivery to the next, ≥ 1.
    pub periods: u32,
}

/// Sensors deliver nothing for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dropout {
    /// Where.
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
    /// By chance.
    Random {
        /// That a sound sensor drops out, per control instant, in [0, 1].
        probability: f64,
        /// Mean length of an outage ≥ 1 [control periods]; lengths are geometric.
        mean_length: f64,
    },
}

/// Velocities are filtered differences of measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityFilter {
    /// ω/(s + ω).
    First {
        /// ω/2π > 0 \[Hz\].
        cutoff: f64,
    },
    /// ω²/(s² + 2 d ω s + ω²).
    Second {
        /// ω/2π > 0 \[Hz\].
        cutoff: f64,
        /// d > 0.
        damping: f64,
    },
}

pub(crate) const ENCODER: &[&str] = &["kind", "placement", "counts_per_turn", "resolution", "dither"];

pub(crate) fn encoder(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
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
    Some(Imperfection::Encoder(Encoder { link: link?, motor: motor?, dither: dither?.unwrap_or(false) }))
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

pub(crate) const NOISE: &[&str] = &["kind", "link", "motor", "link_velocity", "motor_velocity"];

pub(crate) fn noise(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    if NOISE.iter().skip(1).all(|key| table.get(key).is_none()) {
        table.error(
            "missing-key",
            "noise: no standard deviation is given",
            "give at least one of link and motor in rad, link_velocity and motor_velocity in rad/s",
        );
        return None;
    }
    let read = |key, quantity: &Quantity| table.per_joint_or_zero(key, context.joints, quantity);
    let (link, motor) = (read("link", &quantity::NOISE), read("motor", &quantity::NOISE));
    let link_velocity = read("link_velocity", &quantity::VELOCITY_NOISE);
    let motor_velocity = read("motor_velocity", &quantity::VELOCITY_NOISE);
    Some(Imperfection::Noise(Noise {
        link: link?,
        motor: motor?,
        link_velocity: link_velocity?,
        motor_velocity: motor_velocity?,
    }))
}

pub(crate) const SAMPLING: &[&str] = &["kind", "side", "period"];

/// Largest part of a control period that a sensor period may be off a multiple without an error: decimals are inexact.
const UNEVEN: f64 = 1e-6;

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 5e6 periods in a run")]
pub(crate) fn sampling(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
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
    Some(Imperfection::Sampling(Sampling { sides, periods: periods as u32 }))
}

pub(crate) const DROPOUT: &[&str] = &["kind", "side", "mode", "from", "until", "probability", "mean_length"];

pub(crate) fn dropout(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
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
    Some(Imperfection::Dropout(Dropout {
        sides: sides?.unwrap_or(Sides::Both),
        mode: mode?.unwrap_or(DropoutMode::Nan),
        outage: outage?,
    }))
}

fn window(table: &Table<'_>, context: &Context<'_>) -> Option<Outage> {
    let from = table.number("from", &quantity::FROM);
    let until = table.number("until", &quantity::UNTIL);
    let (from, until) = (from?, until?);
    if from >= until {
        let message = format!("dropout: from is {from} s and until {until} s, must be from < until");
        table.get("until")?.error("range", message, "the readings of [from, until) are missing");
        return None;
    }
    if let Some((duration, _)) = context.times
        && from > duration
    {
        let field = table.get("from")?;
        let message = format!("{} is {from} s, after the end of the run at {duration} s", field.path);
        field.warn("unused", message, "it never drops out");
    }
    Some(Outage::Window { from, until })
}

pub(crate) const VELOCITY_FILTER: &[&str] = &["kind", "order", "cutoff", "damping"];

pub(crate) fn velocity_filter(table: &Table<'_>, context: &Context<'_>) -> Option<Imperfection> {
    let order = table.required("order", "1 or 2").and_then(|field| field.whole("order of the filter", 1, 2));
    let cutoff = table.number("cutoff", &quantity::CUTOFF);
    let (order, cutoff) = (order?, cutoff?);
    if let Some((_, period)) = context.times
        && cutoff >= 0.5 / period
    {
        let field = table.get("cutoff")?;
        let message =
            format!("{} is {cutoff} Hz, must be < {} Hz, half the control rate", field.path, 0.5 / period);
        field.error("range", message, "remove the filter's entry for none, or shorten control_period");
        return None;
    }
    Some(Imperfection::VelocityFilter(if order == 1 {
        if let Some(field) = table.get("damping") {
            let message = format!("{} is given, but the order is 1, which has no damping", field.path);
            field.error("unused", message, "remove it, or choose order = 2");
            return None;
        }
        VelocityFilter::First { cutoff }
    } else {
        VelocityFilter::Second { cutoff, damping: table.number("damping", &quantity::DAMPING_RATIO)? }
    }))
}
