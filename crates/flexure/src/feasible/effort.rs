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

/// Largest motor torque that the reference of `scenario` takes [N m], and how far it goes from where the links start, in rad,
/// a joint each: at the control instants.
///
/// # Errors
/// As [`speed`].
pub fn peak_torque(scenario: &Scenario) -> Result<Vec<(f64, f64)>, Problems> {
    let start = &scenario.initial.q_l;
    fold(scenario, vec![(0.0_f64, 0.0_f64); start.len()], |peaks, demand| {
        let joints = demand.torque.iter().zip(&demand.position).zip(start);
        for ((torque, size), ((u_m, q_ld), start)) in peaks.iter_mut().zip(joints) {
            *torque = torque.max(u_m.abs());
            *size = size.max((q_ld - start).abs());
        }
    })
}

/// What `each` makes of the demands at every control instant.
fn fold<A: Clone>(
    scenario: &Scenario,
    from: A,
    each: impl Fn(&mut A, &Demand),
) -> Result<A, Problems> {
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
