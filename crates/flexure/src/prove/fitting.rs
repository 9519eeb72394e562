//! Questions that do not fit the robot are refused before anything is computed.

use crate::files::Problem;
use crate::prove::question::{Question, Region, SMALLEST_ERROR};
use crate::scenario::Scenario;

/// Largest and smallest number that a question takes: products of a few of them stay finite.
const LARGEST: f64 = 1e30;

/// Smallest tube of a sampled loop in rad: rounding of the run is a hundredth of it.
const SMALLEST_TUBE: f64 = 1e-9;

const OF_BOTH_SIDES: &str = "one number, or one per joint of the links, then of the motors, in rad";

/// How far links reach in a tube of the sampled loop in rad, a number for each of `n`.
///
/// # Errors
/// If there is another number of them, or one is out of range.
pub(crate) fn tube_extents(extents: Vec<f64>, n: usize) -> Result<Vec<f64>, Problem> {
    let hint = "how far links reach in the tube: one number, or one per link, in rad; begin with 1e-5";
    let extents = per_joint("the sampled tube", extents, n, hint)?;
    match extents.iter().find(|&&e| e < SMALLEST_TUBE) {
        Some(none) => {
            let message = format!("the sampled tube is {none} rad, must be at least {SMALLEST_TUBE:e}");
            Err(Problem::new("range", message, hint))
        }
        None => Ok(extents),
    }
}

impl Question {
    /// The same with a number for each joint where one number stands for all.
    ///
    /// # Errors
    /// If lists have another length, or numbers are out of range.
    pub fn fitting(self, scenario: &Scenario) -> Result<Self, Problem> {
        let n = scenario.robot.joint_count();
        let region = match self.region {
            Region::Errors(largest) => Region::Errors(positive(
                "the error box",
                per_joint("the error box", largest, 2 * n, OF_BOTH_SIDES)?,
            )?),
            Region::Start(start) => {
                let start = per_joint("the initial error", start, 2 * n, OF_BOTH_SIDES)?;
                let largest = start.iter().fold(0.0, |largest: f64, e| largest.max(e.abs()));
                positive("the initial error", vec![largest])?;
                Region::Start(start.into_iter().map(f64::abs).collect())
            }
            Region::Chosen => Region::Chosen,
        };
        let torques = |name: &str, torques: Option<Vec<f64>>, hint: &str| {
            let torques = torques.map(|torques| per_joint(name, torques, n, hint)).transpose()?;
            if let Some(negative) = torques.iter().flatten().find(|&&d| d < 0.0) {
                let message = format!("{name} is {negative} N m, must be >= 0");
                return Err(Problem::new("range", message, "the largest absolute value of the torque"));
            }
            Ok(torques)
        };
        let hint = "one number, or one per motor, in N m, link side of the gear";
        let disturbance = torques("the disturbance", self.disturbance, hint)?;
        let hint = "one number, or one per link, in N m";
        let link_disturbance = torques("the disturbance of the links", self.link_disturbance, hint)?;
        let some = disturbance.iter().chain(&link_disturbance).flatten().any(|&d| d > 0.0);
        if self.up_to_limits && !some {
            let message = "the largest torques up to limits are asked for, and not which torques".to_owned();
            let hint = "name some, on links or motors: those are multiplied until a limit may act";
            return Err(Problem::new("range", message, hint));
        }
        if self.slabs == Some(0) {
            let message = "a funnel may have 0 slabs of time, must be >= 1".to_owned();
            return Err(Problem::new("range", message, "leave it out for as many as are usual"));
        }
        let hint = "one number, or one per joint of the links, then of the motors, in rad/s";
        let velocity_error = self
            .velocity_error
            .map(|speeds| per_joint("the velocity error", speeds, 2 * n, hint))
            .transpose()?;
        if let Some(negative) = velocity_error.iter().flatten().find(|&&s| s < 0.0) {
            let message = format!("the velocity error is {negative} rad/s, must be >= 0");
            return Err(Problem::new("range", message, "the largest absolute value of the velocity error"));
        }
        let sampled_tube = self.sampled_tube.map(|extents| tube_extents(extents, n)).transpose()?;
        if let Some(rate) = self.rate.filter(|rate| !(rate.is_finite() && *rate > 0.0 && *rate <= LARGEST)) {
            let message = format!("the rate is {rate:e} 1/s, must be > 0 and at most 1e30");
            let hint = "decay rate of the distance of two solutions; leave it out for the largest";
            return Err(Problem::new("range", message, hint));
        }
        Ok(Self { region, disturbance, link_disturbance, velocity_error, sampled_tube, ..self })
    }
}

fn per_joint(name: &str, values: Vec<f64>, count: usize, what: &str) -> Result<Vec<f64>, Problem> {
    if let Some(x) = values.iter().find(|x| !x.is_finite() || x.abs() > LARGEST) {
        return Err(Problem::new(
            "range",
            format!("{name} is {x:e}, must be of a magnitude up to 1e30"),
            what,
        ));
    }
    match *values {
        [one] => Ok(vec![one; count]),
        _ if values.len() == count => Ok(values),
        _ => {
            let message = format!("{name}: 1 or {count} numbers expected; got {}", values.len());
            Err(Problem::new("length", message, what))
        }
    }
}

fn positive(name: &str, values: Vec<f64>) -> Result<Vec<f64>, Problem> {
    match values.iter().find(|&&x| x < SMALLEST_ERROR) {
        None => Ok(values),
        Some(x) if *x > 0.0 => {
            let message = format!("{name} is {x:e} rad, must be at least {SMALLEST_ERROR:e}");
            let hint = "so small a region cannot be represented: tanh is linear in it to rounding";
            Err(Problem::new("region", message, hint))
        }
        Some(x) => {
            let message = format!("{name} is {x} rad: the region is empty");
            Err(Problem::new("region", message, "name the largest error that shall be certified, > 0"))
        }
    }
}
