//! What is in a robot or scenario file: joints, assumed numbers, what the reference uses of the limits, whether the loop is stable that
//! holds its torque for a control period.

use serde::Serialize;

use crate::feasible::{self, Usage};
use crate::files::{Assumption, Problem, Problems, Reading};
use crate::robot::{JointRow, Robot, overview, supported};
use crate::sampled::{Sampled, not_looked_at, probe};
use crate::scenario::{self, Checked, Scenario};
use crate::simulate::preload;

/// What is in a good file.
///
/// ```
/// use flexure::check::Findings;
/// let found = Findings::of_file("two-link-hardware", flexure::files::Outside::Refused)?;
/// assert!(found.sampled.is_some_and(|sampled| sampled.spectral_radius < 1.0));
/// assert!(found.exceeded.is_empty());
/// # Ok::<(), flexure::Problems>(())
/// ```
#[derive(Debug, Serialize)]
pub struct Findings {
    /// "robot" or "scenario".
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// How many joints there are.
    pub joints: usize,
    /// How many numbers are assumed.
    pub assumptions: usize,
    /// Numbers that no source vouches for.
    pub assumed: Vec<Assumed>,
    /// The joints, for a robot file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<Vec<JointRow>>,
    /// What the reference uses of the limits, for a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<Along>,
    /// Gains that the file leaves to the starting rule, as `[controller]` of a scenario that gives them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub starting_gains: Option<String>,
    /// Whether the loop is stable that holds its torque for a control period, for a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampled: Option<Sampled>,
    /// The joints of the robot, also of that of a scenario.
    #[serde(skip)]
    pub rows: Vec<JointRow>,
    /// The name of the robot.
    #[serde(skip)]
    pub robot_name: String,
    /// What is suspicious.
    #[serde(skip)]
    pub warnings: Vec<Problem>,
    /// Limits that the reference of a good file exceeds, and that its loop is unstable.
    #[serde(skip)]
    pub exceeded: Vec<Problem>,
}

/// What the reference of a scenario does.
#[derive(Debug, Serialize)]
pub struct Along {
    /// Names of the joints.
    #[serde(skip)]
    pub joints: Vec<String>,
    /// Whether its clock goes at a speed of its own.
    #[serde(skip)]
    pub scaled: bool,
    /// Seconds of the reference per second of the run.
    pub speed: f64,
    /// What it uses of the robot's limits.
    pub usage: Vec<Usage>,
}

/// A number that no source vouches for.
#[derive(Debug, Serialize)]
pub struct Assumed {
    /// Where it stands, in the file.
    pub key: String,
    /// The number.
    pub value: String,
    /// What its source says.
    pub note: String,
}

impl Findings {
    /// What is in the file at a path, or in what is built in under a name.
    ///
    /// # Errors
    /// With everything that is wrong, if it cannot be used.
    pub fn of_file<'a>(path_or_name: &str, reading: impl Into<Reading<'a>>) -> Result<Self, Problems> {
        match scenario::check(path_or_name, reading)? {
            Checked::Robot(robot) => Self::of_robot(&robot),
            Checked::Scenario(scenario) => Self::of_scenario(&scenario),
        }
    }

    /// What is in a robot.
    ///
    /// # Errors
    /// If its joints cannot be looked at.
    pub fn of_robot(robot: &Robot) -> Result<Self, Problems> {
        let rows = overview(robot)?;
        let assumed = assumed(&robot.assumptions());
        Ok(Self {
            kind: "robot",
            name: robot.name.clone(),
            joints: rows.len(),
            assumptions: assumed.len(),
            assumed,
            robot: Some(rows.clone()),
            rows,
            robot_name: robot.name.clone(),
            reference: None,
            starting_gains: None,
            sampled: None,
            warnings: robot.warnings.clone(),
            exceeded: Vec::new(),
        })
    }

    /// What is in a scenario.
    ///
    /// # Errors
    /// If its robot has too many joints, or its loop cannot be set up.
    pub fn of_scenario(scenario: &Scenario) -> Result<Self, Problems> {
        supported(&scenario.robot)?;
        let reference = Along::of(scenario)?;
        let sampled = probe(scenario)?;
        let unstable = sampled.as_ref().and_then(|sampled| sampled.problem(scenario));
        let beyond = feasible::exceeded(scenario, &reference.usage);
        let unknown = not_looked_at(scenario).map(|words| {
            let help = "a longer control_period or less delay; `flexure run` shows what the loop does";
            scenario.places.problem("control_period", "sampled", words, help).warning()
        });
        let warnings = scenario.warnings.iter().cloned().chain(preload(scenario)?).chain(unknown).collect();
        let assumed = assumed(&scenario.assumptions);
        Ok(Self {
            kind: "scenario",
            name: scenario.name.clone(),
            joints: scenario.robot.joint_count(),
            assumptions: assumed.len(),
            assumed,
            robot: None,
            rows: overview(&scenario.robot)?,
            robot_name: scenario.robot.name.clone(),
            reference: Some(reference),
            starting_gains: scenario.has_starting_gains().then(|| scenario.controller.to_toml()),
            sampled,
            warnings,
            exceeded: unstable.into_iter().chain(beyond).collect(),
        })
    }
}

impl Along {
    fn of(scenario: &Scenario) -> Result<Self, Problems> {
        Ok(Self {
            joints: scenario.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
            scaled: scenario.time_scaling.is_some(),
            speed: feasible::speed(scenario)?,
            usage: feasible::usage(scenario)?,
        })
    }
}

fn assumed(assumptions: &[Assumption]) -> Vec<Assumed> {
    let listed = |Assumption { key, value, note, .. }: &Assumption| Assumed {
        key: key.clone(),
        value: value.clone(),
        note: note.clone(),
    };
    assumptions.iter().map(listed).collect()
}
