//! A log that was read.

/// What was measured on a robot: one row per sample, evenly spaced.
///
/// Motors are seen from the link side of the gear. Signals are samples × joints, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// The file's name in messages.
    pub name: String,
    /// Time from one sample to the next > 0 \[s\].
    pub period: f64,
    /// Joints of the robot, at least one.
    pub joints: usize,
    /// Link positions \[rad\]; `None` where they are not measured, as for the three that follow.
    pub q_l: Option<Vec<f64>>,
    /// Motor positions \[rad\].
    pub q_m: Option<Vec<f64>>,
    /// Link velocities [rad/s].
    pub dq_l: Option<Vec<f64>>,
    /// Motor velocities [rad/s].
    pub dq_m: Option<Vec<f64>>,
    /// Motor torque from a sample to the next [N m].
    pub u_m: Vec<f64>,
}

impl Log {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.u_m.len() / self.joints
    }

    /// Time from the first sample to the last \[s\].
    pub fn duration(&self) -> f64 {
        self.time(self.samples().saturating_sub(1))
    }

    /// Time of the sample `k` from the first on \[s\].
    pub fn time(&self, k: usize) -> f64 {
        k as f64 * self.period
    }
}
