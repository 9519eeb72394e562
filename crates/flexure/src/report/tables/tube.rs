//! A tube of the sampled loop in lines.

use super::proof::{at_most, list};
use crate::files::number::{rounded_down, rounded_up, significant};
use crate::prove::sampled_data::SampledTube;
use crate::robot::JointKind;
use crate::units::{self, of_joints};

/// What holds of motions in a tube of a robot whose joints are of these kinds.
pub fn tube_lines(found: &SampledTube, kinds: &[JointKind]) -> Vec<String> {
    let [rad, torque] = [units::ANGLE, units::TORQUE].map(|unit| of_joints(unit, "", kinds));
    let (links, motors) = found.error.split_at(found.error.len() / 2);
    let alone = &found.alone[..links.len()];
    let late = if found.delay > 0.0 { format!(" and {} s late", found.delay) } else { String::new() };
    let held = format!("its torque held for {} s{late}", found.period);
    let velocities = if found.filtered { "filtered velocities" } else { "true velocities" };
    let (seen, run, of_readings) = match found.readings[..] {
        [] if found.filtered => (format!("on true positions and {velocities}"), "the run", ""),
        [] => ("on true states".to_owned(), "the run", ""),
        [..] => (
            format!("on positions up to {} {rad} off and {velocities}", at_most(&found.readings)),
            "the run on exact readings",
            ", of the same errors of readings,",
        ),
    };
    let s = if found.periods == 1 { "" } else { "s" };
    vec![
        format!("sampled      the loop with {held}, {seen}: {} control period{s}, one by one", found.periods),
        format!(
            "sampled      motions that start in a tube around {run} stay in it, |q_l − run| ≤ {} {rad}, |q_m − run| ≤ {} {rad} at every control instant",
            at_most(links),
            at_most(motors)
        ),
        format!(
            "sampled      and any two of them{of_readings} come closer, in its norms, at {} 1/s or faster in every period; with the numbers of the files, without tolerances",
            significant(rounded_down(found.rate, 4), 4)
        ),
        format!(
            "sampled      a link that starts off alone is in it up to {} {rad}",
            list(&alone.iter().map(|&e| rounded_down(e, 3)).collect::<Vec<_>>())
        ),
        format!(
            "sampled      at the control instants of its last quarter the run's links are within {} {rad} of the reference; |u_m| ≤ {} {torque} in the tube",
            at_most(&found.tracking),
            at_most(&found.torque)
        ),
        format!(
            "sampled      a guard with region = [{}] {rad} tells when links are, as read, farther from the reference than this tube",
            found.region().iter().map(|&x| format!("{:e}", rounded_up(x, 3))).collect::<Vec<_>>().join(", ")
        ),
    ]
}
