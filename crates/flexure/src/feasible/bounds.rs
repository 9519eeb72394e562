//! The limits of a robot, and what share of them numbers along a reference are.

use crate::feasible::Usage;
use crate::feasible::peaks::Peak;
use crate::robot::{JointKind, Robot};
use crate::units::{self, Unit};

/// A quantity that robot files limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitKind {
    /// Motor torque.
    Torque,
    /// Rate of the motor torque.
    TorqueRate,
    /// Link velocity.
    Velocity,
    /// Deflection of the spring.
    Deflection,
    /// Link position.
    Position,
}

/// A limit that a joint has.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Index of the joint, from 0.
    pub joint: usize,
    /// The quantity that it bounds.
    pub quantity: LimitKind,
    /// Key in robot files.
    key: &'static str,
    limit: f64,
    /// Middle and half width of the range; of a range with one end, that end and zero.
    middle: f64,
    half: f64,
    /// Which ends of the range count: the lower with −1, the upper with 1, both with 0.
    side: f64,
}

impl Bound {
    /// The part of the limit that `value` is.
    pub fn share(&self, value: f64) -> f64 {
        let out = value - self.middle;
        let out = if self.side == 0.0 { out.abs() } else { self.side * out };
        if self.half > 0.0 {
            out / self.half
        } else if out > 0.0 {
            f64::INFINITY
        } else {
            0.0
        }
    }

    /// The largest share that a speed may be chosen for, which need not be `margin`: nothing is gained by staying away from
    /// the ends of a range.
    pub fn allowed(&self, margin: f64) -> f64 {
        if self.quantity == LimitKind::Position { 1.0 } else { margin }
    }

    /// What the reference uses of this bound where it comes closest to it, at `peak`.
    pub fn usage(&self, peak: &Peak) -> Usage {
        Usage {
            joint: self.joint,
            key: self.key,
            limit: self.limit,
            value: peak.value,
            share: self.share(peak.value),
            time: peak.time,
        }
    }
}

/// Keys of the limits of positions.
const POSITIONS: [&str; 2] = ["position_lower", "position_upper"];

/// Whether the limit with this key is one of positions.
pub fn is_position(key: &str) -> bool {
    POSITIONS.contains(&key)
}

/// What a limit with this key is of, and the unit.
pub fn limit_words(key: &str, kind: JointKind) -> (&'static str, &'static str) {
    let what = match key {
        "torque_limit" => "motor torque",
        "torque_rate_limit" => "rate of the motor torque",
        "velocity_limit" => "link velocity",
        "deflection_limit" => "deflection of the spring",
        _ => "link position",
    };
    (what, Unit::of_key(key).unwrap_or(units::ANGLE).of(kind).plain)
}

/// The limits that `robot` has, joint by joint.
pub fn bounds(robot: &Robot) -> Vec<Bound> {
    let limits = &robot.limits;
    let symmetric = [
        ("torque_limit", LimitKind::Torque, &limits.torque),
        ("torque_rate_limit", LimitKind::TorqueRate, &limits.torque_rate),
        ("velocity_limit", LimitKind::Velocity, &limits.velocity),
        ("deflection_limit", LimitKind::Deflection, &limits.deflection),
    ];
    let of_joint = |joint: usize| {
        let (lower, upper) = (limits.lower[joint], limits.upper[joint]);
        let half = if (upper - lower).is_finite() { 0.5 * (upper - lower) } else { 0.0 };
        let position = |key, limit: f64, side: f64| {
            let quantity = LimitKind::Position;
            Bound { joint, quantity, key, limit, middle: limit - side * half, half, side }
        };
        let [lower_key, upper_key] = POSITIONS;
        let symmetric = symmetric.map(|(key, quantity, limits)| {
            let limit = limits[joint];
            Bound { joint, quantity, key, limit, middle: 0.0, half: limit, side: 0.0 }
        });
        symmetric.into_iter().chain([position(lower_key, lower, -1.0), position(upper_key, upper, 1.0)])
    };
    (0..robot.joint_count()).flat_map(of_joint).filter(|bound| bound.limit.is_finite()).collect()
}
