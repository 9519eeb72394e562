//! What to change in a sampled loop that is not stable.

use serde::Serialize;

use crate::files::Problems;
use crate::imperfections::{Imperfection, Sampling};
use crate::laws::drives;
use crate::linalg::{Dense, Mode, dominant_mode};
use crate::sampled::exchange::fastest;
use crate::sampled::{Probe, Spot};
use crate::scenario::Scenario;

/// What makes the loop stable that is not, one at a time: each was tried on the same linearisation, at every place.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    /// The joint that moves most.
    #[serde(skip)]
    pub joint_name: String,
    /// Key of a gain that makes the loop stable alone, the first of those that the modulus of the mode depends on most; else the one
    /// that it depends on most.
    #[serde(skip)]
    pub key: String,
    /// Which way to move it.
    #[serde(rename = "move")]
    pub direction: Move,
    /// By which factor, for all joints: with that the loop is stable; none if no factor up to 2¹² makes it so.
    pub factor: Option<f64>,
    /// What it is now in each joint, if the file leaves it to the starting rule: to be written down times the factor.
    pub now: Option<Vec<f64>>,
    /// Spectral radius of the same law with its starting gains; below 1 these are a way out.
    pub starting_gains: f64,
    /// A control period in s with which the loop is stable as it is, the given one halved as often as needed; none if a 64th of it is not
    /// short enough.
    pub period: Option<f64>,
    /// What goes too fast, for laws whose loop has closed forms.
    pub exchange: Option<String>,
}

/// Up or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Move {
    /// To a larger gain.
    Raise,
    /// To a smaller gain.
    Lower,
}

/// Relative change of a gain by which its effect is measured.
const CHANGE: f64 = 1e-4;

/// Doublings of a gain that are tried, and halvings of the control period.
const DOUBLINGS: i32 = 12;
const HALVINGS: i32 = 6;

/// Gains that are tried.
const TRIED: usize = 3;

/// What goes through more of a radian than this in a control period is fast for it.
const FAST: f64 = 0.3;

/// What to change in the loop that is not stable at spot `worst`; none if it has no mode.
pub(super) fn advice(probe: &Probe<'_>, worst: usize) -> Result<Option<Advice>, Problems> {
    let (scenario, spot) = (probe.scenario, &probe.spots[worst]);
    let law = &scenario.controller;
    let map = probe.cycle(spot, law, &spot.around);
    let Some(mode) = dominant_mode(&map) else { return Ok(None) };
    let joint = moving(&mode, scenario.robot.joint_count());
    let moves = moves(probe, spot, &mode, &map);
    let alone = moves
        .iter()
        .take(TRIED)
        .find_map(|&(gain, direction)| Some((gain, direction, factor(probe, spot, gain, direction)?)));
    let (gain, direction, factor) = match (alone, moves.first()) {
        (Some((gain, direction, factor)), _) => (gain, direction, Some(factor)),
        (None, Some(&(gain, direction))) => (gain, direction, None),
        (None, None) => return Ok(None),
    };
    let start = law.restart(&scenario.robot)?;
    let drive = drives(&scenario.robot)?.swap_remove(joint);
    Ok(Some(Advice {
        joint_name: scenario.robot.joints[joint].name.clone(),
        key: format!("controller.{}", law.gains()[gain].0),
        direction,
        factor,
        now: left_out(scenario, gain),
        starting_gains: probe.worst(&start).0,
        period: period(scenario)?,
        exchange: fastest(law, joint, &drive)
            .filter(|exchange| exchange.speed * scenario.control_period > FAST)
            .map(|exchange| exchange.to_string()),
    }))
}

/// A gain that the file leaves to the starting rule.
fn left_out(scenario: &Scenario, gain: usize) -> Option<Vec<f64>> {
    let (key, values) = &scenario.controller.gains()[gain];
    (!scenario.places.has(&format!("controller.{key}"))).then(|| values.to_vec())
}

/// The joint with the largest part in a mode.
fn moving(mode: &Mode, n: usize) -> usize {
    let part = |i: usize| (mode.left[i] * mode.right[i]).abs();
    let of_joint = |joint: usize| (0..4).map(|k| part(k * n + joint)).sum::<f64>();
    (0..n).max_by(|&i, &j| of_joint(i).total_cmp(&of_joint(j))).unwrap_or(0)
}

/// The gains, each of all joints together, and which way to move them, those first whose relative change moves the mode most.
fn moves(probe: &Probe<'_>, spot: &Spot, mode: &Mode, map: &Dense<f64>) -> Vec<(usize, Move)> {
    let law = &probe.scenario.controller;
    let growth = |gain: usize| {
        let changed = probe.cycle(spot, &law.with_gain(gain, 1.0 + CHANGE), &spot.around);
        mode.growth(&(&changed + &map.scaled(-1.0))) / CHANGE
    };
    let mut growths: Vec<_> = (0..law.gains().len()).map(|gain| (gain, growth(gain))).collect();
    growths.sort_by(|(_, x), (_, y)| y.abs().total_cmp(&x.abs()));
    let direction = |growth: f64| if growth > 0.0 { Move::Lower } else { Move::Raise };
    growths.into_iter().map(|(gain, growth)| (gain, direction(growth))).collect()
}

/// The least power of two of a gain, moved in `direction`, that makes the loop stable everywhere.
fn factor(probe: &Probe<'_>, spot: &Spot, gain: usize, direction: Move) -> Option<f64> {
    let law = &probe.scenario.controller;
    let sign = if direction == Move::Raise { 1 } else { -1 };
    (1..=DOUBLINGS).map(|k| 2.0_f64.powi(sign * k)).find(|&factor| {
        let law = law.with_gain(gain, factor);
        probe.radius(spot, &law) < 1.0 && probe.worst(&law).0 < 1.0
    })
}

/// The longest control period, halved again and again, with which the loop is stable as it is: with filters and delays as they are
/// then.
fn period(scenario: &Scenario) -> Result<Option<f64>, Problems> {
    let mut shorter = scenario.clone();
    for _ in 0..HALVINGS {
        shorter.control_period *= 0.5;
        // Sensors stay as slow as they are.
        for sampling in shorter.imperfections.iter_mut().filter_map(Imperfection::of_mut::<Sampling>) {
            sampling.periods = sampling.periods.saturating_mul(2);
        }
        let Some(probe) = Probe::new(&shorter)? else { return Ok(None) };
        if probe.worst(&scenario.controller).0 < 1.0 {
            return Ok(Some(shorter.control_period));
        }
    }
    Ok(None)
}
