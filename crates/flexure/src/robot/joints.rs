//! `[joints]` of a robot file: springs, motors and limits, for all joints at once or joint by joint.

use std::cell::RefCell;

use crate::files::field::{Field, Joints};
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::files::{Problem, suggest};
use crate::robot::links::{DriveDefaults, MovingJoint};

/// What a robot file says of its joints, one entry per moving joint.
pub(crate) struct Drives {
    pub stiffness: Vec<f64>,
    pub motor_inertia: Vec<f64>,
    pub link_damping: Vec<f64>,
    pub motor_damping: Vec<f64>,
    pub gear_ratio: Option<Vec<f64>>,
    pub limits: Limits,
    /// Whether damping of the links' file is used.
    pub damping_of_links: bool,
}

/// What a joint must not exceed, one entry per moving joint; infinite where there is no limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Largest motor torque [N m].
    pub torque: Vec<f64>,
    /// Largest rate of the motor torque [N m/s].
    pub torque_rate: Vec<f64>,
    /// Largest joint velocity [rad/s].
    pub velocity: Vec<f64>,
    /// Largest deflection |ζ| of the springs \[rad\].
    pub deflection: Vec<f64>,
    /// Smallest link position \[rad\].
    pub lower: Vec<f64>,
    /// Largest link position \[rad\].
    pub upper: Vec<f64>,
}

/// Keys with one number per joint.
const KEYS: &[&str] = &[
    "stiffness",
    "motor_inertia",
    "link_damping",
    "motor_damping",
    "gear_ratio",
    "torque_limit",
    "torque_rate_limit",
    "velocity_limit",
    "deflection_limit",
    "position_lower",
    "position_upper",
];

/// `[joints]` and the tables in it that are about one joint.
struct Reader<'a> {
    table: Table<'a>,
    by_name: Vec<(usize, Table<'a>)>,
    joints: Joints,
    moving: &'a [MovingJoint],
    /// Numbers that stand as `nan` for what is still to be supplied: where, the joint, the key.
    wanted: RefCell<Vec<(Field<'a>, usize, &'static str)>>,
}

/// Reads `[joints]`; `moving` are the joints of the links, none if those could not be read.
pub(crate) fn read(field: &Field<'_>, joints: &Joints, moving: Option<&[MovingJoint]>) -> Option<Drives> {
    let table = field.any_table()?;
    let by_name = by_name(&table, moving);
    let moving = moving.unwrap_or_default();
    let wanted = RefCell::default();
    let reader = Reader { table, by_name: by_name?, joints: joints.clone(), moving, wanted };
    let damping_of_links =
        reader.is_silent("link_damping") && moving.iter().all(|joint| joint.drive.damping.is_some());
    let none = |_: &DriveDefaults| None;
    let stiffness = reader.required("stiffness", &quantity::STIFFNESS, none);
    let motor_inertia = reader.required("motor_inertia", &quantity::MOTOR_INERTIA, none);
    let link_damping = reader.required("link_damping", &quantity::DAMPING, |drive| drive.damping);
    let motor_damping = reader.required("motor_damping", &quantity::DAMPING, none);
    let gear_ratio = if reader.is_silent("gear_ratio") {
        Some(None)
    } else {
        reader.required("gear_ratio", &quantity::GEAR_RATIO, none).map(Some)
    };
    let limits = reader.limits();
    reader.say_what_is_wanted();
    Some(Drives {
        stiffness: stiffness?,
        motor_inertia: motor_inertia?,
        link_damping: link_damping?,
        motor_damping: motor_damping?,
        gear_ratio: gear_ratio?,
        limits: limits?,
        damping_of_links,
    })
}

/// What to do about numbers that are missing.
const SUPPLY: &str = "take them from data sheets or measurements, joint by joint or one for all in [joints]; `flexure import URDF \
                      --assume harmonic-drive` writes a file with numbers that are typical of such drives";

/// One error for all numbers that are still to be supplied: joints with the keys that they lack. A line a joint, or one for
/// all if all lack the same.
pub(crate) fn wanted(lacking: &[(&str, Vec<&str>)]) -> Problem {
    let count = lacking.iter().map(|(_, keys)| keys.len()).sum::<usize>();
    let numbers = if count == 1 { "1 number is".to_owned() } else { format!("{count} numbers are") };
    let line =
        |(name, keys): &(&str, Vec<&str>)| format!("\n  joint {}: {}", suggest::key(name), keys.join(", "));
    let table: String = match lacking {
        [(first, keys), .., (last, _)] if lacking.iter().all(|(_, other)| other == keys) => {
            let (first, last) = (suggest::key(first), suggest::key(last));
            format!("\n  each of {} joints, {first} to {last}: {}", lacking.len(), keys.join(", "))
        }
        lacking => lacking.iter().map(line).collect(),
    };
    Problem::new("missing-number", format!("{numbers} still to be supplied (nan):{table}"), SUPPLY)
}

/// The tables `[joints.NAME]` with the index of the joint; notes an error at a key that is neither a number per joint
/// nor a joint.
fn by_name<'a>(table: &Table<'a>, moving: Option<&[MovingJoint]>) -> Option<Vec<(usize, Table<'a>)>> {
    let mut found = Vec::new();
    let mut sound = Some(());
    for (key, field) in table.fields() {
        if !field.value.is_table() {
            continue;
        }
        let Some(moving) = moving else { continue };
        match moving.iter().position(|joint| joint.name == key) {
            Some(index) => found.push((index, field.table(KEYS)?)),
            // A bad value, reported as such.
            None if KEYS.contains(&key) => {}
            None => {
                let message = format!("[{}] names no moving joint", field.path);
                let help = suggest::hint(key, moving.iter().map(|joint| &*joint.name));
                field.error("unknown-joint", message, help);
                sound = None;
            }
        }
    }
    let tables: Vec<&str> =
        table.fields().filter(|(_, field)| field.value.is_table()).map(|(key, _)| key).collect();
    table.refuse_unknown_but(KEYS, &tables);
    sound.map(|()| found)
}

