//! A simulated robot that differs from the one that the law knows.

use std::mem::discriminant;

use crate::files::field::Field;
use crate::files::table::Table;
use crate::files::{quantity, suggest};
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::robot::{self, Robot};

/// What the simulated robot is; the law keeps the scenario's.
#[derive(Clone, Debug)]
pub struct ModelError {
    /// Another robot of the same kind of links and joint count; none for the scenario's.
    pub robot: Option<Box<Robot>>,
    /// What its numbers are multiplied by.
    pub factors: Factors,
    /// What it carries.
    pub payload: Option<Payload>,
}

/// Factors > 0, one per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// Of masses and rotational inertias of the bodies that the joints carry.
    pub mass: Vec<f64>,
    /// Of K.
    pub stiffness: Vec<f64>,
    /// Of D_l.
    pub link_damping: Vec<f64>,
    /// Of D_m.
    pub motor_damping: Vec<f64>,
    /// Of M_m.
    pub motor_inertia: Vec<f64>,
}

impl Factors {
    /// All 1: the robot as it is known.
    pub fn ones(joints: usize) -> Self {
        let ones = || vec![1.0; joints];
        Self {
            mass: ones(),
            stiffness: ones(),
            link_damping: ones(),
            motor_damping: ones(),
            motor_inertia: ones(),
        }
    }
}

/// A point mass on the last body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// Mass ≥ 0 \[kg\].
    pub mass: f64,
    /// Where, in the frame of the last joint \[m\]; the links of closed forms lie along x.
    pub position: [f64; 3],
}

impl ModelError {
    /// The robot that is simulated where the law knows `robot`.
    pub fn apply(&self, robot: &Robot) -> Robot {
        let mut plant = self.robot.as_deref().unwrap_or(robot).clone();
        for (values, factors) in [
            (&mut plant.stiffness, &self.factors.stiffness),
            (&mut plant.link_damping, &self.factors.link_damping),
            (&mut plant.motor_damping, &self.factors.motor_damping),
            (&mut plant.motor_inertia, &self.factors.motor_inertia),
        ] {
            for (value, factor) in values.iter_mut().zip(factors) {
                *value *= factor;
            }
        }
        plant.links.multiply_masses(&self.factors.mass);
        plant.enclosed.multiply_masses(&self.factors.mass);
        if let Some(Payload { mass, position }) = self.payload {
            plant.links.load(mass, position);
            plant.enclosed.load(mass, position);
        }
        plant
    }
}

/// The keys that are factors.
const FACTORS: [&str; 5] = ["mass", "stiffness", "link_damping", "motor_damping", "motor_inertia"];

impl Kind for ModelError {
    const NAME: &'static str = "model-error";
    const SUMMARY: &'static str = "a simulated robot that is not the one of the law";
    const KEYS: &'static [&'static str] =
        &["robot", "mass", "stiffness", "link_damping", "motor_damping", "motor_inertia", "payload"];
    const PLACE: Place = Place::Mechanics;
    const STRENGTHS: Strengths = Strengths {
        none: Some("stiffness = 1.0\nmass = 1.0\npayload = { mass = 0.0, position = [0.2, 0.0, 0.0] }"),
        little: "stiffness = 0.95",
        much: "stiffness = 0.7\npayload = { mass = 0.08, position = [0.2, 0.0, 0.0] }",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        if Self::KEYS.iter().all(|key| table.get(key).is_none()) {
            let hint = "give robot = \"FILE\", factors (mass, stiffness, link_damping, motor_damping, motor_inertia) or payload";
            table.error("missing-key", "model-error: nothing is given", hint);
            return None;
        }
        let robot = table.optional("robot", |field| other_robot(field, context).map(Box::new));
        if let (Some(_), Some(field)) = (table.get("robot"), FACTORS.iter().find_map(|key| table.get(key))) {
            let message = format!("{} is given, and another robot too", field.path);
            field.error(
                "contradiction",
                message,
                "give the robot's file with these numbers, or factors alone",
            );
        }
        let [mass, stiffness, link_damping, motor_damping, motor_inertia] =
            FACTORS.map(|key| match table.get(key) {
                Some(field) => field.per_joint(context.joints, &quantity::FACTOR),
                None => context.joints.count.map(|n| vec![1.0; n]),
            });
        let payload = table.optional("payload", |field| payload(field, context));
        let factors = Factors {
            mass: mass?,
            stiffness: stiffness?,
            link_damping: link_damping?,
            motor_damping: motor_damping?,
            motor_inertia: motor_inertia?,
        };
        Some(Self { robot: robot?, factors, payload: payload? })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Robot(Box::new(|robot| self.apply(robot)))
    }
}

/// The robot in another file, which must be of the same kind.
fn other_robot(field: &Field<'_>, context: &Context<'_>) -> Option<Robot> {
    let name = field.text()?;
    let other = field.absorb(robot::robot(name, context.base, &[]))?;
    let own = context.robot?;
    let (theirs, ours) = (other.joint_count(), own.joint_count());
    let fault = if theirs != ours {
        format!("has {theirs} moving joints, must have {ours} like {}", own.name)
    } else if discriminant(&other.links) != discriminant(&own.links) {
        format!("has another kind of links than {}", own.name)
    } else if own.joints.iter().zip(&other.joints).any(|(own, other)| own.kind != other.kind) {
        format!("has joints that move otherwise than those of {}", own.name)
    } else {
        return Some(other);
    };
    let message = format!("{}: {} {fault}", field.path, suggest::quoted(&other.name));
    field.error(
        "contradiction",
        message,
        "the law sees the joints of the simulated robot as its own: give one that differs in numbers only",
    );
    None
}

fn payload(field: &Field<'_>, context: &Context<'_>) -> Option<Payload> {
    let table = field.table(&["mass", "position"])?;
    let mass = table.number("mass", &quantity::PAYLOAD);
    let position = table.array("position", &quantity::POSITION, "x, y, z");
    let (mass, position) = (mass?, position?);
    if context.robot?.links.takes_load_at(&position) {
        return Some(Payload { mass, position });
    }
    let field = table.get("position")?;
    let message = format!("{} is {position:?} m, must be [x, 0, 0] for links in closed form", field.path);
    field.error(
        "range",
        message,
        "x is the distance from the last joint; for other places write the links as kind = \"tree\"",
    );
    None
}
