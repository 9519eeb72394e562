//! Robot files.

use std::path::Path;

use flexure_core::scalar::Interval;

use crate::files::base::Base;
use crate::files::change::Change;
use crate::files::decimals::Decimals;
use crate::files::document::{self, Form};
use crate::files::normal::Normal;
use crate::files::source::Source;
use crate::files::table::Table;
use crate::files::{Assumption, Outside, Places, Problem, Problems, provenance, quantity};
use crate::robot::JointKind;
use crate::robot::joints::{self, Drives, Limits};
use crate::robot::links::{self, Assembled, Links, MovingJoint};
use crate::robot::looks::Looks;
use crate::robot::tolerances::{self, Tolerances};

/// A flexible-joint robot as data: links, and per moving joint (in the order of the links) motor and spring.
///
/// ```
/// let robot = flexure::Robot::load("panda")?;
/// assert_eq!(robot.joint_count(), 7);
/// assert_eq!(robot.joints[0].name, "panda_joint1");
/// assert!(robot.stiffness.iter().all(|&k| k >= 4000.0)); // N m/rad
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Robot {
    /// Name of the robot, as in its file.
    pub name: String,
    /// Acceleration of gravity in the base frame [m/s²].
    pub gravity: [f64; 3],
    /// The rigid links, as in the file or its URDF.
    pub links: Links,
    /// The links that the decimals of the files make exactly, enclosed: 0.1 is a tenth, and what follows from it by sines
    /// and roots is bounded. Whoever changes `links` changes this too.
    pub enclosed: Links<Interval>,
    /// The moving joints, in the order of everything that is given per joint.
    pub joints: Vec<MovingJoint>,
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
    /// What the joints must not exceed.
    pub limits: Limits,
    /// How far the robot that is meant may be from the numbers of its springs, motors and dampers.
    pub tolerances: Tolerances,
    /// Numbers that no source vouches for.
    pub assumed: Vec<Assumption>,
    /// What is suspicious in the file.
    pub warnings: Vec<Problem>,
    /// Line and column of each key of the file, for messages.
    pub places: Places,
    pub(crate) decimals: Decimals,
    /// What its links look like.
    pub(crate) looks: Looks,
    /// SHA-256 of what the files say, in hexadecimal.
    pub(crate) digest: String,
}

impl Robot {
    /// Which joints turn, which slide, in their order.
    pub fn kinds(&self) -> Vec<JointKind> {
        self.joints.iter().map(|joint| joint.kind).collect()
    }

    /// Number of moving joints.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Encloses the decimal that `x`, a number of the robot file or of its URDF, was read from: 0.1 as a tenth, what is a
    /// float as a point. Infinity, where there is no limit, is itself.
    pub fn bounds(&self, x: f64) -> Interval {
        self.decimals.enclose(x)
    }

    /// Numbers that no source vouches for.
    pub fn assumptions(&self) -> Vec<Assumption> {
        self.assumed.clone()
    }

    /// SHA-256 of what its files say, in hexadecimal: the same for files that differ in comments and spaces only.
    pub fn digest(&self) -> &str {
        &self.digest
    }
}

/// Reads a robot from `text`; `name` stands for the file in messages, relative paths in it start from `folder`
/// and stay there or below.
///
/// # Errors
/// With everything that is wrong.
pub fn robot_from_text(name: &str, text: &str, folder: &Path) -> Result<Robot, Problems> {
    read(&Source::new(name, text), &Base::Folder(folder.to_owned(), Outside::Refused), &[])
}

/// Acceleration of gravity where nothing is said [m/s²].
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

const FORM: Form = Form {
    what: "robot file",
    required: &["name", "links", "joints"],
    optional: &["gravity", "sources", "tolerances"],
    other: ("controller", "scenario file", "give the robot that robot = \"...\" in it names"),
};

pub(crate) fn read(source: &Source, base: &Base, changes: &[Change]) -> Result<Robot, Problems> {
    let (mut robot, warnings) =
        document::parse(source, changes, &FORM, |root, places| robot(root, places, base))?;
    robot.warnings = warnings;
    Ok(robot)
}

fn robot(root: &Table<'_>, places: &Places, base: &Base) -> Option<Robot> {
    let name = root.required("name", "what the robot is called").and_then(|field| field.name(field.text()?));
    let gravity = root.optional("gravity", |field| field.array(&quantity::GRAVITY, "x, y, z"));
    let (links, count) = root
        .required("links", "a table with the kind")
        .map_or((None, None), |field| links::read(&field, base));
    if let (Some(links), Some(Some(gravity))) = (&links, &gravity) {
        links::check_gravity(&links.links, gravity, root.get("gravity"));
    }
    let per_joint = links::per_joint(name.unwrap_or("the robot"), count);
    let drives = root
        .required("joints", "a table with stiffness, motor_inertia, link_damping, motor_damping")
        .and_then(|field| joints::read(&field, &per_joint, links.as_ref().map(|links| &*links.joints)));
    let tolerances =
        root.optional("tolerances", |field| tolerances::read(field, &per_joint, drives.as_ref()));
    let assumed = provenance::assumptions(root, places);
    let (links, drives, mut assumed) = (links?, drives?, assumed?);
    let tolerances = tolerances?.unwrap_or_else(|| Tolerances::none(links.joints.len()));
    assumed.extend(of_the_links(&links, &drives, places));
    Some(Robot {
        name: name?.to_owned(),
        gravity: gravity?.unwrap_or(GRAVITY),
        links: links.links,
        enclosed: links.enclosed,
        joints: links.joints,
        stiffness: drives.stiffness,
        motor_inertia: drives.motor_inertia,
        link_damping: drives.link_damping,
        motor_damping: drives.motor_damping,
        gear_ratio: drives.gear_ratio,
        limits: drives.limits,
        tolerances,
        assumed,
        warnings: Vec::new(),
        places: places.clone(),
        decimals: root.decimals(),
        looks: links.looks,
        digest: normal(root).digest(),
    })
}

/// What a robot file says of the robot: names and free texts are left out, and what is said anyway.
fn normal(root: &Table<'_>) -> Normal {
    let gravity = Normal::List(GRAVITY.map(Normal::number).to_vec());
    root.normal().without(&["name", "sources"]).without_default("gravity", &gravity)
}

/// What is assumed of the damping in a URDF.
pub(crate) const DAMPING: &str =
    "damping of the URDF, which does not say on which side of the spring it acts";

/// What is assumed where the file of the links says less, or more, than the model needs.
fn of_the_links(links: &Assembled, drives: &Drives, places: &Places) -> Vec<Assumption> {
    let assumption = |key: &str, values: Vec<f64>, note: &str| Assumption {
        key: key.to_owned(),
        value: format!("{values:?}"),
        note: note.to_owned(),
        file: places.file().to_owned(),
    };
    let friction: Vec<_> = links.joints.iter().map(|joint| joint.drive.friction.unwrap_or(0.0)).collect();
    let damping = drives
        .damping_of_links
        .then(|| assumption("joints.link_damping", drives.link_damping.clone(), DAMPING));
    let friction = friction.iter().any(|&x| x != 0.0).then(|| {
        assumption("links.file", friction, "Coulomb friction of the URDF in N m, which the model leaves out")
    });
    damping.into_iter().chain(friction).collect()
}
