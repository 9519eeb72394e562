//! The signals of a log, and the units that files have them in.

use std::f64::consts::{PI, TAU};

use crate::files::quantity::{self, Quantity};

/// A signal that a log may have, one number per joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    LinkPosition,
    MotorPosition,
    LinkVelocity,
    MotorVelocity,
    MotorTorque,
}

impl Channel {
    pub const ALL: [Self; 5] =
        [Self::LinkPosition, Self::MotorPosition, Self::LinkVelocity, Self::MotorVelocity, Self::MotorTorque];

    /// Its key in a map of columns, and its columns in traces but for the number of the joint.
    pub fn key(self) -> &'static str {
        match self {
            Self::LinkPosition => "q_l",
            Self::MotorPosition => "q_m",
            Self::LinkVelocity => "dq_l",
            Self::MotorVelocity => "dq_m",
            Self::MotorTorque => "u_m",
        }
    }

    /// Where traces have it, the best first: what sensors deliver, else what the controller makes of it, else what is true.
    pub fn in_traces(self) -> &'static [&'static str] {
        match self {
            Self::LinkPosition => &["q_l_measured{}", "q_l{}"],
            Self::MotorPosition => &["q_m_measured{}", "q_m{}"],
            Self::LinkVelocity => &["dq_l_seen{}", "dq_l{}"],
            Self::MotorVelocity => &["dq_m_seen{}", "dq_m{}"],
            Self::MotorTorque => &["u_m_measured{}", "u_m{}"],
        }
    }

    /// Units that it may be in, with what one of them is in SI units; the first is meant if nothing is said. Those of joints that
    /// slide are SI units too.
    pub fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::LinkPosition | Self::MotorPosition => {
                &[("rad", 1.0), ("deg", PI / 180.0), ("turn", TAU), ("m", 1.0), ("mm", 1e-3)]
            }
            Self::LinkVelocity | Self::MotorVelocity => &[
                ("rad/s", 1.0),
                ("deg/s", PI / 180.0),
                ("turn/s", TAU),
                ("rev/min", TAU / 60.0),
                ("m/s", 1.0),
                ("mm/s", 1e-3),
            ],
            Self::MotorTorque => &[("N m", 1.0), ("mN m", 1e-3), ("N", 1.0)],
        }
    }

    /// Whether it is of the motor, and may be measured before the gear.
    pub fn is_of_the_motor(self) -> bool {
        matches!(self, Self::MotorPosition | Self::MotorVelocity | Self::MotorTorque)
    }

    /// What a number on the motor's shaft is on the link side of a gear of this ratio.
    pub fn behind_gear(self, ratio: f64) -> f64 {
        if self == Self::MotorTorque { ratio } else { 1.0 / ratio }
    }

    /// What its numbers stand for.
    pub fn quantity(self) -> &'static Quantity {
        match self {
            Self::LinkPosition | Self::MotorPosition => &quantity::ANGLE,
            Self::LinkVelocity | Self::MotorVelocity => &quantity::VELOCITY,
            Self::MotorTorque => &quantity::MOTOR_TORQUE,
        }
    }
}

/// Units of time with what one of them is in s.
pub(super) const TIMES: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
