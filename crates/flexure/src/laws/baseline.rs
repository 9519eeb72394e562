//! The laws that v-CBC is compared with, as data: which gains each has, what they are, and what to start from.

use crate::files::field::{Field, Joints};
use crate::files::quantity::{self, Quantity};

/// A law and its gains, one number per joint each.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    /// The name in files.
    pub kind: &'static str,
    /// Key and values of every gain, in the order of its [`Shape`].
    pub gains: Vec<(&'static str, Vec<f64>)>,
}

impl Baseline {
    /// The gain at `key`; empty if the law has none of this name.
    pub fn gain(&self, key: &str) -> &[f64] {
        self.gains.iter().find(|(name, _)| *name == key).map_or(&[], |(_, values)| values)
    }
}

impl Baseline {
    /// The powers of 1/s in the units of its gains.
    pub(crate) fn speed_powers(&self) -> Vec<i32> {
        let shape = BASELINES.iter().find(|shape| shape.kind == self.kind);
        shape.map_or_else(Vec::new, |shape| {
            shape.gains.iter().map(|gain| gain.quantity.per_second()).collect()
        })
    }
}

/// Which gains a law has.
#[derive(Debug)]
pub struct Shape {
    /// The name of the law in files.
    pub kind: &'static str,
    /// Its gains.
    pub gains: &'static [Gain],
}

/// A gain in files.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// Its key.
    pub key: &'static str,
    quantity: &'static Quantity,
    /// What to start tuning from, by what a joint has to move.
    pub start: fn(&Drive) -> f64,
}

impl Gain {
    /// What it is, and in which unit.
    pub fn described(&self) -> String {
        self.quantity.described()
    }
}

/// What a joint has to move: all that starting gains depend on.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Spring constant K [N m/rad].
    pub stiffness: f64,
    /// Motor inertia [kg m²].
    pub motor_inertia: f64,
    /// Inertia of the links about the joint at q = 0, the other joints held [kg m²].
    pub link_inertia: f64,
    /// The same with the other joints free [kg m²], the smallest at q = 0 and with one joint at a time a quarter turn (or
    /// π/2 m) away: what damping of this joint alone acts on.
    pub free_inertia: f64,
}

/// Fastest errors that starting gains ask for [1/s]: a control period of 1 ms does not show at that.
const FASTEST: f64 = 20.0;

impl Drive {
    /// How fast errors shall decay [1/s]: half the frequency at which the links swing while the motor is held, at most
    /// 20 1/s.
    pub fn bandwidth(&self) -> f64 {
        (0.5 * (self.stiffness / self.link_inertia).sqrt()).min(FASTEST)
    }

    /// Links and motor as if they were one [kg m²].
    fn inertia(&self) -> f64 {
        self.motor_inertia + self.link_inertia
    }

    /// ω² J.
    fn motor_stiffness(&self) -> f64 {
        self.bandwidth().powi(2) * self.inertia()
    }

    /// 2 ω J: with [`motor_stiffness`](Self::motor_stiffness) critically damped.
    fn motor_damping(&self) -> f64 {
        2.0 * self.bandwidth() * self.inertia()
    }
}

const fn gain(key: &'static str, quantity: &'static Quantity, start: fn(&Drive) -> f64) -> Gain {
    Gain { key, quantity, start }
}

/// K_P and K_D of the feedback of the motors.
const MOTOR: [Gain; 2] = [
    gain("stiffness", &quantity::GAIN_STIFFNESS, Drive::motor_stiffness),
    gain("damping", &quantity::GAIN_VELOCITY, Drive::motor_damping),
];

/// (s + ω)² on the links.
const LINKS: [Gain; 2] = [
    gain("position", &quantity::GAIN_POSITION, |drive| drive.bandwidth().powi(2)),
    gain("velocity", &quantity::GAIN_RATE, |drive| 2.0 * drive.bandwidth()),
];

