//! What a run is held to: the scenario's `[accept]`, and defaults from the limits of the robot and the size of the reference.

use serde::Serialize;

use crate::feasible::peak_torque;
use crate::files::Problems;
use crate::robot::JointKind;
use crate::scenario::Scenario;
use crate::simulate::figures::SETTLED;
use crate::units::{self, Unit};

/// Part of the reference's size that is accepted as an error.
const PART: f64 = 0.1;

/// Largest error that is accepted by default \[rad\].
const LOST: f64 = 0.1;

/// Times the torque that the reference takes, or that bends the springs by the distance to the reference at the start, which is
/// accepted of joints without a torque limit.
const TIMES: f64 = 10.0;

/// Least torque in that rule, as what bends the spring so far \[rad\].
const LEAST: f64 = 0.1;

/// Part of the accepted torque that is accepted as its change from one control instant to the next.
const CHANGE: f64 = 0.1;

/// Part of the control instants from settling on at which the drive may be at its limit.
const AT_LIMIT: f64 = 0.1;

/// What is looked at, each with a limit of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// |q_l − q_ld|.
    Error,
    /// |u_m|.
    Torque,
    /// |q̇_l|.
    Speed,
    /// |q_m − q_l|.
    Deflection,
    /// Root mean square change of u_m from one control instant to the next.
    TorqueChange,
    /// Part of the control instants at which the drive is at its torque limit.
    AtLimit,
}

impl Measure {
    /// All of them, in the order that reports have.
    pub const ALL: [Self; 6] =
        [Self::Error, Self::Torque, Self::Speed, Self::Deflection, Self::TorqueChange, Self::AtLimit];

    /// What it is, in words.
    pub fn what(self) -> &'static str {
        match self {
            Self::Error => "position error",
            Self::Torque => "motor torque",
            Self::Speed => "link velocity",
            Self::Deflection => "deflection of the spring",
            Self::TorqueChange => "change of the torque a control period, root mean square,",
            Self::AtLimit => "part of the time at the torque limit",
        }
    }

    /// Its key in `[accept]`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Torque => "torque",
            Self::Speed => "speed",
            Self::Deflection => "deflection",
            Self::TorqueChange => "torque_change",
            Self::AtLimit => "at_limit",
        }
    }

    /// Its unit at a joint of the kind `kind`.
    pub fn unit(self, kind: JointKind) -> &'static str {
        self.measured_in().of(kind).plain
    }

    /// How it is measured.
    pub(crate) fn measured_in(self) -> Unit {
        match self {
            Self::Error | Self::Deflection => units::ANGLE,
            Self::Torque | Self::TorqueChange => units::TORQUE,
            Self::Speed => units::SPEED,
            Self::AtLimit => units::NONE,
        }
    }

    /// Whether it counts from [`settling`](Criteria::settling) on only.
    pub fn is_settled(self) -> bool {
        matches!(self, Self::Error | Self::TorqueChange | Self::AtLimit)
    }
}

/// A limit for each joint, and where it is from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bound {
    /// What is limited.
    pub measure: Measure,
    /// Largest value that is accepted, a joint each; infinite (null in JSON) where nothing limits it.
    pub limit: Vec<f64>,
    /// Where the limit is from.
    pub because: &'static str,
}

/// What a run is held to.
///
/// ```
/// use flexure::simulate::{Criteria, Measure};
/// let criteria = Criteria::of(&flexure::Scenario::load("pendulum-tanh")?)?;
/// assert_eq!(criteria.settling, 5.0); // s: half of the run
/// // A reference of half a radian: a twentieth of a radian off is lost.
/// assert_eq!(criteria.bounds(&[0.5])[0].limit, [0.05]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Criteria {
    /// Time from which errors, torque changes and time at the limit count \[s\].
    pub settling: f64,
    /// Where that is from.
    pub settling_because: &'static str,
    error: Option<Vec<f64>>,
    others: Vec<Bound>,
    joints: Vec<JointKind>,
}

