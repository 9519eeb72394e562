//! The links of a robot: `[links]` of a robot file.

pub(crate) mod assembly;
pub(crate) mod inertia;
pub(crate) mod joint;
mod load;
pub(crate) mod rigid;
mod tree;
mod urdf;
pub(crate) mod written;

pub use flexure_core::robots::{Body, JointKind};

use flexure_core::scalar::Interval;

use crate::files::base::Base;
use crate::files::decimals::Decimals;
use crate::files::field::{Field, Joints};
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;

/// What the links are, as data with numbers of type `C`.
#[derive(Clone, Debug, PartialEq)]
pub enum Links<C = f64> {
    /// Two links in a horizontal plane, in closed form; gravity does not act on them.
    PlanarTwoLink {
        /// Masses \[kg\].
        mass: [C; 2],
        /// Lengths \[m\]; the second plays no part in the dynamics.
        length: [C; 2],
        /// Distances of the centres of mass from the joints \[m\].
        com: [C; 2],
        /// Rotational inertias about the centres of mass [kg m²].
        inertia: [C; 2],
    },
    /// One link on a horizontal axis; q = 0 hangs along gravity.
    Pendulum {
        /// Mass \[kg\].
        mass: C,
        /// Distance of the centre of mass from the joint \[m\].
        com: C,
        /// Rotational inertia about the centre of mass [kg m²]; about the joint it is `inertia` + `mass` `com`².
        inertia: C,
    },
    /// A tree of moving joints, parents before children; fixed joints are already merged into the bodies.
    Tree(Vec<Body<C>>),
}

impl<C: Copy> Links<C> {
    /// Number of moving joints.
    pub fn joints(&self) -> usize {
        match self {
            Self::PlanarTwoLink { .. } => 2,
            Self::Pendulum { .. } => 1,
            Self::Tree(bodies) => bodies.len(),
        }
    }

    /// The same links with every number through `f`.
    fn map<D>(&self, f: impl Fn(C) -> D) -> Links<D> {
        match self {
            Self::PlanarTwoLink { mass, length, com, inertia } => Links::PlanarTwoLink {
                mass: mass.map(&f),
                length: length.map(&f),
                com: com.map(&f),
                inertia: inertia.map(&f),
            },
            Self::Pendulum { mass, com, inertia } => {
                Links::Pendulum { mass: f(*mass), com: f(*com), inertia: f(*inertia) }
            }
            Self::Tree(bodies) => Links::Tree(bodies.iter().map(|body| body.map(&f)).collect()),
        }
    }
}

/// A moving joint by name, and what the file of the links says of its drive.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingJoint {
    /// Name.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Defaults for its drive.
    pub drive: DriveDefaults,
}

/// What a URDF may say of a joint beside its geometry; none of it if the links stand in the robot file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveDefaults {
    /// Viscous damping [N m s/rad].
    pub damping: Option<f64>,
    /// Coulomb friction [N m]; no part of the model.
    pub friction: Option<f64>,
    /// Largest torque [N m].
    pub torque_limit: Option<f64>,
    /// Largest velocity [rad/s].
    pub velocity_limit: Option<f64>,
    /// Smallest position \[rad\].
    pub position_lower: Option<f64>,
    /// Largest position \[rad\].
    pub position_upper: Option<f64>,
}

impl MovingJoint {
    pub(crate) fn new(name: impl Into<String>, kind: JointKind) -> Self {
        Self { name: name.into(), kind, drive: DriveDefaults::default() }
    }

    /// `count` revolute joints called joint1, joint2, …
    fn numbered(count: usize) -> Vec<Self> {
        (1..=count).map(|i| Self::new(format!("joint{i}"), JointKind::Revolute)).collect()
    }
}

/// What a reader of links found.
pub(crate) struct Assembled {
    pub links: Links,
    /// The links that the decimals of the file make exactly, enclosed.
    pub enclosed: Links<Interval>,
    /// In the order of all per-joint numbers.
    pub joints: Vec<MovingJoint>,
}

impl Assembled {
    /// From links whose numbers stand in the file as they are.
    fn closed_form(links: Links, decimals: Decimals) -> Self {
        let joints = MovingJoint::numbered(links.joints());
        Self { enclosed: links.map(|x| decimals.enclose(x)), links, joints }
    }
}

/// A kind of links: its keys and its reader, which is told what paths are relative to. One line adds one.
type Reader = (&'static [&'static str], fn(&Table<'_>, &Base) -> Option<Assembled>);

const KINDS: &[(&str, Reader)] = &[
    ("planar-two-link", (&["kind", "mass", "length", "com", "inertia"], planar_two_link)),
    ("pendulum", (&["kind", "mass", "com", "inertia"], pendulum)),
    ("tree", (&["kind", "joint"], tree::read)),
    ("urdf", (&["kind", "file", "locked"], urdf::read)),
];

/// Reads `[links]`; the number of moving joints also if only the numbers in it are bad.
pub(crate) fn read(field: &Field<'_>, base: &Base) -> (Option<Assembled>, Option<usize>) {
    let Some(table) = field.any_table() else { return (None, None) };
    let Some((known, reader)) = table.choice("kind", KINDS) else { return (None, None) };
    table.refuse_unknown(known);
    let links = reader(&table, base);
    let count =
        links.as_ref().map(|found| found.joints.len()).or_else(|| match table.get("kind")?.text()? {
            "planar-two-link" => Some(2),
            "pendulum" => Some(1),
            _ => None,
        });
    (links, count)
}

fn planar_two_link(table: &Table<'_>, _: &Base) -> Option<Assembled> {
    let read = |key, quantity: &Quantity| table.array(key, quantity, "one per link");
    let (mass, length) = (read("mass", &quantity::MASS), read("length", &quantity::LENGTH));
    let (com, inertia) = (read("com", &quantity::POSITION), read("inertia", &quantity::INERTIA));
    let links = Links::PlanarTwoLink { mass: mass?, length: length?, com: com?, inertia: inertia? };
    Some(Assembled::closed_form(links, table.decimals()))
}

fn pendulum(table: &Table<'_>, _: &Base) -> Option<Assembled> {
    let (mass, com) = (table.number("mass", &quantity::MASS), table.number("com", &quantity::POSITION));
    let inertia = table.number("inertia", &quantity::INERTIA);
    let links = Links::Pendulum { mass: mass?, com: com?, inertia: inertia? };
    Some(Assembled::closed_form(links, table.decimals()))
}

/// Notes an error if gravity has a part that the closed form leaves out.
pub(crate) fn check_gravity(links: &Links, gravity: &[f64; 3], field: Option<Field<'_>>) {
    if let (Links::PlanarTwoLink { .. }, [x, y, _], Some(field)) = (links, gravity, field)
        && (*x != 0.0 || *y != 0.0)
    {
        let message = format!(
            "gravity has a horizontal part ({x}, {y}) m/s^2, must be (0, 0): planar-two-link moves in the horizontal plane"
        );
        field.error("gravity", message, "for an arm in a vertical plane write the links as kind = \"tree\"");
    }
}

/// The joints that per-joint arrays are about.
pub(crate) fn per_joint(robot: &str, count: Option<usize>) -> Joints {
    Joints { count, robot: robot.to_owned() }
}
