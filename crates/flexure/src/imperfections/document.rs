//! `[[imperfection]]`: what real sensors, actuators and mechanics do and the ideal loop does not.

use crate::files::base::Base;
use crate::files::field::{Field, Joints};
use crate::files::table::Table;
use crate::imperfections::{
    Deadline, Delay, Dropout, Encoder, Friction, ModelError, Noise, Push, Sampling, Spring, VelocityFilter,
    actuation, mechanics, model_error, sensing,
};
use crate::robot::Robot;

/// An imperfection as data. Vectors have one entry per joint.
#[derive(Clone, Debug)]
pub enum Imperfection {
    /// Positions come in counts: kind `encoder`.
    Encoder(Encoder),
    /// White noise on what is measured: kind `noise`.
    Noise(Noise),
    /// Sensors deliver less often than the law runs: kind `sampling`.
    Sampling(Sampling),
    /// Sensors deliver nothing for a while: kind `dropout`.
    Dropout(Dropout),
    /// Velocities are filtered differences of measured positions: kind `velocity-filter`.
    VelocityFilter(VelocityFilter),
    /// Torque arrives late: kind `delay`.
    Delay(Delay),
    /// The law misses some control instants: kind `deadline`.
    Deadline(Deadline),
    /// What the motor torque is multiplied by > 0: kind `torque-gain`.
    TorqueGain(Vec<f64>),
    /// Largest motor torque > 0 [N m]: kind `saturation`.
    Saturation(Vec<f64>),
    /// Largest rate of the motor torque > 0 [N m/s]: kind `torque-rate`.
    TorqueRate(Vec<f64>),
    /// Steps ≥ 0 that the motor torque comes in [N m]: kind `current-quantisation`.
    CurrentQuantisation(Vec<f64>),
    /// Coulomb and Stribeck friction: kind `friction`.
    Friction(Friction),
    /// What the springs do beside K ζ: kind `spring`.
    Spring(Spring),
    /// The simulated robot is another one than the law's: kind `model-error`.
    ModelError(Box<ModelError>),
    /// Torque from outside on the links: kind `push`.
    Push(Push),
}

/// Links or motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The links.
    Link,
    /// The motors.
    Motor,
}

/// Which sides an imperfection is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// One of them.
    One(Side),
    /// Links and motors.
    Both,
}

impl Sides {
    /// Whether `side` is among them.
    pub fn contain(self, side: Side) -> bool {
        match self {
            Self::One(one) => one == side,
            Self::Both => true,
        }
    }
}

impl Side {
    /// Links, motors.
    pub const ALL: [Self; 2] = [Self::Link, Self::Motor];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Motor => "motor",
        }
    }
}

pub(crate) const SIDE: &[(&str, Side)] = &[("link", Side::Link), ("motor", Side::Motor)];

pub(crate) const SIDES: &[(&str, Sides)] =
    &[("link", Sides::One(Side::Link)), ("motor", Sides::One(Side::Motor)), ("both", Sides::Both)];

impl Imperfection {
    /// The name in files.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Encoder(_) => "encoder",
            Self::Noise(_) => "noise",
            Self::Sampling(_) => "sampling",
            Self::Dropout(_) => "dropout",
            Self::VelocityFilter(_) => "velocity-filter",
            Self::Delay(_) => "delay",
            Self::Deadline(_) => "deadline",
            Self::TorqueGain(_) => "torque-gain",
            Self::Saturation(_) => "saturation",
            Self::TorqueRate(_) => "torque-rate",
            Self::CurrentQuantisation(_) => "current-quantisation",
            Self::Friction(_) => "friction",
            Self::Spring(_) => "spring",
            Self::ModelError(_) => "model-error",
            Self::Push(_) => "push",
        }
    }

    /// Whether it is in sensors, computer or drives rather than in the mechanics: what makes the loop a sampled one.
    pub fn is_of_devices(&self) -> bool {
        !matches!(self, Self::Friction(_) | Self::Spring(_) | Self::ModelError(_) | Self::Push(_))
    }
}

/// What readers of imperfections know of the rest of the scenario.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    pub joints: &'a Joints,
    /// None if its file could not be read.
    pub robot: Option<&'a Robot>,
    /// Length of the run and control period \[s\], if they could be read.
    pub times: Option<(f64, f64)>,
    /// What paths are relative to.
    pub base: &'a Base,
}

/// A kind of imperfection: its keys and its reader. One line adds one.
type Reader = (&'static [&'static str], fn(&Table<'_>, &Context<'_>) -> Option<Imperfection>);

const KINDS: &[(&str, Reader)] = &[
    ("encoder", (sensing::ENCODER, sensing::encoder)),
    ("noise", (sensing::NOISE, sensing::noise)),
    ("sampling", (sensing::SAMPLING, sensing::sampling)),
    ("dropout", (sensing::DROPOUT, sensing::dropout)),
    ("velocity-filter", (sensing::VELOCITY_FILTER, sensing::velocity_filter)),
    ("delay", (actuation::DELAY, actuation::delay)),
    ("deadline", (actuation::DEADLINE, actuation::deadline)),
    ("torque-gain", (actuation::TORQUE_GAIN, actuation::torque_gain)),
    ("saturation", (actuation::SATURATION, actuation::saturation)),
    ("torque-rate", (actuation::TORQUE_RATE, actuation::torque_rate)),
    ("current-quantisation", (actuation::CURRENT_QUANTISATION, actuation::current_quantisation)),
    ("friction", (mechanics::FRICTION, mechanics::friction)),
    ("spring", (mechanics::SPRING, mechanics::spring)),
    ("model-error", (model_error::KEYS, model_error::read)),
    ("push", (mechanics::PUSH, mechanics::push)),
];

/// An imperfection with the entry that it was read from.
pub(crate) struct Found<'a> {
    pub field: Field<'a>,
    pub table: Table<'a>,
    pub what: Imperfection,
}

/// Reads every `[[imperfection]]`.
pub(crate) fn read<'a>(root: &Table<'a>, context: &Context<'_>) -> Option<Vec<Found<'a>>> {
    let Some(field) = root.get("imperfection") else { return Some(Vec::new()) };
    let found: Vec<_> = field.tables()?.into_iter().map(|field| one(field, context)).collect();
    found.into_iter().collect()
}

fn one<'a>(field: Field<'a>, context: &Context<'_>) -> Option<Found<'a>> {
    let table = field.any_table()?;
    let (known, reader) = table.choice("kind", KINDS)?;
    table.refuse_unknown(known);
    let what = reader(&table, context)?;
    Some(Found { field, table, what })
}
