//! What was identified, with what vouches for it.

use serde::Serialize;

use super::parameters::Parameter;

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

    /// Whether the logs know any number.
    pub fn knows_something(&self) -> bool {
        self.joints.iter().flat_map(|joint| &joint.parameters).any(|estimate| estimate.known)
    }

    /// The estimate of a parameter of joint `joint`.
    pub fn estimate(&self, joint: usize, parameter: Parameter) -> &Estimate {
        &self.joints[joint].parameters[parameter.place()]
    }
}
