//! The table of units: how the numbers of files, traces, tables and messages are measured and how that is written.
//!
//! SI units throughout, angles in rad, motors seen from the link side of the gear. The kinds of numbers about a joint have one
//! unit where it turns and another where it slides: [`Unit::of`].

use flexure_core::robots::JointKind;

/// How a kind of number is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// In ASCII, as messages, files and traces write it; empty for plain numbers.
    pub plain: &'static str,
    /// With raised digits, as tables, figures and comments in files write it.
    pub raised: &'static str,
    /// How often 1/s is in it, with kg, m and rad set aside: by which power of its speed such a number grows with a loop that is
    /// to be faster.
    pub per_second: i32,
    /// What takes its place at a joint that slides, if anything does.
    sliding: Option<&'static Unit>,
}

impl Unit {
    const fn new(plain: &'static str, per_second: i32) -> Self {
        Self { plain, raised: plain, per_second, sliding: None }
    }

    const fn raised(self, raised: &'static str) -> Self {
        Self { raised, ..self }
    }

    const fn sliding(self, sliding: &'static Unit) -> Self {
        Self { sliding: Some(sliding), ..self }
    }

    /// The unit at a joint of the kind `kind`, for numbers about joints; itself for others.
    #[must_use]
    pub fn of(self, kind: JointKind) -> Self {
        match (kind, self.sliding) {
            (JointKind::Prismatic, Some(sliding)) => *sliding,
            _ => self,
        }
    }

    /// The unit of the number at `key` of a robot or scenario file, tables before the last point left out; none for plain numbers
    /// and for keys of other things.
    pub fn of_key(key: &str) -> Option<Self> {
        let last = key.rsplit('.').next().unwrap_or_default();
        KEYS.iter().find(|(keys, _)| keys.contains(&last)).map(|(_, unit)| *unit)
    }
}

/// How numbers about several joints are measured, each with `prefix` before it: "N m", "N", or "N m or N".
pub fn of_joints(unit: Unit, prefix: &str, kinds: &[JointKind]) -> String {
    let (mut turns, mut slides) = (false, false);
    for kind in kinds {
        match kind {
            JointKind::Revolute => turns = true,
            JointKind::Prismatic => slides = true,
        }
    }
    let [turning, sliding] =
        [JointKind::Revolute, JointKind::Prismatic].map(|kind| format!("{prefix}{}", unit.of(kind).raised));
    match (turns, slides) {
        (true, true) if turning != sliding => format!("{turning} or {sliding}"),
        (false, true) => sliding,
        _ => turning,
    }
}

/// A unit in ASCII with raised digits.
pub fn raised(plain: &str) -> String {
    plain.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
}

/// Plain numbers.
pub const NONE: Unit = Unit::new("", 0);
/// Times and durations.
pub const TIME: Unit = Unit::new("s", -1);
/// Numbers of control periods.
pub const CONTROL_PERIODS: Unit = Unit::new("control periods", 0);
/// Frequencies in turns.
pub const FREQUENCY: Unit = Unit::new("Hz", 1);
/// Distances.
pub const LENGTH: Unit = Unit::new("m", 0);
/// Masses.
pub const MASS: Unit = Unit::new("kg", 0);
/// Accelerations along a line.
pub const ACCELERATION: Unit = Unit::new("m/s^2", 2).raised("m/s²");
/// Energies and levels of W.
pub const ENERGY: Unit = Unit::new("J", 2);
/// Contraction rates and whatever decays exponentially.
pub const RATE: Unit = Unit::new("1/s", 1);
/// Gains from positions to accelerations.
pub const RATE_2: Unit = Unit::new("1/s^2", 2).raised("1/s²");
/// Gains from velocities to fourth derivatives.
pub const RATE_3: Unit = Unit::new("1/s^3", 3).raised("1/s³");
/// Gains from positions to fourth derivatives.
pub const RATE_4: Unit = Unit::new("1/s^4", 4).raised("1/s⁴");

/// Joint positions and deflections of springs.
pub const ANGLE: Unit = Unit::new("rad", 0).sliding(&LENGTH);
/// Joint velocities, and frequencies and bandwidths in radians.
pub const SPEED: Unit = Unit::new("rad/s", 1).sliding(&Unit::new("m/s", 1));
/// Torques.
pub const TORQUE: Unit = Unit::new("N m", 2).sliding(&Unit::new("N", 2));
/// Rates of torques.
pub const TORQUE_RATE: Unit = Unit::new("N m/s", 3).sliding(&Unit::new("N/s", 3));
/// Stiffnesses, and metrics of position errors.
pub const STIFFNESS: Unit = Unit::new("N m/rad", 2).sliding(&Unit::new("N/m", 2));
/// How stiffnesses and metrics grow with the square of what is wound.
pub const HARDENING: Unit =
    Unit::new("N m/rad^3", 2).raised("N m/rad³").sliding(&Unit::new("N/m^3", 2).raised("N/m³"));
/// Stiffnesses of integrals of position errors.
pub const STIFFNESS_RATE: Unit = Unit::new("N m/(rad s)", 3).sliding(&Unit::new("N/(m s)", 3));
/// Velocities for torques.
pub const ADMITTANCE: Unit = Unit::new("rad/(N m s)", -1).sliding(&Unit::new("m/(N s)", -1));
/// Velocities for integrals of torques.
pub const ADMITTANCE_RATE: Unit = Unit::new("rad/(N m s^2)", 0)
    .raised("rad/(N m s²)")
    .sliding(&Unit::new("m/(N s^2)", 0).raised("m/(N s²)"));
