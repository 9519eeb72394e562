//! The file of a funnel: what it is about, what is claimed, and every slab; `docs/funnel.md` states what each number means.

use flexure_core::scalar::Interval;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::files::Problems;
use crate::prove::documents::{self, FUNNEL, ROOM, Told, lower, packed, text};
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::followed::Given;
use crate::prove::engine::envelope::shape::Shape;
use crate::prove::engine::number::Number;
use crate::prove::robust::Robust;
use crate::scenario::Scenario;

/// All of a file.
pub(super) type Document = documents::Document<Own>;

/// What it says beside what all files tell.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Own {
    pub duration: Value,
    pub limits: Value,
    pub tolerances: Tolerances,
    pub torques: Torques,
    pub claims: Claims,
    pub slabs: Vec<String>,
}

/// By how much the robot's numbers may be off either way, in decimals.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tolerances {
    pub stiffness: Vec<String>,
    pub motor_inertia: Vec<String>,
    pub link_damping: Vec<String>,
    pub motor_damping: Vec<String>,
    pub link_mass: Vec<String>,
}

/// The largest unknown torques, in decimals.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Torques {
    pub links: Vec<String>,
    pub motors: Vec<String>,
}

/// What is claimed of the slabs, in decimals; none where there is no bound.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Claims {
    pub room: String,
    pub rate: String,
    pub error: Vec<String>,
    pub velocity_error: Vec<String>,
    pub velocity: Vec<Option<String>>,
    pub deflection: Vec<Option<String>>,
    pub torque: Vec<Option<String>>,
    pub torque_rate: Vec<Option<String>>,
}

impl Robust {
    /// The file of this funnel of `scenario`: JSON, a line for each slab.
    ///
    /// # Errors
    /// If the scenario has no law that funnels speak of.
    ///
    /// # Panics
    /// Never: there is nothing in it that JSON cannot say.
    pub fn file(&self, scenario: &Scenario) -> Result<String, Problems> {
        let mut document = about(scenario, &self.spread)?;
        let above = |x: f64| text(Number::above(x * (1.0 + ROOM)));
        let all = |values: &[f64]| values.iter().map(|&x| above(x)).collect();
        let bounded = |values: &[f64]| values.iter().map(|&x| x.is_finite().then(|| above(x))).collect();
        document.own.claims = Claims {
            room: text(Number::decimal(self.room)),
            rate: text(Number::below(self.rate * (1.0 - ROOM))),
            error: all(&self.error),
            velocity_error: all(&self.velocity_error),
            velocity: bounded(&self.velocity.bound),
            deflection: bounded(&self.deflection.bound),
            torque: bounded(&self.torque.bound),
            torque_rate: bounded(&self.torque_rate.bound),
        };
        Ok(document.with_lines(self.funnel.iter().map(written)))
    }
}

/// What a file says of the loop of `scenario` and of what `spread` leaves open, without a funnel.
pub(super) fn about(scenario: &Scenario, spread: &Spread) -> Result<Document, Problems> {
    let limits = &scenario.robot.limits;
    let limited =
        |all: &[f64]| all.iter().map(|&x| x.is_finite().then(|| Number::decimal(x))).collect::<Vec<_>>();
    // The shortest of the decimals inside: that of the robot file, or of the question.
    let shortest = |x: &Interval| {
        let all = [x.midpoint(), x.lo(), x.hi()].map(|x| text(Number::decimal(x)));
        all.into_iter().min_by_key(String::len).unwrap_or_default()
    };
    let texts = |all: &[Interval]| all.iter().map(shortest).collect();
    let own = Own {
        duration: json!(Number::read(scenario.duration, scenario.bounds(scenario.duration))),
        limits: json!({
            "velocity": limited(&limits.velocity),
            "deflection": limited(&limits.deflection),
            "torque": limited(&limits.torque),
            "torque_rate": limited(&limits.torque_rate),
        }),
        tolerances: Tolerances {
            stiffness: texts(&spread.stiffness),
            motor_inertia: texts(&spread.motor_inertia),
            link_damping: texts(&spread.link_damping),
            motor_damping: texts(&spread.motor_damping),
            link_mass: texts(&spread.link_mass),
        },
        torques: Torques { links: texts(&spread.link_torque), motors: texts(&spread.motor_torque) },
        claims: Claims::default(),
        slabs: Vec::new(),
    };
    Ok(Document { told: Told::of(FUNNEL, scenario)?, own })
}

/// A slab as the file has it.
fn written(slab: &Given) -> String {
    let shape = |shape: &Shape| lower(&shape.lower).collect::<Vec<_>>();
    let shapes = slab.passage.0.iter().chain([&slab.around]).flat_map(shape);
    let times = slab.times.iter().copied();
    packed(times.chain(shapes).chain(slab.alpha.iter().copied()).chain(slab.tau.iter().copied()))
}
