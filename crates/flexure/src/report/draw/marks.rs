//! What figures of a run show beside its signals: limits of the joints, and what happens to the robot when.

use super::axes::Axes;
use super::range::Range;
use super::scene::Scene;
use super::style::{Color, PUSHED, STOPPED, Stroke};
use crate::imperfections::Push;
use crate::robot::{JointKind, Robot};
use crate::scenario::Scenario;
use crate::simulate::acting_limits;

/// A joint as figures know it.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMarks {
    /// Its name.
    pub name: String,
    /// How it moves, which says in what its numbers are.
    pub kind: JointKind,
    /// Largest motor torque that anything lets through [N m]; infinite where nothing limits it.
    pub torque_limit: f64,
    /// Smallest and largest link position \[rad\]; infinite where nothing limits it.
    pub positions: [f64; 2],
}

impl JointMarks {
    /// A revolute joint without limits.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            kind: JointKind::Revolute,
            torque_limit: f64::INFINITY,
            positions: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The joints of a scenario, with the torque limits that act in it.
    pub(crate) fn of(scenario: &Scenario) -> Vec<Self> {
        let Robot { joints, limits, .. } = &scenario.robot;
        let torque_limits = acting_limits(scenario);
        let of_joint = |i: usize| Self {
            name: joints[i].name.clone(),
            kind: joints[i].kind,
            torque_limit: torque_limits[i],
            positions: [limits.lower[i], limits.upper[i]],
        };
        (0..joints.len()).map(of_joint).collect()
    }
}

/// A span of time in which something happens to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening {
    /// When it begins \[s\].
    pub from: f64,
    /// When it ends \[s\].
    pub to: f64,
    /// What it is.
    pub what: What,
}

/// What happens to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Somebody pushes its links.
    Push,
    /// The guard has stopped it.
    Stop,
}

impl What {
    /// In legends.
    fn name(self) -> &'static str {
        match self {
            Self::Push => "push",
            Self::Stop => "stopped by the guard",
        }
    }

    fn color(self) -> Color {
        match self {
            Self::Push => PUSHED,
            Self::Stop => STOPPED,
        }
    }
}

/// What happens, for a legend, each once.
pub(crate) fn legend(happenings: &[Happening]) -> impl Iterator<Item = (String, Stroke)> {
    let there = |what: &What| happenings.iter().any(|happening| happening.what == *what);
    let entry = |what: What| (what.name().to_owned(), Stroke::solid(what.color(), 12.0));
    [What::Push, What::Stop].into_iter().filter(there).map(entry).collect::<Vec<_>>().into_iter()
}

/// When the links of a scenario are pushed.
pub(crate) fn pushes(scenario: &Scenario) -> Vec<Happening> {
    let pushes = scenario.imperfections.iter().filter_map(|imperfection| imperfection.of::<Push>());
    let pushed = pushes.filter(|push| push.torque.iter().any(|torque| *torque != 0.0));
    pushed
        .map(|push| Happening { from: push.from, to: push.from + push.duration, what: What::Push })
        .collect()
}

/// Shades the spans in a frame over time; to be called before anything else is drawn there.
pub(crate) fn shade(scene: &mut Scene, axes: &Axes, happenings: &[Happening]) {
    /// Spans that are shorter would not be seen [px].
    const NARROWEST: f64 = 2.0;
    let [_, top, _, height] = axes.frame;
    let Range { low, high } = axes.x.range;
    for Happening { from, to, what } in happenings.iter().filter(|span| span.to >= low && span.from <= high) {
        let [left, right] = [from, to].map(|t| axes.place(t.clamp(low, high), 0.0)[0]);
        let right = right.max(left + NARROWEST);
        let color = what.color();
        scene.rectangle([left, top, right - left, height], color, Stroke::solid(color, 0.0));
    }
}
