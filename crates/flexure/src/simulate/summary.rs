//! What a closed-loop run is judged by.

use serde::Serialize;

use crate::files::number::{engineering, small};
use crate::laws::VCBC;
use crate::robot::JointKind;
use crate::simulate::following::Following;
use crate::units::{self, Unit, of_joints};

/// The figures of one closed-loop run: the contract of `run --json` and `reproduce --json`.
///
/// ```
/// let mut scenario = flexure::Scenario::load("pendulum-tanh")?;
/// scenario.duration = 0.5; // s
/// let summary = scenario.simulate()?.summary;
/// assert!(summary.rms_e_l <= summary.max_abs_e_l); // rad
/// assert!(summary.energy_drift < 1e-9); // the integrator neither makes nor loses energy
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Scenario name.
    pub name: String,
    /// Controller kind, as in the scenario file; `own` for a law of the caller's.
    pub controller: String,
    /// Shaping function, as in the scenario file; none for laws without one.
    pub phi: Option<String>,
    /// What the plant has that the law does not know, as keys of `[plant]` in the scenario file.
    pub plant: Vec<&'static str>,
    /// What stands between the ideal loop and this one, as kinds of `[[imperfection]]` in the scenario file.
    pub imperfections: Vec<&'static str>,
    /// Whether the run follows its reference, why not, and what it was held to.
    #[serde(flatten)]
    pub following: Following,
    /// Largest |q_l − q_ld| over all joints and the whole run, in rad. Like the next two NaN (null in JSON) for a run
    /// that diverged.
    pub max_abs_e_l: f64,
    /// Root mean square over time of |q_l − q_ld|, the largest over the joints, in rad.
    pub rms_e_l: f64,
    /// Largest |q_l − q_ld| over the joints at the end, in rad.
    pub final_abs_e_l: f64,
    /// Time after which every |q_l − q_ld| stays below 1 mrad, in s; none if it does not settle.
    pub settling_time: Option<f64>,
    /// Largest |u_m| [N m].
    pub max_abs_u_m: f64,
    /// Root mean square of u_m over time, the largest over the joints [N m].
    pub rms_u_m: f64,
    /// Root mean square of the change of u_m from one control instant to the next, the largest over the joints [N m]: what
    /// noise makes of the command.
    pub rms_torque_change: f64,
    /// Fraction of control periods in which a torque limit was active.
    pub saturated_fraction: f64,
    /// Fraction of control periods in which no certificate of the law could hold: the motors did not give what the law asked, or
    /// the guard limited or stopped the robot.
    pub suspended_fraction: f64,
    /// Times that the guard stopped the robot.
    pub stops: u32,
    /// Smallest contraction rate of the law in continuous time at the states that the run went through [1/s]: evaluated, neither
    /// measured from a decay nor proved. NaN (null in JSON) for laws that have none.
    pub rate_pointwise: f64,
    /// Proved contraction rate [1/s]; none until it is certified, and for a loop that the certificate is not about.
    pub rate_certified: Option<f64>,
    /// |H(T) − H(0) − supplied + dissipated| relative to the energy that went through the robot.
    pub energy_drift: f64,
    /// Integration steps taken.
    pub steps: u64,
    /// Wall-clock time of the simulation in s.
    pub wall_seconds: f64,
    /// How the joints move, which says in what the numbers above are.
    #[serde(skip)]
    pub kinds: Vec<JointKind>,
}

impl Summary {
    /// The law in short: v-CBC by its shaping function, any other by its kind, with its shaping function if it has one.
    pub fn law(&self) -> String {
        match &self.phi {
            Some(phi) if self.controller == VCBC => phi.clone(),
            Some(phi) => format!("{} {phi}", self.controller),
            None => self.controller.clone(),
        }
    }

    /// How far the links are off, whether and when they settle, and what that takes of the motors.
    pub fn in_words(&self) -> String {
        let unit = |unit: Unit, prefix: &str| of_joints(unit, prefix, &self.kinds);
        let (milli, torque) = (unit(units::ANGLE, "m"), unit(units::TORQUE, ""));
        let settled = match self.settling_time {
            Some(0.0) => format!("always within 1 {milli}"),
            Some(time) => format!("within 1 {milli} after {} s", engineering(time)),
            None => format!("not within 1 {milli} at the end"),
        };
        let off = if self.max_abs_e_l.is_finite() {
            let (error, prefix) = small(self.max_abs_e_l);
            format!("links are at most {error} {} off their reference, {settled}", unit(units::ANGLE, prefix))
        } else {
            "links leave their reference".to_owned()
        };
        let stops = match self.stops {
            0 => String::new(),
            1 => "; the guard stopped the robot once".to_owned(),
            stops => format!("; the guard stopped the robot {stops} times"),
        };
        format!(
            "{off}; largest motor torque {} {torque}, root mean square {} {torque}{stops}",
            engineering(self.max_abs_u_m),
            engineering(self.rms_u_m)
        )
    }
}
