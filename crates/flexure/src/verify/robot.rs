//! The robot of the file, and whether its numbers are those of a robot.

use crate::verify::document::Certificate;
use crate::verify::field::Field;
use crate::verify::number::Number;
use crate::verify::verdict::{Claim, Rejected, ensure};

pub(super) struct Robot {
    pub name: String,
    pub joints: usize,
    pub stiffness: Vec<Number>,
    pub motor_inertia: Vec<Number>,
    pub link_damping: Vec<Number>,
    pub motor_damping: Vec<Number>,
    pub links: Links,
}

pub(super) enum Links {
    PlanarTwoLink(Box<PlanarTwoLink>),
    /// Mass, distance of the centre of mass, inertia about it.
    Pendulum(Box<[Number; 3]>),
    Tree(Vec<Body>),
}

pub(super) struct PlanarTwoLink {
    pub mass: [Number; 2],
    pub length: Number,
    pub com: [Number; 2],
    pub inertia: [Number; 2],
}

pub(super) struct Body {
    pub parent: Option<usize>,
    /// Of a prismatic joint; none of a revolute one.
    pub travel: Option<[Number; 2]>,
    pub axis: [Number; 3],
    pub rotation: [[Number; 3]; 3],
    pub translation: [Number; 3],
    pub mass: Number,
    pub com: [Number; 3],
    /// xx, xy, xz, yy, yz, zz.
    pub inertia: [Number; 6],
}

pub(super) fn read(field: &Field<'_>) -> Result<Robot, Rejected> {
    let [name, joints, stiffness, motor_inertia, link_damping, motor_damping, links] = field.object([
        "name",
        "joints",
        "stiffness",
        "motor_inertia",
        "link_damping",
        "motor_damping",
        "links",
    ])?;
    let n = joints.index()?;
    if !(1..=64).contains(&n) {
        return Err(joints.bad("must be 1 to 64"));
    }
    let links = self::links(&links, n)?;
    let needed = match &links {
        Links::PlanarTwoLink(_) => 2,
        Links::Pendulum(_) => 1,
        Links::Tree(bodies) => bodies.len(),
    };
    if n != needed {
        return Err(joints.bad(format!("must be {needed} for these links")));
    }
    Ok(Robot {
        name: name.text()?.to_owned(),
        joints: n,
        stiffness: stiffness.numbers(n)?,
        motor_inertia: motor_inertia.numbers(n)?,
        link_damping: link_damping.numbers(n)?,
        motor_damping: motor_damping.numbers(n)?,
        links,
    })
}

fn links(field: &Field<'_>, n: usize) -> Result<Links, Rejected> {
    let kind = field.get("kind")?.ok_or_else(|| field.bad("key 'kind' is missing"))?;
    match kind.one_of(&[("planar-two-link", 0), ("pendulum", 1), ("tree", 2)])? {
        0 => {
            let [_, mass, length, com, inertia] =
                field.object(["kind", "mass", "length", "com", "inertia"])?;
            Ok(Links::PlanarTwoLink(Box::new(PlanarTwoLink {
                mass: mass.array(Field::number)?,
                length: length.number()?,
                com: com.array(Field::number)?,
                inertia: inertia.array(Field::number)?,
            })))
        }
        1 => {
            let [_, mass, com, inertia] = field.object(["kind", "mass", "com", "inertia"])?;
            Ok(Links::Pendulum(Box::new([mass.number()?, com.number()?, inertia.number()?])))
        }
        _ => {
            let [_, bodies] = field.object(["kind", "bodies"])?;
            let bodies = bodies.list_of(n)?;
            Ok(Links::Tree(
                bodies.iter().enumerate().map(|(i, body)| self::body(body, i)).collect::<Result<_, _>>()?,
            ))
        }
    }
}