/// Of numbers that the scenario gives.
const GIVEN: &str = "as [accept] says";

impl Criteria {
    /// Of a scenario.
    ///
    /// # Errors
    /// As [`effort`](crate::feasible::effort): what a joint without a torque limit may take follows from the reference.
    pub fn of(scenario: &Scenario) -> Result<Self, Problems> {
        let (accept, limits) = (&scenario.accept, &scenario.robot.limits);
        let bound = |measure, given: &Option<Vec<f64>>, default: &dyn Fn() -> (Vec<f64>, &'static str)| {
            let (limit, because) = given.clone().map_or_else(default, |given| (given, GIVEN));
            Bound { measure, limit, because }
        };
        let torque = default_torque(scenario)?;
        let torque = bound(Measure::Torque, &accept.torque, &|| torque.clone());
        let of_robot = |limit: &Vec<f64>| (limit.clone(), "the robot's limit");
        let change = || (torque.limit.iter().map(|limit| CHANGE * limit).collect(), "a tenth of that torque");
        let change = bound(Measure::TorqueChange, &accept.torque_change, &change);
        let share = (vec![accept.at_limit.unwrap_or(AT_LIMIT); limits.torque.len()], "a tenth of the time");
        let because = if accept.at_limit.is_some() { GIVEN } else { share.1 };
        let others = vec![
            torque,
            bound(Measure::Speed, &accept.speed, &|| of_robot(&limits.velocity)),
            bound(Measure::Deflection, &accept.deflection, &|| of_robot(&limits.deflection)),
            change,
            Bound { measure: Measure::AtLimit, limit: share.0, because },
        ];
        Ok(Self {
            settling: accept.settling.unwrap_or(0.5 * scenario.duration),
            settling_because: if accept.settling.is_some() { GIVEN } else { "half of the run" },
            error: accept.error.clone(),
            others,
            joints: scenario.robot.kinds(),
        })
    }

    /// All limits, in the order of [`Measure::ALL`], for a reference that goes as far as `size` from where the links start, a
    /// joint each \[rad\].
    pub fn bounds(&self, size: &[f64]) -> Vec<Bound> {
        let error = match &self.error {
            Some(limit) => Bound { measure: Measure::Error, limit: limit.clone(), because: GIVEN },
            None => Bound {
                measure: Measure::Error,
                limit: self.joints.iter().map(|kind| self.default_error(*kind, size)).collect(),
                because: "a tenth of the reference's size, at least 1 mrad and at most 0.1 rad",
            },
        };
        std::iter::once(error).chain(self.others.iter().cloned()).collect()
    }

    /// Of joints that turn, and of those that slide: the largest size among their like counts.
    fn default_error(&self, kind: JointKind, size: &[f64]) -> f64 {
        let alike = self.joints.iter().zip(size).filter(|(other, _)| **other == kind);
        let largest = alike.map(|(_, size)| *size).fold(0.0, f64::max);
        (PART * largest).clamp(SETTLED, LOST)
    }
}

/// The robot's limits; of joints without one, [`TIMES`] what the reference takes or what bends the spring by the distance to it at
/// the start, whichever is more.
fn default_torque(scenario: &Scenario) -> Result<(Vec<f64>, &'static str), Problems> {
    let limits = &scenario.robot.limits.torque;
    if scenario.accept.torque.is_some() || limits.iter().all(|limit| limit.is_finite()) {
        return Ok((limits.clone(), "the robot's limit"));
    }
    let stiffness = &scenario.robot.stiffness;
    let needed = peak_torque(scenario)?;
    let most = |i: usize| {
        let (torque, distance) = needed[i];
        let unlimited = (TIMES * torque.max(stiffness[i] * distance)).max(stiffness[i] * LEAST);
        if limits[i].is_finite() { limits[i] } else { unlimited }
    };
    let because = "where the robot has no limit, ten times what the reference takes or what bends the spring by the \
                   distance to it at the start, at least what bends it by 0.1 rad";
    Ok(((0..limits.len()).map(most).collect(), because))
}
