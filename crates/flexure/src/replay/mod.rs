//! A log laid over the simulation: where do robot and model part?
//!
//! Two simulations stand beside the log. The closed loop of the scenario, from its own start, shows what law, sensors and robot
//! do together; what it misses may be the model, the law, or a reference that was another. The prediction is the simulated robot
//! alone under the logged torque: it starts where the log is, and again after each window of some tenths of a second, because
//! a robot without its controller drifts away from any log, and over a window what the model misses shows clean.

mod closed_loop;
mod figures;
mod prediction;
mod readings;
mod start;

use serde::Serialize;

use crate::files::{Problem, Problems};
use crate::logs::Log;
use crate::progress::Progress;
use crate::scenario::Scenario;
use crate::simulate::Trace;

pub use crate::replay::figures::{JointResiduals, Residual};

/// Length of a window unless another is asked for \[s\].
pub const HORIZON: f64 = 0.1;

/// A log beside what the simulation makes of it.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the log's file.
    pub log: String,
    /// Samples of the log that are compared.
    pub samples: usize,
    /// Time between them \[s\].
    pub period: f64,
    /// Length of the windows that predictions run over \[s\].
    pub horizon: f64,
    /// How far simulation and log are apart, joint by joint.
    pub joints: Vec<JointResiduals>,
    /// When the closed loop diverged, if it did \[s\].
    pub diverged_at: Option<f64>,
    /// What is doubtful about the log as one of this robot.
    #[serde(skip)]
    pub warnings: Vec<Problem>,
    /// Log, closed loop, prediction and residuals over time: what the CSV file has.
    #[serde(skip)]
    pub trace: Trace,
}

/// Lays `log` over `scenario`; predictions run over windows of `horizon` s. The log begins where the scenario does.
///
/// # Errors
/// If the log is of a robot with another number of joints; if its springs carry the links only with its sides swapped or its positions in
/// degrees; if the horizon is shorter than a sample, or the scenario cannot be run;
/// [`Problems::interrupted`] if it was broken off.
pub fn replay(
    scenario: &Scenario,
    log: &Log,
    horizon: f64,
    progress: Progress<'_>,
) -> Result<Replay, Problems> {
    let joints = scenario.robot.joint_count();
    if log.joints != joints {
        let message = format!("the log has {} joints and {} has {joints}", log.joints, scenario.robot.name);
        return Err(Problem::new("joints", message, "is it a log of this robot?").into());
    }
    if !(horizon.is_finite() && horizon >= log.period) {
        let message =
            format!("the horizon is {horizon} s, must be at least one sample of the log: {} s", log.period);
        return Err(Problem::new("range", message, "0.1 s is what springs need to show").into());
    }
    let warnings = readings::check(&scenario.robot, log)?;
    let closed = closed_loop::closed_loop(scenario, log, progress)?;
    let predicted = prediction::prediction(scenario, log, horizon)?;
    let sheet = figures::Sheet { scenario, log, closed: &closed.signals, predicted: &predicted };
    Ok(Replay {
        scenario: scenario.name.clone(),
        log: log.name.clone(),
        samples: log.samples(),
        period: log.period,
        horizon,
        joints: sheet.residuals(),
        diverged_at: closed.diverged_at,
        warnings,
        trace: sheet.trace(),
    })
}