fn body(field: &Field<'_>, own: usize) -> Result<Body, Rejected> {
    const KEYS: [&str; 9] =
        ["kind", "parent", "axis", "rotation", "translation", "mass", "com", "inertia", "travel"];
    let travel = field.get("travel")?;
    let [kind, parent, axis, rotation, translation, mass, com, inertia] = if travel.is_some() {
        let [eight @ .., _] = field.object(KEYS)?;
        eight
    } else {
        let [eight @ .., _] = KEYS;
        field.object(eight)?
    };
    let prismatic = kind.one_of(&[("revolute", false), ("prismatic", true)])?;
    let travel = match (prismatic, travel.and_then(Field::unless_null)) {
        (false, None) => None,
        (true, Some(travel)) => Some(travel.array(Field::number)?),
        (true, None) => return Err(field.bad("a prismatic joint needs its travel")),
        (false, Some(travel)) => return Err(travel.bad("is for prismatic joints")),
    };
    let parent = match parent.unless_null() {
        None => None,
        Some(parent) => match parent.index()? {
            index if index < own => Some(index),
            _ => return Err(parent.bad("must come before its child")),
        },
    };
    Ok(Body {
        parent,
        travel,
        axis: axis.array(Field::number)?,
        rotation: rotation.array(|row| row.array(Field::number))?,
        translation: translation.array(Field::number)?,
        mass: mass.number()?,
        com: com.array(Field::number)?,
        inertia: inertia.array(Field::number)?,
    })
}

/// The signs of the numbers. (Axes, rotations and inertias of bodies: where they are used.)
pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let robot = &certificate.robot;
    positive("robot.stiffness", &robot.stiffness)?;
    positive("robot.motor_inertia", &robot.motor_inertia)?;
    nonnegative("robot.link_damping", &robot.link_damping)?;
    nonnegative("robot.motor_damping", &robot.motor_damping)?;
    match &robot.links {
        Links::PlanarTwoLink(arm) => {
            positive("robot.links.mass", &arm.mass)?;
            positive("robot.links.length", [&arm.length])?;
            positive("robot.links.inertia", &arm.inertia)?;
        }
        Links::Pendulum(body) => {
            let [mass, _, inertia] = body.as_ref();
            nonnegative("robot.links.mass", [mass])?;
            nonnegative("robot.links.inertia", [inertia])?;
        }
        Links::Tree(bodies) => {
            for (k, body) in bodies.iter().enumerate() {
                nonnegative(&format!("robot.links.bodies[{k}].mass"), [&body.mass])?;
                if let Some([lower, upper]) = &body.travel {
                    ensure(lower.is_at_most(upper), format!("robot.links.bodies[{k}].travel"), || {
                        format!("{lower} to {upper} is no range")
                    })?;
                }
            }
        }
    }
    for (name, side) in super::document::SIDES {
        let gains = certificate.controller.gains(side);
        positive(&format!("controller.{name}.metric"), &gains.metric)?;
        positive(&format!("controller.{name}.shaping"), &gains.shaping)?;
        positive(&format!("controller.{name}.damping"), &gains.damping)?;
        positive(&format!("controller.{name}.kappa"), &gains.kappa)?;
        nonnegative(&format!("controller.{name}.hardening"), &gains.hardening)?;
    }
    Ok(vec![Claim::new("robot, controller", format!("{} joints, signs as they must be", robot.joints))])
}

/// Every number is > 0.
pub(super) fn positive<'a>(
    claim: &str,
    numbers: impl IntoIterator<Item = &'a Number>,
) -> Result<(), Rejected> {
    signs(claim, numbers, Number::is_positive, "> 0")
}

/// Every number is ≥ 0.
pub(super) fn nonnegative<'a>(
    claim: &str,
    numbers: impl IntoIterator<Item = &'a Number>,
) -> Result<(), Rejected> {
    signs(claim, numbers, Number::is_nonnegative, ">= 0")
}

fn signs<'a>(
    claim: &str,
    numbers: impl IntoIterator<Item = &'a Number>,
    holds: impl Fn(&Number) -> bool,
    wanted: &str,
) -> Result<(), Rejected> {
    match numbers.into_iter().find(|number| !holds(number)) {
        Some(number) => Err(Rejected::claim(claim, format!("{number} is not {wanted}"))),
        None => Ok(()),
    }
}