/// Rates of adaptation.
pub const PER_ENERGY: Unit = Unit::new("1/J", -1);
/// Third derivatives of positions.
pub const JERK: Unit =
    Unit::new("rad/s^3", 3).raised("rad/s³").sliding(&Unit::new("m/s^3", 3).raised("m/s³"));
/// Fourth derivatives of positions.
pub const SNAP: Unit =
    Unit::new("rad/s^4", 4).raised("rad/s⁴").sliding(&Unit::new("m/s^4", 4).raised("m/s⁴"));
/// Dampings.
pub const DAMPING: Unit = Unit::new("N m s/rad", 1).sliding(&Unit::new("N s/m", 1));
/// Inertias.
pub const INERTIA: Unit = Unit::new("kg m^2", 0).raised("kg m²").sliding(&MASS);
/// Momenta.
pub const MOMENTUM: Unit = Unit::new("kg m^2/s", 1).raised("kg m²/s").sliding(&Unit::new("kg m/s", 1));

/// Keys of robot and scenario files whose numbers have a unit.
const KEYS: [(&[&str], Unit); 13] = [
    (&["duration", "control_period", "settle", "rise", "computation", "actuation"], TIME),
    (&["gravity"], ACCELERATION),
    (&["mass"], MASS),
    (&["length", "com"], LENGTH),
    (&["inertia", "motor_inertia"], INERTIA),
    (&["stiffness", "metric"], STIFFNESS),
    (&["link_damping", "motor_damping", "damping"], DAMPING),
    (&["torque_limit"], TORQUE),
    (&["torque_rate_limit"], TORQUE_RATE),
    (&["velocity_limit"], SPEED),
    (&["deflection_limit", "position_lower", "position_upper"], ANGLE),
    (&["spring_hardening", "metric_hardening"], HARDENING),
    (&["kappa"], RATE),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_several_joints_name_what_there_is() {
        use JointKind::{Prismatic, Revolute};
        let units = |kinds: &[JointKind]| of_joints(ANGLE, "m", kinds);
        assert_eq!(units(&[Revolute, Revolute]), "mrad");
        assert_eq!(units(&[Prismatic]), "mm");
        assert_eq!(units(&[Prismatic, Revolute]), "mrad or mm");
        assert_eq!(of_joints(TORQUE, "", &[Prismatic, Revolute]), "N m or N");
        assert_eq!(of_joints(TIME, "m", &[Prismatic, Revolute]), "ms", "the same of both");
    }

    /// Every unit, and for those of joints the power of rad that is the same power of m at a joint that slides: torque is energy
    /// per rad, inertia energy s²/rad².
    const ALL: [(Unit, i32); 23] = [
        (NONE, 0),
        (TIME, 0),
        (FREQUENCY, 0),
        (LENGTH, 0),
        (MASS, 0),
        (ACCELERATION, 0),
        (ENERGY, 0),
        (RATE, 0),
        (RATE_2, 0),
        (RATE_3, 0),
        (RATE_4, 0),
        (CONTROL_PERIODS, 0),
        (ANGLE, 1),
        (SPEED, 1),
        (TORQUE, -1),
        (TORQUE_RATE, -1),
        (STIFFNESS, -2),
        (HARDENING, -4),
        (DAMPING, -2),
        (INERTIA, -2),
        (MOMENTUM, -1),
        (MASS, 0),
        (LENGTH, 0),
    ];

    /// Powers of kg, m and s in a unit as it is written.
    fn powers(unit: &str) -> [i32; 3] {
        let mut total = [0; 3];
        for (part, sign) in unit.split('/').zip([1, -1]) {
            for factor in part.split_whitespace() {
                let (name, power) = factor.split_once('^').unwrap_or((factor, "1"));
                let power: i32 = sign * power.parse::<i32>().expect("a power");
                let base = match name {
                    "kg" => [1, 0, 0],
                    "m" => [0, 1, 0],
                    "s" => [0, 0, 1],
                    "Hz" => [0, 0, -1],
                    "N" => [1, 1, -2],
                    "J" => [1, 2, -2],
                    "rad" | "1" | "control" | "periods" => [0; 3],
                    other => panic!("{other} in {unit}"),
                };
                for (sum, one) in total.iter_mut().zip(base) {
                    *sum += power * one;
                }
            }
        }
        total
    }

    #[test]
    fn powers_of_the_speed_are_those_of_the_unit() {
        for (unit, _) in ALL {
            assert_eq!(powers(unit.plain)[2], -unit.per_second, "{}", unit.plain);
        }
    }

    #[test]
    fn sliding_joints_have_metres_for_radians() {
        for (unit, radians) in ALL {
            let sliding = unit.of(JointKind::Prismatic);
            let [kg, m, s] = powers(unit.plain);
            assert_eq!(powers(sliding.plain), [kg, m + radians, s], "{} and {}", unit.plain, sliding.plain);
            assert_eq!(sliding.per_second, unit.per_second);
            assert!(!sliding.plain.contains("rad"));
            assert_eq!(unit.of(JointKind::Revolute), unit);
        }
    }

    #[test]
    fn both_spellings_are_the_same_unit() {
        for (unit, _) in ALL.into_iter().flat_map(|(unit, r)| [(unit, r), (unit.of(JointKind::Prismatic), r)])
        {
            let raised = raised(unit.plain);
            assert_eq!(unit.raised, raised);
        }
    }

    #[test]
    fn keys_are_found_behind_their_tables() {
        assert_eq!(Unit::of_key("joints.shoulder.stiffness"), Some(STIFFNESS));
        assert_eq!(Unit::of_key("mass"), Some(MASS));
        assert_eq!(Unit::of_key("controller.phi"), None);
    }
}
