//! One `[[links.joint]]`.

use crate::files::field::Field;
use crate::files::quantity;
use crate::files::site::Site;
use crate::files::table::Table;
use crate::robot::links::assembly::{Joint, Motion};
use crate::robot::links::written::{Axis, Frame, Matter};
use crate::robot::links::{JointKind, MovingJoint, inertia};

/// A joint as the file gives it: its parent not yet found.
pub(crate) struct Entry<'a> {
    pub name: &'a str,
    /// The parent's name, and where it stands; none for the base.
    pub parent: Option<(&'a str, Field<'a>)>,
    pub joint: Joint<'a>,
}

const KINDS: &[(&str, Option<JointKind>)] =
    &[("revolute", Some(JointKind::Revolute)), ("prismatic", Some(JointKind::Prismatic)), ("fixed", None)];

const FIXED_KEYS: &[&str] =
    &["name", "parent", "kind", "xyz", "rpy", "mass", "com", "inertia", "inertia_rpy"];
const MOVING_KEYS: &[&str] =
    &["name", "parent", "kind", "xyz", "rpy", "mass", "com", "inertia", "inertia_rpy", "axis"];

pub(crate) fn read<'a>(field: &Field<'a>) -> Option<Entry<'a>> {
    let table = field.any_table()?;
    let kind = table.choice("kind", KINDS);
    table.refuse_unknown(if kind == Some(None) { FIXED_KEYS } else { MOVING_KEYS });
    let name = table.required("name", "a name of its own").and_then(|field| field.name(field.text()?));
    let parent = table.optional("parent", |field| Some((field.text()?, field.clone())));
    let xyz = table.array_or("xyz", &quantity::POSITION, "x, y, z");
    let rpy = table.array_or("rpy", &quantity::ORIENTATION, "roll, pitch, yaw");
    let axis = axis(&table);
    let matter = matter(&table);
    let name = name?;
    let motion = match kind? {
        None => Motion::Fixed,
        Some(kind) => Motion::Moving(MovingJoint::new(name, kind), axis?),
    };
    let site = Site { path: format!("{} ({name})", field.path), ..field.site.clone() };
    let joint = Joint { site, parent: None, motion, frame: Frame { xyz: xyz?, rpy: rpy? }, matter: matter? };
    Some(Entry { name, parent: parent?, joint })
}

/// The direction of `axis`; z without the key.
fn axis(table: &Table<'_>) -> Option<Axis> {
    let Some(field) = table.get("axis") else { return Some(Axis([0.0, 0.0, 1.0])) };
    direction(&field, field.array(&quantity::AXIS, "x, y, z")?)
}

/// The direction of `axis`; notes an error if it has none.
pub(crate) fn direction(site: &Site<'_>, axis: [f64; 3]) -> Option<Axis> {
    let norm = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm == 0.0 {
        site.error("axis", format!("{} is zero, must be a direction", site.path), "the z axis is [0, 0, 1]");
        return None;
    }
    if (norm - 1.0).abs() > ROUGH {
        let message = format!("{} has length {norm}, is taken as a direction", site.path);
        site.warn("axis", message, "write a unit vector");
    }
    Some(Axis(axis))
}

/// By how much a unit vector written with a few digits may miss length one.
const ROUGH: f64 = 1e-4;

/// Mass, and unless it is zero centre of mass and inertia.
fn matter(table: &Table<'_>) -> Option<Matter> {
    let mass = table.number("mass", &quantity::BODY_MASS);
    let massless = mass == Some(0.0);
    let given = |key| !massless || table.get(key).is_some();
    let com = if given("com") { table.array("com", &quantity::POSITION, "x, y, z") } else { Some([0.0; 3]) };
    let inertia = if given("inertia") { inertia::read(table) } else { Some(([0.0; 6], [0.0; 3])) };
    let (inertia, inertia_rpy) = inertia?;
    Some(Matter { mass: mass?, com: com?, inertia, inertia_rpy })
}
