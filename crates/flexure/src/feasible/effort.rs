//! How much torque a reference takes.

use crate::feasible::search::speed;
use crate::feasible::track::with_track;
use crate::files::Problems;
use crate::scenario::Scenario;

/// Root mean square over time of the motor torque that keeps the robot of `scenario` on its reference, by exact inverse
/// dynamics at every control instant; the largest over the joints [N m], as
/// [`Summary::rms_u_m`](crate::simulate::Summary::rms_u_m) is for a run.
///
/// # Errors
/// As [`speed`].
pub fn effort(scenario: &Scenario) -> Result<f64, Problems> {
    let mut squared = vec![0.0; scenario.robot.joint_count()];
    let instants = along(scenario, &mut |_, torques| {
        for (sum, torque) in squared.iter_mut().zip(torques) {
            *sum += torque * torque;
        }
    })?;
    Ok((squared.into_iter().fold(0.0, f64::max) / f64::from(instants)).sqrt())
}

/// Largest motor torque that the reference of `scenario` takes at the control instants [N m], and how far from where the links
/// start it begins, in rad, a joint each.
///
/// # Errors
/// As [`speed`].
pub fn peak_torque(scenario: &Scenario) -> Result<Vec<(f64, f64)>, Problems> {
    let start = &scenario.initial.q_l;
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    along(scenario, &mut |positions, torques| {
        if peaks.is_empty() {
            peaks = positions.iter().zip(start).map(|(q_ld, start)| (0.0, (q_ld - start).abs())).collect();
        }
        for ((peak, _), torque) in peaks.iter_mut().zip(torques) {
            *peak = peak.max(torque.abs());
        }
    })?;
    Ok(peaks)
}

/// Shows `each` the positions of the links in rad and the motor torques [N m] at every control instant; how many there are.
fn along(scenario: &Scenario, each: &mut dyn FnMut(&[f64], &[f64])) -> Result<u32, Problems> {
    let (speed, instants) = (speed(scenario)?, scenario.periods() + 1);
    with_track(scenario, |track| track.torques(speed, scenario.control_period, instants, each))?;
    Ok(instants)
}