impl Reader<'_> {
    /// Whether nothing is said of `key`.
    fn is_silent(&self, key: &str) -> bool {
        self.table.get(key).is_none() && self.by_name.iter().all(|(_, table)| table.get(key).is_none())
    }

    /// What is known of `key`: joint by joint, else for all joints, else by the file of the links.
    fn values(
        &self,
        key: &'static str,
        quantity: &Quantity,
        default: impl Fn(&DriveDefaults) -> Option<f64>,
    ) -> Option<Vec<Option<f64>>> {
        let mut values: Vec<_> = self.moving.iter().map(|joint| default(&joint.drive)).collect();
        let mut sound = Some(());
        let is_joint = self.moving.iter().any(|joint| joint.name == key);
        if let Some(field) = self.table.get(key).filter(|field| !(is_joint && field.value.is_table())) {
            let wanting = self.wanting(&field);
            if wanting.is_empty() {
                match field.per_joint(&self.joints, quantity) {
                    Some(given) => values = given.into_iter().map(Some).collect(),
                    None => sound = None,
                }
            } else {
                self.wanted.borrow_mut().extend(wanting.into_iter().map(|i| (field.clone(), i, key)));
                sound = None;
            }
        }
        for (index, table) in &self.by_name {
            let Some(field) = table.get(key) else { continue };
            if field.is_nan() {
                self.wanted.borrow_mut().push((field, *index, key));
                sound = None;
                continue;
            }
            match (field.number(quantity), values.get_mut(*index)) {
                (Some(x), Some(value)) => *value = Some(x),
                _ => sound = None,
            }
        }
        sound.map(|()| values)
    }

    /// The joints for which `field`, one number or one for each, says `nan`.
    fn wanting(&self, field: &Field<'_>) -> Vec<usize> {
        if field.is_nan() {
            return (0..self.moving.len()).collect();
        }
        field.nans()
    }

    /// One error for all numbers that are still to be supplied, joint by joint.
    fn say_what_is_wanted(&self) {
        let wanted = self.wanted.borrow();
        let Some((first, ..)) = wanted.first() else { return };
        let of_joint = |index: usize| -> Vec<&str> {
            wanted.iter().filter(|(_, joint, _)| *joint == index).map(|(_, _, key)| *key).collect()
        };
        let lacking = self.moving.iter().enumerate().map(|(i, joint)| (joint.name.as_str(), of_joint(i)));
        let lacking: Vec<_> = lacking.filter(|(_, keys)| !keys.is_empty()).collect();
        first.log.push(self::wanted(&lacking).at(&first.log.source, first.span.clone()));
    }

    fn required(
        &self,
        key: &'static str,
        quantity: &Quantity,
        default: impl Fn(&DriveDefaults) -> Option<f64>,
    ) -> Option<Vec<f64>> {
        let values = self.values(key, quantity, default)?;
        // Of links that could not be read it cannot be told what is missing.
        self.joints.count?;
        if self.is_silent(key) && values.iter().all(Option::is_none) {
            let what = format!("{}, {}", self.joints.expected(), quantity.described());
            self.table.required(key, &what);
            return None;
        }
        let missing = values.iter().position(Option::is_none);
        if let Some(joint) = missing.and_then(|index| self.moving.get(index)) {
            let table =
                self.by_name.iter().find(|(index, _)| Some(*index) == missing).map(|(_, table)| table);
            let key = format!("joints.{}.{key}", suggest::key(&joint.name));
            table.unwrap_or(&self.table).error(
                "missing-key",
                format!("missing key {key}"),
                quantity.described(),
            );
            return None;
        }
        Some(values.into_iter().flatten().collect())
    }

    fn limits(&self) -> Option<Limits> {
        let read = |key, quantity: &Quantity, none: f64, default: fn(&DriveDefaults) -> Option<f64>| {
            let values = self.values(key, quantity, default)?;
            Some(values.into_iter().map(|value| value.unwrap_or(none)).collect::<Vec<_>>())
        };
        let none = f64::INFINITY;
        let torque = read("torque_limit", &quantity::TORQUE_LIMIT, none, |drive| drive.torque_limit);
        let torque_rate = read("torque_rate_limit", &quantity::TORQUE_RATE_LIMIT, none, |_| None);
        let velocity = read("velocity_limit", &quantity::VELOCITY_LIMIT, none, |drive| drive.velocity_limit);
        let deflection = read("deflection_limit", &quantity::DEFLECTION_LIMIT, none, |_| None);
        let lower = read("position_lower", &quantity::STOP, -none, |drive| drive.position_lower);
        let upper = read("position_upper", &quantity::STOP, none, |drive| drive.position_upper);
        let (lower, upper) = (lower?, upper?);
        let ranges = lower.iter().zip(&upper).zip(self.moving).filter(|((lower, upper), _)| lower >= upper);
        let line = |((lower, upper), joint): ((&f64, &f64), &MovingJoint)| {
            format!("\n  joint {}: {lower} and {upper}", suggest::quoted(&joint.name))
        };
        let empty: String = ranges.map(line).collect();
        if !empty.is_empty() {
            let message = format!("position_lower must be less than position_upper:{empty}");
            self.table.error(
                "range",
                message,
                "limits of the link position, rad, or m for a prismatic joint",
            );
            return None;
        }
        Some(Limits {
            torque: torque?,
            torque_rate: torque_rate?,
            velocity: velocity?,
            deflection: deflection?,
            lower,
            upper,
        })
    }
}
