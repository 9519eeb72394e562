//! Joints whose numbers no drive can have: nothing of them is taken.
//!
//! Error bars say how well a model is known that fits; where positions are rounded to steps as large as the motion of a spring, a
//! wrong one may fit as well. Two things tell it that the fit does not know of. Dampings and frictions take work, and the log says
//! how much is taken: what the motor gives and the links do not get. And a data sheet is not wrong by a large factor.

use super::parameters::{Parameter, Values};
use super::prior::SHEET;
use super::regression::work;
use crate::files::number::short;
use crate::logs::Log;
use crate::robot::Arm;

/// A stiffness or a motor inertia that is farther from the file's than this, in standard deviations of a [data sheet](SHEET): a factor of 7.
const FAR: f64 = 4.0;

/// Times the work of the log that dampings and frictions may take, and part of what goes in and out that it may be uncertain by.
const TIMES: f64 = 2.0;
const UNCERTAIN: f64 = 0.1;

/// Joint by joint what speaks against `values`, in words; `written` are the numbers of the robot file, of which some are `gaps` (joint,
/// parameter).
pub(crate) fn doubts(
    arm: &dyn Arm,
    logs: &[Log],
    values: &Values,
    written: &Values,
    gaps: &[(usize, Parameter)],
) -> Vec<Option<String>> {
    let works = work::works(arm, logs, values);
    let far = |joint: usize| {
        let needed = Parameter::ALL.into_iter().filter(|parameter| parameter.is_needed());
        needed.filter(|parameter| !gaps.contains(&(joint, *parameter))).find_map(|parameter| {
            let [found, sheet] = [values, written].map(|values| values.joints[joint][parameter.place()]);
            ((found / sheet).ln().abs() > FAR * SHEET).then(|| {
                format!(
                    "its {} would be {}, {} times the robot file's {}: write it there if it may be right, or leave it open",
                    parameter.name().replace('_', " "),
                    short(found, 3),
                    short(found / sheet, 2),
                    short(sheet, 3)
                )
            })
        })
    };
    let overdrawn = |work: &work::Work| {
        (work.said > TIMES * work.measured.max(0.0) + UNCERTAIN * work.passed).then(|| {
            format!(
                "its dampings and frictions would take {} W of the {} W that the log says are taken",
                short(work.said, 3),
                short(work.measured, 3)
            )
        })
    };
    works.iter().enumerate().map(|(joint, work)| overdrawn(work).or_else(|| far(joint))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;

    /// K, M_m, D_l, D_m and frictions of links and motors.
    const EXACT: [f64; 6] = [300.0, 0.02, 0.5, 0.3, 0.0, 0.4];

    /// Two rigid joints that swing, and the torques that this takes with [`EXACT`] numbers.
    fn log(arm: &dyn Arm) -> Log {
        let [_, inertia, d_l, d_m, _, friction] = EXACT;
        let (mut q, mut u) = (Vec::new(), Vec::new());
        for k in 0..4000 {
            let t = 1e-3 * f64::from(k);
            let sines = [3.0_f64, 4.7].map(|w| {
                let (sin, cos) = (w * t).sin_cos();
                [0.4 * sin, 0.4 * w * cos, -0.4 * w * w * sin]
            });
            let [position, v, a] = [0, 1, 2].map(|part| sines.map(|sine| sine[part]));
            let mut torque = [0.0; 2];
            arm.inverse_dynamics(&position, &v, &a, &mut torque).unwrap();
            for i in 0..2 {
                q.push(position[i]);
                u.push(torque[i] + inertia * a[i] + (d_l + d_m) * v[i] + friction * v[i].signum());
            }
        }
        let (q_l, q_m) = (Some(q.clone()), Some(q));
        Log { name: "swings".to_owned(), period: 1e-3, joints: 2, q_l, q_m, dq_l: None, dq_m: None, u_m: u }
    }

    #[test]
    fn work_is_what_dampings_and_frictions_take() {
        let robot = Robot::load("two-link-plausible").unwrap();
        let arm = robot.arm().unwrap();
        let log = log(&*arm);
        let values = |joint: [f64; 6]| Values { joints: vec![joint, EXACT], offsets: vec![0.0] };
        for work in work::works(&*arm, std::slice::from_ref(&log), &values(EXACT)) {
            // Smoothing takes some of what turns back.
            assert!((work.measured / work.said - 1.0).abs() < 0.05, "{work:?}");
        }
        let doubted = |joint: [f64; 6], gaps: &[(usize, Parameter)]| {
            let found = doubts(&*arm, std::slice::from_ref(&log), &values(joint), &values(EXACT), gaps);
            assert_eq!(found[1], None);
            found[0].clone()
        };
        let [k, m, d_l, d_m, f_l, f_m] = EXACT;
        assert_eq!(doubted(EXACT, &[]), None);
        assert_eq!(doubted([3.0 * k, m / 3.0, 1.5 * d_l, d_m, f_l, f_m], &[]), None);
        for much in
            [[k, m, 30.0 * d_l, d_m, f_l, f_m], [k, m, d_l, 30.0 * d_m, f_l, f_m], [k, m, d_l, d_m, 9.0, f_m]]
        {
            assert!(doubted(much, &[]).is_some_and(|words| words.contains("would take")), "{much:?}");
        }
        // Far from the file, unless the file leaves it open.
        let soft = [k / 10.0, m, d_l, d_m, f_l, f_m];
        assert!(
            doubted(soft, &[]).is_some_and(|words| words.contains("stiffness would be 30, 0.1 times")),
            "{:?}",
            doubted(soft, &[])
        );
        assert_eq!(doubted(soft, &[(0, Parameter::Stiffness)]), None);
    }
}
