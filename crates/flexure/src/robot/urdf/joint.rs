//! `<joint>`: how two links are connected, and what is said of its drive.

use crate::files::site::Site;
use crate::files::{quantity, suggest};
use crate::robot::links::joint::direction;
use crate::robot::links::written::{Axis, Frame, Matter};
use crate::robot::links::{DriveDefaults, JointKind};
use crate::robot::urdf::link::origin;
use crate::robot::urdf::node::Node;

/// A joint, with the body that it carries.
pub(crate) struct Joint<'a> {
    pub site: Site<'a>,
    pub name: &'a str,
    pub kind: Kind,
    /// Index of the joint that carries it in [`Urdf::joints`](super::Urdf), smaller than its own; none for the base.
    pub parent: Option<usize>,
    /// Joint frame in the parent's frame.
    pub frame: Frame,
    /// Joint axis in the joint frame.
    pub axis: Axis,
    pub drive: DriveDefaults,
    /// Limits under which it cannot move, if it has such.
    pub standstill: Option<Standstill<'a>>,
    pub mimic: Option<Mimic<'a>>,
    /// Name of the link that it carries.
    pub link: &'a str,
    pub matter: Matter,
}

/// Limits of zero, or a range without width: where they stand, and what they say.
pub(crate) struct Standstill<'a> {
    pub site: Site<'a>,
    pub said: String,
}

impl Joint<'_> {
    /// Whether it moves unless it is held still.
    pub fn moves(&self) -> bool {
        self.kind != Kind::Fixed
    }
}

/// Whether a joint moves, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Fixed,
    Moving(JointKind),
}

/// Position = multiplier × position of another joint + offset.
pub(crate) struct Mimic<'a> {
    pub site: Site<'a>,
    pub of: &'a str,
    pub multiplier: f64,
    pub offset: f64,
}

/// A joint whose links are known by name only.
pub(crate) struct Connection<'a> {
    pub joint: Joint<'a>,
    pub parent: (&'a str, Site<'a>),
    pub child: (&'a str, Site<'a>),
}

const KINDS: &[(&str, Kind)] = &[
    ("revolute", Kind::Moving(JointKind::Revolute)),
    ("continuous", Kind::Moving(JointKind::Revolute)),
    ("prismatic", Kind::Moving(JointKind::Prismatic)),
    ("fixed", Kind::Fixed),
];

pub(crate) fn read<'a>(name: &'a str, node: &Node<'a>) -> Option<Connection<'a>> {
    let text = node.text("type", "revolute, continuous, prismatic or fixed");
    let kind = text.as_ref().and_then(|(text, site)| kind(text, site));
    let end = |which| {
        node.required_child(which, "the name of a link: <parent link=\"…\"/>, <child link=\"…\"/>")
            .and_then(|node| node.text("link", "the name of a link"))
    };
    let (parent, child) = (end("parent"), end("child"));
    let origin = origin(node);
    let moves = kind != Some(Kind::Fixed);
    let axis = if moves { axis(node) } else { Some(X) };
    let continuous = text.is_some_and(|(text, _)| text == "continuous");
    let drive = if moves { drive(node, !continuous) } else { Some((DriveDefaults::default(), None)) };
    let mimic = mimic(node);
    let (drive, standstill) = drive?;
    let joint = Joint {
        site: node.site.clone(),
        name,
        kind: kind?,
        parent: None,
        frame: origin?,
        axis: axis?,
        drive,
        standstill,
        mimic: mimic?,
        link: child.as_ref()?.0,
        matter: Matter::NOTHING,
    };
    Some(Connection { joint, parent: parent?, child: child? })
}

