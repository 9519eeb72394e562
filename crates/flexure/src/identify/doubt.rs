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
