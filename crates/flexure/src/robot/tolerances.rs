//! `[tolerances]` of a robot file: how far springs, motors, dampers and the links' masses may be from the numbers of the file.

use crate::files::field::{Field, Joints};
use crate::files::quantity::{self, Quantity};
use crate::robot::joints::Drives;

/// Largest differences between the numbers of the file and those of the robot that is meant, either way, one entry per moving
/// joint; 0 where nothing is said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tolerances {
    /// Of the joint stiffness K, < K [N m/rad].
    pub stiffness: Vec<f64>,
    /// Of the motor inertia M_m, < M_m [kg m²].
    pub motor_inertia: Vec<f64>,
    /// Of the link damping D_l [N m s/rad].
    pub link_damping: Vec<f64>,
    /// Of the motor damping D_m [N m s/rad].
    pub motor_damping: Vec<f64>,
    /// Of the mass of what each joint carries up to the next ones, its inertia in proportion: as a part of it, < 1.
    pub link_mass: Vec<f64>,
}

/// Keys of the table: those of `[joints]` that they are about, and the masses of `[links]`.
const KEYS: &[&str] = &["stiffness", "motor_inertia", "link_damping", "motor_damping", "link_mass"];

impl Tolerances {
    /// None at all, of so many joints.
    pub fn none(joints: usize) -> Self {
        let none = || vec![0.0; joints];
        Self {
            stiffness: none(),
            motor_inertia: none(),
            link_damping: none(),
            motor_damping: none(),
            link_mass: none(),
        }
    }

    /// Whether every number is taken as it stands.
    pub fn are_none(&self) -> bool {
        self.named().iter().all(|(_, values)| values.iter().all(|&x| x == 0.0))
    }

    /// Whether the masses of all links are taken as they stand.
    pub fn masses_are_none(&self) -> bool {
        self.link_mass.iter().all(|&part| part == 0.0)
    }

    /// Each with its key.
    pub fn named(&self) -> [(&'static str, &[f64]); 5] {
        [
            ("stiffness", &self.stiffness),
            ("motor_inertia", &self.motor_inertia),
            ("link_damping", &self.link_damping),
            ("motor_damping", &self.motor_damping),
            ("link_mass", &self.link_mass),
        ]
    }
}

/// Reads `[tolerances]`; `drives` are the numbers that they are about, none if those could not be read.
pub(crate) fn read(field: &Field<'_>, joints: &Joints, drives: Option<&Drives>) -> Option<Tolerances> {
    let table = field.table(KEYS)?;
    let mut sound = Some(());
    let mut values = |key: &str, quantity: &Quantity, below: Option<&[f64]>| {
        let values = table.per_joint_or_zero(key, joints, quantity);
        let Some(tolerances) = &values else {
            sound = None;
            return Vec::new();
        };
        let beyond = below.and_then(|below| tolerances.iter().zip(below).position(|(t, x)| t >= x));
        if let (Some(joint), Some(below), Some(field)) = (beyond, below, table.get(key)) {
            let message = format!(
                "{} is {} for a {key} of {} (joint {}), must be less",
                field.path,
                quantity::shortest(tolerances[joint]),
                quantity::shortest(below[joint]),
                joint + 1
            );
            field.error("range", message, format!("{}: what is left must be > 0", quantity.described()));
            sound = None;
        }
        values.unwrap_or_default()
    };
    let stiffness =
        values("stiffness", &quantity::STIFFNESS_TOLERANCE, drives.map(|drives| &*drives.stiffness));
    let motor_inertia =
        values("motor_inertia", &quantity::INERTIA_TOLERANCE, drives.map(|drives| &*drives.motor_inertia));
    let link_damping = values("link_damping", &quantity::DAMPING_TOLERANCE, None);
    let motor_damping = values("motor_damping", &quantity::DAMPING_TOLERANCE, None);
    let whole = joints.count.map(|count| vec![1.0; count]);
    let link_mass = values("link_mass", &quantity::MASS_TOLERANCE, whole.as_deref());
    sound.map(|()| Tolerances { stiffness, motor_inertia, link_damping, motor_damping, link_mass })
}
