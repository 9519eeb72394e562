//! The links of a robot: `[links]` of a robot file.

mod inertia;
mod joint;
mod rigid;
mod tree;

pub use flexure_core::robots::{Body, JointKind};

use super::field::{Field, Joints};
use super::quantity::{self, Quantity};
use super::table::Table;

/// What the links are, as data.
#[derive(Clone, Debug, PartialEq)]
pub enum Links {
    /// Two links in a horizontal plane, in closed form; gravity does not act on them.
    PlanarTwoLink {
        /// Masses \[kg\].
        mass: [f64; 2],
        /// Lengths \[m\]; the second plays no part in the dynamics.
        length: [f64; 2],
        /// Distances of the centres of mass from the joints \[m\].
        com: [f64; 2],
        /// Rotational inertias about the centres of mass [kg m²].
        inertia: [f64; 2],
    },
    /// One link on a horizontal axis; q = 0 hangs along gravity.
    Pendulum {
        /// Mass \[kg\].
        mass: f64,
        /// Distance of the centre of mass from the joint \[m\].
        com: f64,
        /// Rotational inertia about the centre of mass [kg m²]; about the joint it is `inertia` + `mass` `com`².
        inertia: f64,
    },
    /// A tree of moving joints, parents before children; fixed joints are already merged into the bodies.
    Tree(Vec<Body>),
}

impl Links {
    /// Number of moving joints.
    pub fn joints(&self) -> usize {
        match self {
            Self::PlanarTwoLink { .. } => 2,
            Self::Pendulum { .. } => 1,
            Self::Tree(bodies) => bodies.len(),
        }
    }
}

/// A kind of links: its keys and its reader. One line adds one.
type Reader = (&'static [&'static str], fn(&Table<'_>) -> Option<Links>);

const KINDS: &[(&str, Reader)] = &[
    ("planar-two-link", (&["kind", "mass", "length", "com", "inertia"], planar_two_link)),
    ("pendulum", (&["kind", "mass", "com", "inertia"], pendulum)),
    ("tree", (&["kind", "joint"], tree::read)),
    ("urdf", (&["kind", "file", "locked"], urdf)),
];

/// Reads `[links]`; the number of moving joints also if only the numbers in it are bad.
pub(super) fn read(field: &Field<'_>) -> (Option<Links>, Option<usize>) {
    let Some(table) = field.any_table() else { return (None, None) };
    let Some((known, reader)) = table.choice("kind", KINDS) else { return (None, None) };
    table.refuse_unknown(known);
    let links = reader(&table);
    let count = links.as_ref().map(Links::joints).or_else(|| match table.get("kind")?.text()? {
        "planar-two-link" => Some(2),
        "pendulum" => Some(1),
        _ => None,
    });
    (links, count)
}

fn planar_two_link(table: &Table<'_>) -> Option<Links> {
    let read = |key, quantity: &Quantity| table.array(key, quantity, "one per link");
    let (mass, length) = (read("mass", &quantity::MASS), read("length", &quantity::LENGTH));
    let (com, inertia) = (read("com", &quantity::POSITION), read("inertia", &quantity::INERTIA));
    Some(Links::PlanarTwoLink { mass: mass?, length: length?, com: com?, inertia: inertia? })
}

fn pendulum(table: &Table<'_>) -> Option<Links> {
    let (mass, com) = (table.number("mass", &quantity::MASS), table.number("com", &quantity::POSITION));
    let inertia = table.number("inertia", &quantity::INERTIA);
    Some(Links::Pendulum { mass: mass?, com: com?, inertia: inertia? })
}

fn urdf(table: &Table<'_>) -> Option<Links> {
    let help =
        "write the links as kind = \"tree\"; robots/panda.toml was made from a URDF by tools/urdf_to_tree.py";
    table.get("kind")?.error("unsupported", "links.kind is 'urdf': URDF import is not in this version", help);
    None
}

/// Notes an error if gravity has a part that the closed form leaves out.
pub(super) fn check_gravity(links: &Links, gravity: &[f64; 3], field: Option<Field<'_>>) {
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
pub(super) fn per_joint(robot: &str, count: Option<usize>) -> Joints {
    Joints { count, robot: robot.to_owned() }
}