fn kind(text: &str, site: &Site<'_>) -> Option<Kind> {
    let found = KINDS.iter().find(|(name, _)| *name == text).map(|&(_, kind)| kind);
    if found.is_none() {
        let known = KINDS.iter().map(|&(name, _)| name);
        let (objection, help) = match text {
            "floating" => {
                ("floating bases are not modelled", "if the base does not move make it 'fixed'".into())
            }
            "planar" => {
                ("planar joints are not modelled", "write two prismatic joints and a revolute one".into())
            }
            _ => ("which is not known", suggest::hint(text, known)),
        };
        site.error("joint-type", format!("{} is {}: {objection}", site.path, suggest::quoted(text)), help);
    }
    found
}

/// The axis of a joint that names none.
const X: Axis = Axis([1.0, 0.0, 0.0]);

/// The direction of `<axis>`.
fn axis(node: &Node<'_>) -> Option<Axis> {
    let Some(axis) = node.child("axis")? else { return Some(X) };
    direction(&axis.site, axis.numbers("xyz", &quantity::AXIS, "x, y, z", X.0)?)
}

#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
fn mimic<'a>(node: &Node<'a>) -> Option<Option<Mimic<'a>>> {
    let Some(mimic) = node.child("mimic")? else { return Some(None) };
    let of = mimic.text("joint", "the name of the joint that it follows");
    let multiplier = mimic.optional_number("multiplier", &quantity::MULTIPLIER);
    let offset = mimic.optional_number("offset", &quantity::ANGLE);
    let (of, _) = of?;
    let (multiplier, offset) = (multiplier?.unwrap_or(1.0), offset?.unwrap_or(0.0));
    Some(Some(Mimic { site: mimic.site.clone(), of, multiplier, offset }))
}

/// Limits of joint positions that no joint has \[rad\], but many have in degrees; what is beyond stands for none.
const DEGREES: std::ops::RangeInclusive<f64> = 30.0..=720.0;

/// What `<dynamics>` and `<limit>` say; limits under which the joint cannot move are apart.
fn drive<'a>(node: &Node<'a>, has_stops: bool) -> Option<(DriveDefaults, Option<Standstill<'a>>)> {
    let mut drive = DriveDefaults::default();
    if let Some(dynamics) = node.child("dynamics")? {
        drive.damping = dynamics.optional_number("damping", &quantity::DAMPING)?;
        drive.friction = dynamics.optional_number("friction", &quantity::FRICTION)?.filter(|&x| x > 0.0);
    }
    let Some(limit) = node.child("limit")? else { return Some((drive, None)) };
    let effort = limit.optional_number("effort", &quantity::EFFORT);
    let velocity = limit.optional_number("velocity", &quantity::SPEED);
    let lower = limit.optional_number("lower", &quantity::STOP);
    let upper = limit.optional_number("upper", &quantity::STOP);
    let (effort, velocity, lower, upper) = (effort?, velocity?, lower?, upper?);
    let mut said = Vec::new();
    let mut above_zero = |name: &str, limit: Option<f64>| {
        let sound = limit.filter(|&x| x > 0.0);
        if let (Some(x), None) = (limit, sound) {
            said.push(format!("{name} {x}"));
        }
        sound
    };
    drive.torque_limit = above_zero("effort", effort);
    drive.velocity_limit = above_zero("velocity", velocity);
    if has_stops && (lower.is_some() || upper.is_some()) {
        // As the format has it: a missing one is zero.
        let (low, high) = (lower.unwrap_or(0.0), upper.unwrap_or(0.0));
        if let Some(stop) = [low, high].into_iter().find(|stop| DEGREES.contains(&stop.abs())) {
            limit.site.warn(
                "suspicious",
                format!("limit of the joint position is {stop}, is suspicious"),
                "rad, or m for joints that slide: is it in degrees?",
            );
        }
        if low < high {
            (drive.position_lower, drive.position_upper) = (Some(low), Some(high));
        } else {
            said.push(format!("lower {low} with upper {high}"));
        }
    }
    let standstill = (!said.is_empty()).then(|| Standstill { site: limit.site, said: said.join(", ") });
    Some((drive, standstill))
}
