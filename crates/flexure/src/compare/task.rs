//! What laws are compared on.

use crate::feasible::{effort, pinned};
use crate::files::number::duration;
use crate::files::{Problem, Problems, Reading, TASKS};
use crate::imperfections::Imperfection;
use crate::scenario::{Scenario, load_scenario_with};

/// Names of built-in tasks begin with it; left out where only tasks are named.
const PREFIX: &str = "task-";

/// A scenario whose controller is replaced by each law in turn.
#[derive(Clone, Debug)]
pub struct Task {
    /// The scenario, its reference at the speed that was found for it.
    pub scenario: Scenario,
    /// Root mean square of the motor torque that the reference takes, by the model that the laws know [N m].
    pub needed_torque: f64,
}

impl Task {
    /// Of a scenario.
    ///
    /// # Errors
    /// If its robot has too many joints, or its reference is no path or keeps no limits at any speed.
    pub fn new(scenario: &Scenario) -> Result<Self, Problems> {
        let scenario = pinned(&scenario.by_collocation())?;
        let needed_torque = effort(&scenario)?;
        Ok(Self { scenario, needed_torque })
    }

    /// Name in tables and figures: that of the scenario without `task-`.
    pub fn name(&self) -> &str {
        self.scenario.name.strip_prefix(PREFIX).unwrap_or(&self.scenario.name)
    }

    /// Whether its imperfections draw random numbers.
    pub fn is_random(&self) -> bool {
        self.scenario.imperfections.iter().any(Imperfection::draws)
    }

    /// Robot, control period and what is not ideal, in words.
    pub fn conditions(&self) -> String {
        let Scenario { robot, control_period, .. } = &self.scenario;
        let extras = self.scenario.conditions();
        let extras = if extras.is_empty() { "nothing else".to_owned() } else { extras.join(", ") };
        format!(
            "{}, {:.3} s, torque held for {}; {extras}",
            robot.name,
            self.scenario.duration,
            duration(*control_period)
        )
    }
}

/// Tasks from scenario files or names of built-in scenarios; without any, [the suite](TASKS). `reading` says whether files may
/// name files outside of their folders, and what is changed in each.
///
/// # Errors
/// With everything that is wrong with one of them, and for a scenario that is named twice.
pub fn tasks<'a>(scenarios: &[String], reading: impl Into<Reading<'a>>) -> Result<Vec<Task>, Problems> {
    let reading = reading.into();
    let suite = TASKS.iter().map(|(name, _)| (*name).to_owned()).collect::<Vec<_>>();
    let mut tasks: Vec<Task> = Vec::new();
    for path in if scenarios.is_empty() { &suite } else { scenarios } {
        let scenario = load_scenario_with(path, reading)?;
        if tasks.iter().any(|task| task.scenario.name == scenario.name) {
            let message = format!("two scenarios are called {}", scenario.name);
            let hint = "name each scenario once; a file's name without its ending tells them apart";
            return Err(Problem::new("twice", message, hint).into());
        }
        tasks.push(Task::new(&scenario)?);
    }
    Ok(tasks)
}
