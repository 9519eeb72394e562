//! One `[[links.joint]]`.

use flexure_core::linalg::{Matrix, Vector};

use super::JointKind;
use super::inertia;
use super::rigid::{Pose, Rigid};
use crate::io::field::Field;
use crate::io::quantity;
use crate::io::table::Table;

/// A joint as the file gives it.
pub(super) struct Joint<'a> {
    /// The whole entry, for what is wrong with it as such.
    pub field: Field<'a>,
    pub name: &'a str,
    /// The parent's name, and where it stands; none for the base.
    pub parent: Option<(&'a str, Field<'a>)>,
    /// How it moves and about what; none if it is fixed.
    pub motion: Option<(JointKind, [f64; 3])>,
    /// Joint frame in the parent's frame.
    pub pose: Pose,
    pub body: Rigid,
}

const KINDS: &[(&str, Option<JointKind>)] =
    &[("revolute", Some(JointKind::Revolute)), ("prismatic", Some(JointKind::Prismatic)), ("fixed", None)];

const FIXED_KEYS: &[&str] =
    &["name", "parent", "kind", "xyz", "rpy", "mass", "com", "inertia", "inertia_rpy"];
const MOVING_KEYS: &[&str] =
    &["name", "parent", "kind", "xyz", "rpy", "mass", "com", "inertia", "inertia_rpy", "axis"];

pub(super) fn read<'a>(field: &Field<'a>) -> Option<Joint<'a>> {
    let table = field.any_table()?;
    let kind = table.choice("kind", KINDS);
    table.refuse_unknown(if kind == Some(None) { FIXED_KEYS } else { MOVING_KEYS });
    let name = table.required("name", "a name of its own").and_then(|field| field.text());
    let parent = table.optional("parent", |field| Some((field.text()?, field.clone())));
    let xyz = table.array_or("xyz", &quantity::POSITION, "x, y, z");
    let rpy = table.array_or("rpy", &quantity::ORIENTATION, "roll, pitch, yaw");
    let axis = axis(&table);
    let body = body(&table);
    let motion = match kind? {
        None => None,
        Some(kind) => Some((kind, axis?)),
    };
    Some(Joint {
        field: field.clone(),
        name: name?,
        parent: parent?,
        motion,
        pose: Pose::new(xyz?, rpy?),
        body: body?,
    })
}

/// The unit vector along `axis`; z without the key.
fn axis(table: &Table<'_>) -> Option<[f64; 3]> {
    let Some(field) = table.get("axis") else { return Some([0.0, 0.0, 1.0]) };
    let axis: [f64; 3] = field.array(&quantity::AXIS, "x, y, z")?;
    let norm = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm == 0.0 {
        field.error(
            "axis",
            format!("{} is zero, must be a direction", field.path),
            "the z axis is [0, 0, 1]",
        );
        return None;
    }
    if (norm - 1.0).abs() > 1e-9 {
        let message = format!("{} has length {norm}, is taken as a direction", field.path);
        field.warn("axis", message, "write a unit vector");
    }
    Some(axis.map(|x| x / norm))
}

/// Mass, and unless it is zero centre of mass and inertia.
fn body(table: &Table<'_>) -> Option<Rigid> {
    let mass = table.number("mass", &quantity::BODY_MASS);
    let massless = mass == Some(0.0);
    let given = |key| !massless || table.get(key).is_some();
    let com = if given("com") { table.array("com", &quantity::POSITION, "x, y, z") } else { Some([0.0; 3]) };
    let inertia = if given("inertia") { inertia::read(table) } else { Some(Matrix::ZERO) };
    Some(Rigid { mass: mass?, com: Vector(com?), inertia: inertia? })
}
