//! What is identified: six numbers a joint, and a time offset.

use crate::units::{self, Unit};

/// A number of a joint that is identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Parameter {
    /// K [N m/rad].
    Stiffness,
    /// M_m [kg m²].
    MotorInertia,
    /// D_l [N m s/rad].
    LinkDamping,
    /// D_m [N m s/rad].
    MotorDamping,
    /// Coulomb friction of the link [N m].
    LinkFriction,
    /// Coulomb friction of the motor [N m].
    MotorFriction,
}

impl Parameter {
    /// All of a joint, in the order in which they are kept.
    pub const ALL: [Self; 6] = [
        Self::Stiffness,
        Self::MotorInertia,
        Self::LinkDamping,
        Self::MotorDamping,
        Self::LinkFriction,
        Self::MotorFriction,
    ];

    /// How many a joint has.
    pub const COUNT: usize = Self::ALL.len();

    /// What it is called: the key of the robot file, where it has one.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::MotorInertia => "motor_inertia",
            Self::LinkDamping => "link_damping",
            Self::MotorDamping => "motor_damping",
            Self::LinkFriction => "link_friction",
            Self::MotorFriction => "motor_friction",
        }
    }

    /// Whether nothing can be done without it: there is no controller without stiffness and motor inertia.
    pub fn is_needed(self) -> bool {
        matches!(self, Self::Stiffness | Self::MotorInertia)
    }

    /// Its unit.
    pub fn unit(self) -> Unit {
        match self {
            Self::Stiffness => units::STIFFNESS,
            Self::MotorInertia => units::INERTIA,
            Self::LinkDamping | Self::MotorDamping => units::DAMPING,
            Self::LinkFriction | Self::MotorFriction => units::TORQUE,
        }
    }

    /// Its place in the numbers of a joint.
    pub(crate) fn place(self) -> usize {
        self as usize
    }
}

/// Values of what is identified.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// Per joint the parameters in the order of [`Parameter::ALL`], all > 0.
    pub joints: Vec<[f64; Parameter::COUNT]>,
    /// How much later than a log says the torques act \[s\], one per log.
    pub offsets: Vec<f64>,
}

impl Values {
    /// Number of unknowns: the parameters, joint by joint, then the offsets.
    pub(crate) fn unknowns(&self) -> usize {
        self.joints.len() * Parameter::COUNT + self.offsets.len()
    }

    /// How far `other` is from these: logarithms of parameters, offsets in s.
    pub(crate) fn apart(&self, other: &Self) -> Vec<f64> {
        let parameters = self.joints.iter().flatten().zip(other.joints.iter().flatten());
        let offsets = self.offsets.iter().zip(&other.offsets);
        parameters.map(|(x, y)| (y / x).ln().abs()).chain(offsets.map(|(x, y)| (y - x).abs())).collect()
    }

    /// A parameter of all joints.
    pub(crate) fn of(&self, parameter: Parameter) -> Vec<f64> {
        self.joints.iter().map(|joint| joint[parameter.place()]).collect()
    }

    /// These moved by `step`: parts of the parameters, then offsets in s.
    ///
    /// Torques are linear in inertia, damping and friction, and deflections in compliance: what the log knows of sums only, of
    /// dampings of both sides, say, or of the compliance of two joints about one axis, stays the same along a step however
    /// long. In logarithms such valleys are curved.
    pub(crate) fn moved(&self, step: &[f64]) -> Self {
        let (parts, offsets) = step.split_at(self.joints.len() * Parameter::COUNT);
        let mut moved = self.clone();
        for (i, (value, step)) in moved.joints.iter_mut().flatten().zip(parts).enumerate() {
            if i % Parameter::COUNT == Parameter::Stiffness.place() {
                *value /= 1.0 - step;
            } else {
                *value *= 1.0 + step;
            }
        }
        for (value, step) in moved.offsets.iter_mut().zip(offsets) {
            *value += step;
        }
        moved
    }
}

/// The place of a parameter among the unknowns.
pub(crate) fn unknown(joint: usize, parameter: Parameter) -> usize {
    joint * Parameter::COUNT + parameter.place()
}
