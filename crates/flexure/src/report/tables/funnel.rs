//! A funnel in lines.

use super::proof::{at_most, bounded, list, of_limits};
use crate::files::number::{engineering, rounded_down, short};
use crate::prove::robust::{Binding, Robust};
use crate::robot::JointKind;
use crate::units::{self, of_joints};

/// What holds in a funnel of a robot whose joints are of these kinds.
pub fn funnel_lines(found: &Robust, kinds: &[JointKind]) -> Vec<String> {
    let [rad, speed, torque] =
        [units::ANGLE, units::SPEED, units::TORQUE].map(|unit| of_joints(unit, "", kinds));
    let torque_rate = of_joints(units::TORQUE_RATE, "", kinds);
    let (links, motors) = found.error.split_at(found.error.len() / 2);
    let mut lines = vec![
        format!("funnel       in the ideal loop, all along the run from its start, {}:", under(found.times)),
        format!("funnel       |q̃_l| ≤ {} {rad}, |q̃_m| ≤ {} {rad}", at_most(links), at_most(motors)),
        format!(
            "funnel       errors beyond, up to {} times as large, come back: V − 1 falls at {} 1/s or faster, V = zᵀ X⁻¹ z",
            short(found.room, 3),
            engineering(rounded_down(found.rate, 3))
        ),
        format!(
            "funnel       |q̇_l| {}, |q_m − q_l| {}",
            bounded(&found.velocity.bound, &speed),
            bounded(&found.deflection.bound, &rad)
        ),
        format!(
            "funnel       |u_m| {}, {} {torque} on the reference with the numbers of the file",
            bounded(&found.torque.bound, &torque),
            list(&found.torque.nominal)
        ),
        format!(
            "funnel       |du_m/dt| {}, {} {torque_rate} on the reference",
            bounded(&found.torque_rate.bound, &torque_rate),
            list(&found.torque_rate.nominal)
        ),
    ];
    lines.extend(of_limits(&found.limits, kinds));
    lines.extend(found.binding.as_ref().map(binding));
    if found.binding.is_none() && found.times > 1.0 {
        lines.push("funnel       larger torques were not tried: no limit was in the way".to_owned());
    }
    lines
}

/// What a funnel that is read from a file is about, of a robot whose joints are of these kinds.
pub fn funnel_asked(found: &Robust, kinds: &[JointKind]) -> String {
    let torque = of_joints(units::TORQUE, "", kinds);
    let robots = if found.spread.has_tolerances() {
        "every robot within the tolerances of the robot file"
    } else {
        "the robot with the numbers of its file"
    };
    format!(
        "funnel       asked about: torques up to {} {torque} on links and {} {torque} on motors, {robots}",
        at_most(&found.link_torque),
        at_most(&found.motor_torque)
    )
}

/// Under which torques, and of which robots, a funnel is; the number is exact.
fn under(times: f64) -> String {
    let torques =
        if times.total_cmp(&1.0).is_eq() { String::new() } else { format!(" up to {times} times those") };
    format!("under every torque{torques} and for every robot asked about")
}

/// What is in the way of larger torques.
fn binding(binding: &Binding) -> String {
    let Binding { times, joint, key, at } = binding;
    match (joint, key) {
        (Some(joint), Some(key)) => {
            format!("funnel       under {times} times those torques {key} of joint {}: {at}", joint + 1)
        }
        _ => format!("funnel       under {times} times those torques none was found: {at}"),
    }
}
