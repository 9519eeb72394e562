//! What the page of a run in motion is given, as JSON: the format is described in `viewer/README.md`.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

use super::Viewed;
use super::events::{Event, events};
use super::shapes::{Shape, Shaped, Shapes, shapes};
use crate::files::number::short;
use crate::files::{Problem, Problems};
use crate::imperfections::Push;
use crate::robot::{Body, MovingJoint, Placed, kind_in_words};
use crate::scenario::Scenario;
use crate::simulate::acting_limits;
use crate::units;

/// The version of the format.
const FORMAT: u32 = 1;

#[derive(Serialize)]
pub(super) struct Document {
    format: u32,
    program: String,
    runs: Vec<Run>,
}

#[derive(Serialize)]
struct Run {
    name: String,
    law: String,
    verdict: Verdict,
    robot: Pictured,
    samples: usize,
    columns: Columns,
    pushes: Vec<Pushed>,
    events: Vec<Event>,
}

#[derive(Serialize)]
struct Verdict {
    /// None where that is not known.
    good: Option<bool>,
    words: String,
}

#[derive(Serialize)]
struct Pictured {
    name: String,
    bodies: Vec<PicturedBody>,
    base_shapes: Vec<Shape>,
    gravity: [f64; 3],
    limits: Limits,
}

#[derive(Serialize)]
struct PicturedBody {
    joint: String,
    kind: &'static str,
    parent: Option<usize>,
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
    axis: [f64; 3],
    com: [f64; 3],
    mass: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    tip: Option<[f64; 3]>,
    shapes: Vec<Shape>,
}

/// Limits per joint, none where there is none.
#[derive(Serialize)]
struct Limits {
    torque: Vec<Option<f64>>,
    deflection: Vec<Option<f64>>,
    lower: Vec<Option<f64>>,
    upper: Vec<Option<f64>>,
    velocity: Vec<Option<f64>>,
}

#[derive(Serialize)]
struct Columns {
    t: Column,
    q_l: Vec<Column>,
    q_m: Vec<Column>,
    spring: Vec<Column>,
    u_m: Vec<Column>,
    q_ld: Vec<Column>,
    /// Not the difference of two columns: that has no digits left where errors are small.
    e_l: Vec<Column>,
    external: Option<Vec<Column>>,
}

/// Numbers as floats of 32 bits, the lowest byte first, in base 64: a third of what decimals take.
#[derive(Serialize)]
#[serde(transparent)]
struct Column(String);

#[derive(Serialize)]
struct Pushed {
    joint: usize,
    from: f64,
    to: f64,
    words: String,
}

