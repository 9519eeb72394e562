//! How much torque a reference takes.

use crate::feasible::search::speed;
use crate::feasible::track::{Demand, with_track};
use crate::files::Problems;
use crate::scenario::Scenario;

/// Root mean square over time of the motor torque that keeps the robot of `scenario` on its reference, by exact inverse
/// dynamics at every control instant; the largest over the joints [N m], as
/// [`Summary::rms_u_m`](crate::simulate::Summary::rms_u_m) is for a run.
///
/// # Errors
/// As [`speed`].
pub fn effort(scenario: &Scenario) -> Result<f64, Problems> {
    let squared = (0_u32, vec![0.0; scenario.robot.joint_count()]);
    let (instants, squared) = fold(scenario, squared, |(instants, sums), demand| {
        *instants += 1;
        for (sum, torque) in sums.iter_mut().zip(&demand.torque) {
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
    fold(scenario, Vec::new(), |peaks: &mut Vec<(f64, f64)>, demand| {
        if peaks.is_empty() {
            let begins = demand.position.iter().zip(start);
            *peaks = begins.map(|(q_ld, start)| (0.0, (q_ld - start).abs())).collect();
        }
        for ((torque, _), u_m) in peaks.iter_mut().zip(&demand.torque) {
            *torque = torque.max(u_m.abs());
        }
    })
}

/// What `each` makes of the demands at every control instant.
fn fold<A: Clone>(scenario: &Scenario, from: A, each: impl Fn(&mut A, &Demand)) -> Result<A, Problems> {
    let speed = speed(scenario)?;
    with_track(scenario, |track| {
        let demands = track.at_speed(speed);
        let (mut sum, mut instants) = (from.clone(), 0);
        loop {
            let t = f64::from(instants) * scenario.control_period;
            if t > scenario.duration {
                return sum;
            }
            each(&mut sum, &demands(t));
            instants += 1;
        }
    })
}
