//! `[joints.NAME]` of a drafted robot file: what the URDF says, what a class of drives stands in for, what is missing.

use std::fmt::Write;

use crate::files::suggest::key;
use crate::robot::TypicalDrive;
use crate::robot::links::{JointKind, MovingJoint};
use crate::units;

/// A joint as it is drafted.
pub(super) struct Drafted<'a> {
    pub joint: &'a MovingJoint,
    /// What stands in for what a URDF does not say, if anything.
    pub typical: Option<TypicalDrive>,
    /// A torque limit that the URDF does not name [N m].
    pub torque_limit: Option<f64>,
}

impl Drafted<'_> {
    /// Damping of the link [N m s/rad] as the URDF has it: none where something stands in for a zero.
    pub fn damping_of_urdf(&self) -> Option<f64> {
        self.joint.drive.damping.filter(|&damping| damping > 0.0 || self.typical.is_none())
    }

    /// Writes the table; gives the keys that are still to be supplied. Writing to a string cannot fail.
    pub fn write(&self, toml: &mut String) -> Vec<&'static str> {
        let MovingJoint { name, kind, drive } = self.joint;
        let (word, gear) = match kind {
            JointKind::Revolute => ("revolute", "the rotor's times the gear ratio squared"),
            JointKind::Prismatic => {
                ("prismatic", "the rotor's inertia in kg m² times the gear ratio in rad/m squared")
            }
        };
        let [stiffness, inertia, damping, torque, rate, velocity, position] = [
            units::STIFFNESS,
            units::INERTIA,
            units::DAMPING,
            units::TORQUE,
            units::TORQUE_RATE,
            units::SPEED,
            units::ANGLE,
        ]
        .map(|unit| unit.of(*kind).raised);
        let mut missing = Vec::new();
        let _ = writeln!(toml, "\n[joints.{}]  # {word}", key(name));
        let mut line = |key: &str, value: &str, comment: &str| {
            let _ = writeln!(toml, "{:<34} # {comment}", format!("{key} = {value}"));
        };
        let mut wanted = |key: &'static str, value: Option<f64>, comment: &str| {
            if let Some(value) = value {
                line(key, &format!("{value:?}"), &format!("{comment}, assumed"));
            } else {
                missing.push(key);
                line(key, "nan", &format!("SUPPLY: {comment}"));
            }
        };
        let typical = self.typical.as_ref();
        wanted("stiffness", typical.map(|drive| drive.stiffness), &format!("spring constant, {stiffness}"));
        wanted("motor_inertia", typical.map(|drive| drive.motor_inertia), &format!("{inertia}, {gear}"));
        wanted("motor_damping", typical.map(|drive| drive.motor_damping), damping);
        if self.damping_of_urdf().is_none() {
            wanted("link_damping", typical.map(|drive| drive.link_damping), damping);
        }
        if let Some(damping_l) = self.damping_of_urdf() {
            line("link_damping", &format!("{damping_l:?}"), &format!("{damping}, the URDF's damping"));
        }
        if let Some(drive) = typical {
            line("torque_rate_limit", &format!("{:?}", drive.torque_rate), &format!("{rate}, assumed"));
            let ratio = match kind {
                JointKind::Revolute => "motor turns per joint turn, assumed",
                JointKind::Prismatic => "rad/m, assumed",
            };
            line("gear_ratio", &format!("{:?}", drive.gear_ratio), ratio);
        }
        if let Some(limit) = self.torque_limit {
            line("torque_limit", &format!("{limit:?}"), &format!("{torque}, assumed"));
        }
        let mut given = |key: &str, value: Option<f64>, unit: &str| {
            if let Some(value) = value {
                let comment = format!("{unit}, holds as it stands in the URDF");
                line(&format!("# {key}"), &format!("{value:?}"), &comment);
            }
        };
        given("torque_limit", drive.torque_limit, torque);
        given("velocity_limit", drive.velocity_limit, velocity);
        given("position_lower", drive.position_lower, position);
        given("position_upper", drive.position_upper, position);
        missing
    }
}