impl Document {
    /// With warnings of robots whose links are not as their URDFs say.
    ///
    /// # Errors
    /// As [`Scenario::open`](crate::Scenario::open).
    pub(super) fn new(viewed: &[Viewed<'_>]) -> Result<(Self, Vec<Problem>), Problems> {
        let (mut runs, mut warnings) = (Vec::new(), Vec::new());
        for viewed in viewed {
            let (robot, warning) = pictured(viewed.scenario);
            runs.push(run(viewed, robot)?);
            warnings.extend(warning);
        }
        let program = format!("flexure {}", env!("CARGO_PKG_VERSION"));
        Ok((Self { format: FORMAT, program, runs }, warnings))
    }
}

fn run(viewed: &Viewed<'_>, robot: Pictured) -> Result<Run, Problems> {
    let Viewed { scenario, film, good, words, .. } = *viewed;
    let t = film.times();
    let [q_l, q_m, q_ld, e_l, u_m] = ["q_l", "q_m", "q_ld", "e_l", "u_m"].map(|prefix| film.signal(prefix));
    let [spring, external] = loads(scenario, &t, [&q_l, &q_m])?;
    let pushes = pushes(scenario);
    let columns = |signals: &[Vec<f64>]| signals.iter().map(|signal| Column::of(signal)).collect();
    Ok(Run {
        name: scenario.name.clone(),
        law: scenario.controller.in_words(),
        verdict: Verdict { good, words: words.to_owned() },
        robot,
        samples: t.len(),
        columns: Columns {
            t: Column::of(&t),
            q_l: columns(&q_l),
            q_m: columns(&q_m),
            spring: columns(&spring),
            u_m: columns(&u_m),
            q_ld: columns(&q_ld),
            e_l: columns(&e_l),
            external: (!pushes.is_empty()).then(|| columns(&external)),
        },
        pushes,
        events: events(viewed),
    })
}

/// Torques of the springs and of pushes on the links at the times `t` \[s\], joint by joint [N m].
fn loads(scenario: &Scenario, t: &[f64], q: [&[Vec<f64>]; 2]) -> Result<[Vec<Vec<f64>>; 2], Problems> {
    let (held, n) = (scenario.open()?, scenario.robot.joint_count());
    let mut loads = [vec![Vec::with_capacity(t.len()); n], vec![Vec::with_capacity(t.len()); n]];
    let (mut motion, mut spring, mut external) = (vec![0.0; 4 * n], vec![0.0; n], vec![0.0; n]);
    for (k, &t) in t.iter().enumerate() {
        for (slot, joint) in motion.iter_mut().zip(q.into_iter().flatten()) {
            *slot = joint[k];
        }
        held.loads(t, &motion, &mut spring, &mut external).expect("slices of n numbers");
        for (columns, numbers) in loads.iter_mut().zip([&spring, &external]) {
            columns.iter_mut().zip(numbers).for_each(|(column, number)| column.push(*number));
        }
    }
    Ok(loads)
}

impl Column {
    #[expect(clippy::cast_possible_truncation, reason = "what a picture shows has seven digits")]
    fn of(numbers: &[f64]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
        Self(BASE64_STANDARD.encode(bytes))
    }
}

/// The robot, and a warning if its links are not as its URDF says.
fn pictured(scenario: &Scenario) -> (Pictured, Option<Problem>) {
    let robot = &scenario.robot;
    let limits = &robot.limits;
    let of =
        |limits: &[f64]| limits.iter().map(|&limit| Some(limit).filter(|limit| limit.is_finite())).collect();
    let Shapes { base, bodies, warning } = shapes(robot);
    let bodies = robot.links.placed().into_iter().zip(&robot.joints).zip(bodies);
    let pictured = Pictured {
        name: robot.name.clone(),
        bodies: bodies.map(|((placed, joint), shapes)| body(placed, &joint.name, shapes)).collect(),
        base_shapes: base,
        gravity: robot.gravity,
        limits: Limits {
            // Of all that limit torques the first that acts.
            torque: of(&acting_limits(scenario)),
            deflection: of(&limits.deflection),
            lower: of(&limits.lower),
            upper: of(&limits.upper),
            velocity: of(&limits.velocity),
        },
    };
    (pictured, warning)
}

fn body(Placed { body, tip }: Placed, joint: &str, Shaped { shapes, tip: seen }: Shaped) -> PicturedBody {
    let Body { parent, kind, axis, rotation, translation, mass, com, .. } = body;
    PicturedBody {
        joint: joint.to_owned(),
        kind: kind_in_words(kind),
        parent,
        rotation,
        translation,
        axis,
        com,
        mass,
        tip: seen.or(tip),
        shapes,
    }
}

/// Who is pushed, when, and how much, a joint each.
fn pushes(scenario: &Scenario) -> Vec<Pushed> {
    let pushes = scenario.imperfections.iter().filter_map(|imperfection| imperfection.of::<Push>());
    let of_push = |push: &Push| {
        let (from, to) = (push.from, push.from + push.duration);
        let pushed = push.torque.iter().zip(&scenario.robot.joints).enumerate();
        let pushed = pushed.filter(|(_, (torque, _))| **torque != 0.0);
        let of_joint = |(joint, (torque, moving)): (usize, (&f64, &MovingJoint))| {
            let words = format!(
                "push of {} {} on {}",
                short(*torque, 3),
                units::TORQUE.of(moving.kind).plain,
                moving.name
            );
            Pushed { joint, from, to, words }
        };
        pushed.map(of_joint).collect::<Vec<_>>()
    };
    pushes.flat_map(of_push).collect()
}
