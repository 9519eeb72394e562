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
    let speed = speed(scenario)?;
    let joints = scenario.robot.joint_count();
    with_track(scenario, |track| {
        let demands = track.at_speed(speed);
        let mut squared = vec![0.0; joints];
        let mut instants = 0;
        loop {
            let t = f64::from(instants) * scenario.control_period;
            if t > scenario.duration {
                break;
            }
            for (sum, torque) in squared.iter_mut().zip(&demands(t).torque) {
                *sum += torque * torque;
            }
            instants += 1;
        }
        (squared.into_iter().fold(0.0, f64::max) / f64::from(instants)).sqrt()
    })
}
