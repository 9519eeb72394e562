//! What is kept of a run.

use crate::files::Problems;
use crate::prove::question::certified_rate;
use crate::robot::JointKind;
use crate::sampled::Outlook;
use crate::scenario::Scenario;
use crate::simulate::{Run, Summary};
use crate::units::{self, of_joints};

/// A number that is kept of each run; none (null) where there is none.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Its name: a column of the rows.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Whether it is kept where nothing is said.
    pub usual: bool,
    of: fn(&Scenario, &Run) -> Result<Option<f64>, Problems>,
}

impl Metric {
    const fn new(
        name: &'static str,
        unit: &'static str,
        what: &'static str,
        of: fn(&Scenario, &Run) -> Result<Option<f64>, Problems>,
    ) -> Self {
        Self { name, unit, what, usual: true, of }
    }

    /// Its unit for a robot with joints of these kinds; none of plain numbers.
    pub(crate) fn unit_of(&self, kinds: &[JointKind]) -> Option<String> {
        let of_joints = |unit| of_joints(unit, "", kinds);
        match self.unit {
            "1" => None,
            unit if unit == units::ANGLE.plain => Some(of_joints(units::ANGLE)),
            unit if unit == units::TORQUE.plain => Some(of_joints(units::TORQUE)),
            unit => Some(unit.to_owned()),
        }
    }

    const fn on_demand(self) -> Self {
        Self { usual: false, ..self }
    }

    /// Its value for a run of `scenario`; none if there is none, or if it is no finite number.
    pub(super) fn value(&self, scenario: &Scenario, run: &Run) -> Result<Option<f64>, Problems> {
        Ok((self.of)(scenario, run)?.filter(|value| value.is_finite()))
    }
}

macro_rules! of {
    ($summary:ident => $value:expr) => {
        |_, run| {
            let $summary: &Summary = &run.summary;
            Ok(Some($value))
        }
    };
}

/// Every metric.
pub const METRICS: [Metric; 15] = [
    Metric::new("rms_e_l", "rad", "root mean square of the links' errors over time, the largest over the joints", of!(s => s.rms_e_l)),
    Metric::new("max_abs_e_l", "rad", "largest error of a link", of!(s => s.max_abs_e_l)),
    Metric::new("final_abs_e_l", "rad", "largest error of a link at the end", of!(s => s.final_abs_e_l)),
    Metric::new("settling_time", "s", "time after which every error of a link stays below 1 mrad; none if it does not settle", |_, run| {
        Ok(run.summary.settling_time)
    }),
    Metric::new("max_abs_u_m", "N m", "largest motor torque", of!(s => s.max_abs_u_m)),
    Metric::new("rms_u_m", "N m", "root mean square of the motor torque over time, the largest over the joints", of!(s => s.rms_u_m)),
    Metric::new("rms_torque_change", "N m", "root mean square of the change of the torque from one control instant to the next", of!(s => s.rms_torque_change)),
    Metric::new("saturated_fraction", "1", "part of the control periods in which a torque limit was active", of!(s => s.saturated_fraction)),
    Metric::new("stops", "1", "times that the guard stopped the robot", of!(s => f64::from(s.stops))),
    Metric::new("diverged_at", "s", "when the loop diverged; none if it did not", |_, run| {
        Ok(run.divergence.map(|divergence| divergence.time))
    }),
    Metric::new("suspended_fraction", "1", "part of the control periods in which no certificate of the law could hold", of!(s => s.suspended_fraction)).on_demand(),
    Metric::new("energy_drift", "1", "error of the energy balance of the simulation, relative to the energy that went through", of!(s => s.energy_drift)).on_demand(),
    Metric::new("steps", "1", "integration steps", of!(s => s.steps as f64)).on_demand(),
    Metric::new("sampled_rate", "1/s", "rate at which small errors shrink in the loop as it is sampled, by its exact linearisation; negative where they grow", |scenario, _| {
        let growth = Outlook::new(scenario)?.growth(&scenario.controller);
        Ok(growth.map(|growth| -growth.ln() / scenario.control_period))
    })
    .on_demand(),
    Metric::new("certified_rate", "1/s", "contraction rate (`contraction_rate` of `certify`) that is proved of the ideal loop, in continuous time, of robot and gains; none if none is", |scenario, _| {
        certified_rate(scenario)
    })
    .on_demand(),
];