const SHAPING: Gain = gain("shaping", &quantity::GAIN_SHAPING, Drive::bandwidth);
const LINK_DAMPING: Gain =
    gain("link_damping", &quantity::GAIN_LINK, |drive| drive.free_inertia * drive.bandwidth());

const SPRING_DAMPING: Gain =
    gain("damping", &quantity::GAIN_SPRING, |drive| (drive.stiffness * drive.motor_inertia).sqrt());

/// How much faster than the links motors shall be that stand between them and the law.
const INNER: f64 = 3.0;
const MOTOR_SHAPING: Gain =
    gain("motor_shaping", &quantity::GAIN_MOTOR_SHAPING, |drive| INNER * drive.bandwidth());

/// Every law beside `vcbc`, with its gains and what to start them from.
pub const BASELINES: &[Shape] = &[
    Shape {
        kind: "rigid-vcbc",
        gains: &[
            gain("metric", &quantity::GAIN_METRIC, Drive::motor_stiffness),
            SHAPING,
            gain("damping", &quantity::GAIN_DAMPING, |drive| drive.inertia() * drive.bandwidth()),
        ],
    },
    Shape { kind: "pd", gains: &MOTOR },
    Shape { kind: "pd-online-gravity", gains: &MOTOR },
    Shape {
        kind: "feedback-linearization",
        gains: &[
            gain("position", &quantity::GAIN_SNAP_POSITION, |drive| drive.bandwidth().powi(4)),
            gain("velocity", &quantity::GAIN_SNAP_VELOCITY, |drive| 4.0 * drive.bandwidth().powi(3)),
            gain("acceleration", &quantity::GAIN_SNAP_ACCELERATION, |drive| 6.0 * drive.bandwidth().powi(2)),
            gain("jerk", &quantity::GAIN_SNAP_JERK, |drive| 4.0 * drive.bandwidth()),
        ],
    },
    Shape { kind: "feedforward-pd", gains: &MOTOR },
    Shape { kind: "integral-manifold", gains: &[LINKS[0], LINKS[1], SPRING_DAMPING] },
    Shape { kind: "singular-perturbation", gains: &[LINKS[0], LINKS[1], SPRING_DAMPING] },
    Shape {
        kind: "passivity",
        gains: &[
            SHAPING,
            LINK_DAMPING,
            gain("motor_damping", &quantity::GAIN_MOTOR, |drive| drive.motor_inertia * drive.bandwidth()),
        ],
    },
    Shape {
        kind: "torque-feedback",
        gains: &[
            gain("inertia", &quantity::GAIN_INERTIA, |drive| 0.5 * drive.motor_inertia),
            MOTOR[0],
            MOTOR[1],
        ],
    },
    Shape { kind: "gravity-cancellation", gains: &MOTOR },
    Shape {
        kind: "backstepping",
        gains: &[
            SHAPING,
            LINK_DAMPING,
            gain("metric", &quantity::GAIN_WEIGHT, |drive| drive.stiffness),
            MOTOR_SHAPING,
        ],
    },
    Shape {
        kind: "cascade",
        gains: &[
            SHAPING,
            LINK_DAMPING,
            gain("position", &quantity::GAIN_POSITION, |drive| (INNER * drive.bandwidth()).powi(2)),
            gain("velocity", &quantity::GAIN_RATE, |drive| 2.0 * INNER * drive.bandwidth()),
        ],
    },
    Shape { kind: "esp", gains: &[LINK_DAMPING, MOTOR[0], MOTOR[1]] },
];

/// Reads the gains of a law.
pub(crate) fn read(field: &Field<'_>, shape: &Shape, joints: &Joints) -> Option<Baseline> {
    let known: Vec<_> = std::iter::once("kind").chain(shape.gains.iter().map(|gain| gain.key)).collect();
    let table = field.table(&known)?;
    let gains: Vec<_> = shape
        .gains
        .iter()
        .map(|gain| table.per_joint(gain.key, joints, gain.quantity).map(|values| (gain.key, values)))
        .collect();
    Some(Baseline { kind: shape.kind, gains: gains.into_iter().collect::<Option<_>>()? })
}
