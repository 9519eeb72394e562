//! What was identified, with what vouches for it.

use serde::Serialize;

use super::parameters::Parameter;
use crate::files::Problem;
use crate::files::number::significant;

/// What `flexure identify` finds. Errors are three standard deviations.
#[derive(Clone, Debug, Serialize)]
pub struct Identified {
    /// Name of the robot.
    pub robot: String,
    /// Joints in the robot's order.
    pub joints: Vec<IdentifiedJoint>,
    /// How much later than each log says the torques act.
    pub offsets: Vec<Offset>,
    /// Samples that were fitted.
    pub samples: usize,
    /// Samples that were kept from the fit.
    pub held_out: usize,
    /// Whether links have encoders in the logs.
    pub link_encoders: bool,
    /// Whether the search came to its end.
    pub converged: bool,
    /// How much better the best known combination of the parameters is known than the worst, each in units of its own error.
    pub condition: f64,
    /// What is known least, in words.
    pub weakest: String,
}

/// What was identified of a joint.
#[derive(Clone, Debug, Serialize)]
pub struct IdentifiedJoint {
    /// Name.
    pub name: String,
    /// In the order of [`Parameter::ALL`].
    pub parameters: Vec<Estimate>,
    /// What speaks against its numbers, in words: then none counts as known. Null if nothing does.
    pub doubt: Option<String>,
    /// Root mean square of one-step prediction errors of the positions over the noise of the encoders: 1 if nothing but they
    /// disturbs.
    pub noise_ratio: NoiseRatio,
    /// Torque noise that makes the prediction errors likeliest [N m rms].
    pub torque_noise: f64,
    /// Mean of the weighed squares of prediction errors over the part that was kept from the fit, over that of the fitted part; null if
    /// nothing was kept.
    pub held_out: Option<f64>,
}

/// Prediction errors over encoder noise.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NoiseRatio {
    /// Of the link; null without an encoder.
    pub link: Option<f64>,
    /// Of the motor.
    pub motor: f64,
}

/// A number with its error.
#[derive(Clone, Debug, Serialize)]
pub struct Estimate {
    /// Key of the robot file, or `link_friction`, `motor_friction`.
    pub key: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// The value; in the unit.
    pub value: f64,
    /// Three standard deviations.
    pub error: f64,
    /// What the robot file says; null for friction and for what it leaves open.
    pub before: Option<f64>,
    /// Whether the log knows it, the search came to its end, and every log tells when torques act: if not, the number stays as it was.
    pub known: bool,
}

/// A time offset.
#[derive(Clone, Debug, Serialize)]
pub struct Offset {
    /// Name of the log.
    pub log: String,
    /// \[s\].
    pub value: f64,
    /// Three standard deviations \[s\].
    pub error: f64,
}

/// What helps where a log does not know enough.
const EXCITE: &str = "excite the springs more: `flexure excite` designs such a motion (with --motor-only if links have no encoders); a \
                      longer log, a finer encoder; --accuracy says how well a number must be known";

impl Offset {
    /// Largest error (three standard deviations) of the time at which torques act for anything to count as known \[s\]: a log that does
    /// not tell that within a few samples has no motion in it that a spring or a motor would show.
    pub const TIMED: f64 = 0.005;

    /// Whether the log tells when torques act; where it does not, no number of it counts as known.
    pub fn is_known(&self) -> bool {
        self.error <= Self::TIMED
    }
}

impl Identified {
    /// Stiffnesses and motor inertias that the logs do not know: joint, parameter.
    pub fn missing(&self) -> Vec<(&str, &Estimate)> {
        let needed = || Parameter::ALL.into_iter().filter(|parameter| parameter.is_needed());
        (0..self.joints.len())
            .flat_map(|joint| needed().map(move |parameter| (joint, parameter)))
            .map(|(joint, parameter)| (self.joints[joint].name.as_str(), self.estimate(joint, parameter)))
            .filter(|(_, estimate)| !estimate.known)
            .collect()
    }

    /// What is to be said if the search did not come to its end, the time at which torques act is not told, or a stiffness or motor inertia is
    /// not known.
    pub fn objection(&self) -> Option<Problem> {
        if !self.converged {
            let message =
                "the search did not come to its end: no number counts as known, and nothing is written";
            let help = "start from better guesses in the robot file, or log both sides; is there play, or something else that the model \
                        has not?";
            return Some(Problem::new("unknown", message, help));
        }
        if let Some(offset) = self.offsets.iter().find(|offset| !offset.is_known()) {
            let message = format!(
                "{} tells when torques act only to ± {} ms, and {} ms are needed: no number counts as known, and nothing is written",
                offset.log,
                significant(1e3 * offset.error, 2),
                1e3 * Offset::TIMED
            );
            return Some(Problem::new("unknown", message, EXCITE));
        }
        let missing: Vec<_> =
            self.missing().iter().map(|(joint, what)| format!("{} of {joint}", what.key)).collect();
        let nothing = if self.knows_something() { "" } else { ": nothing is written" };
        let message = || format!("the logs do not know {}{nothing}", missing.join(", "));
        (!missing.is_empty()).then(|| Problem::new("unknown", message(), EXCITE))
    }

    /// Whether the logs know any number.
    pub fn knows_something(&self) -> bool {
        self.joints.iter().flat_map(|joint| &joint.parameters).any(|estimate| estimate.known)
    }

    /// The estimate of a parameter of joint `joint`.
    pub fn estimate(&self, joint: usize, parameter: Parameter) -> &Estimate {
        &self.joints[joint].parameters[parameter.place()]
    }
}
