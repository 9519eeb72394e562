//! Robot files.

use super::diagnostic::{Problem, Problems};
use super::document::{self, Form, Places};
use super::links::{self, Links};
use super::provenance::{self, Assumption};
use super::quantity::{self, Quantity};
use super::source::Source;
use super::table::Table;

/// A flexible-joint robot as data: links, and per moving joint (in the order of the links) motor and spring.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Name.
    pub name: String,
    /// Acceleration of gravity in the base frame [m/s²].
    pub gravity: [f64; 3],
    /// The links.
    pub links: Links,
    /// Joint stiffness K, > 0 [N m/rad].
    pub stiffness: Vec<f64>,
    /// Motor inertia M_m, > 0 [kg m²].
    pub motor_inertia: Vec<f64>,
    /// Link damping D_l, ≥ 0 [N m s/rad].
    pub link_damping: Vec<f64>,
    /// Motor damping D_m, ≥ 0 [N m s/rad].
    pub motor_damping: Vec<f64>,
    /// Gear ratios, motor turns per joint turn (per metre for a prismatic joint); what couples rotors and links.
    pub gear_ratio: Option<Vec<f64>>,
    /// Largest motor torque [N m].
    pub torque_limit: Option<Vec<f64>>,
    /// Largest joint velocity [rad/s].
    pub velocity_limit: Option<Vec<f64>>,
    /// Largest deflection |ζ| of the springs \[rad\].
    pub deflection_limit: Option<Vec<f64>>,
    /// Numbers that no source vouches for.
    pub assumed: Vec<Assumption>,
    /// What is suspicious in the file.
    pub warnings: Vec<Problem>,
    /// Where the keys stand in the file.
    pub places: Places,
}

impl Robot {
    /// Number of moving joints.
    pub fn joints(&self) -> usize {
        self.links.joints()
    }

    /// Numbers that no source vouches for.
    pub fn assumptions(&self) -> Vec<Assumption> {
        self.assumed.clone()
    }
}

/// Reads a robot from `text`; `name` stands for the file in messages.
///
/// # Errors
/// With everything that is wrong.
pub fn robot_from_text(name: &str, text: &str) -> Result<Robot, Problems> {
    read(&Source::new(name, text))
}

const FORM: Form = Form {
    what: "robot file",
    required: &["name", "links", "joints"],
    optional: &["gravity", "sources"],
    other: ("controller", "scenario file", "give the robot that robot = \"...\" in it names"),
};

pub(super) fn read(source: &Source) -> Result<Robot, Problems> {
    let (mut robot, warnings) = document::parse(source, &FORM, robot)?;
    robot.warnings = warnings;
    Ok(robot)
}

fn robot(root: &Table<'_>, places: &Places) -> Option<Robot> {
    let name = root.required("name", "what the robot is called").and_then(|field| field.text());
    let gravity = root.optional("gravity", |field| field.array(&quantity::GRAVITY, "x, y, z"));
    let (links, count) =
        root.required("links", "a table with the kind").map_or((None, None), |field| links::read(&field));
    if let (Some(links), Some(Some(gravity))) = (&links, &gravity) {
        links::check_gravity(links, gravity, root.get("gravity"));
    }
    let joints = links::per_joint(name.unwrap_or("the robot"), count);
    let table = root.required("joints", "a table with stiffness, motor_inertia, link_damping, motor_damping");
    let table = table.and_then(|field| field.table(KEYS));
    let read = |key, quantity: &Quantity| table.as_ref()?.per_joint(key, &joints, quantity);
    let limit =
        |key, quantity: &Quantity| table.as_ref()?.optional(key, |field| field.per_joint(&joints, quantity));
    let stiffness = read("stiffness", &quantity::STIFFNESS);
    let motor_inertia = read("motor_inertia", &quantity::MOTOR_INERTIA);
    let link_damping = read("link_damping", &quantity::DAMPING);
    let motor_damping = read("motor_damping", &quantity::DAMPING);
    let gear_ratio = limit("gear_ratio", &quantity::GEAR_RATIO);
    let torque_limit = limit("torque_limit", &quantity::TORQUE_LIMIT);
    let velocity_limit = limit("velocity_limit", &quantity::VELOCITY_LIMIT);
    let deflection_limit = limit("deflection_limit", &quantity::DEFLECTION_LIMIT);
    let assumed = provenance::assumptions(root, places);
    Some(Robot {
        name: name?.to_owned(),
        gravity: gravity?.unwrap_or([0.0, 0.0, -9.81]),
        links: links?,
        stiffness: stiffness?,
        motor_inertia: motor_inertia?,
        link_damping: link_damping?,
        motor_damping: motor_damping?,
        gear_ratio: gear_ratio?,
        torque_limit: torque_limit?,
        velocity_limit: velocity_limit?,
        deflection_limit: deflection_limit?,
        assumed: assumed?,
        warnings: Vec::new(),
        places: places.clone(),
    })
}

const KEYS: &[&str] = &[
    "stiffness",
    "motor_inertia",
    "link_damping",
    "motor_damping",
    "gear_ratio",
    "torque_limit",
    "velocity_limit",
    "deflection_limit",
];
