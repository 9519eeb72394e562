//! What a proof takes for granted of a scenario, in words.

use crate::robot;
use crate::scenario::{self, Scenario};

/// What the scenario has and a certificate does not speak of.
pub(crate) fn beyond_the_model(scenario: &Scenario) -> Vec<String> {
    let mut notes = Vec::new();
    if scenario.hold == scenario::Hold::ZeroOrder {
        let period = scenario.control_period;
        notes.push(format!("continuous time: the torque of this scenario is held for {period} s"));
    }
    for option in scenario.plant.options() {
        notes.push(format!("the model of the law: plant.{option} of this scenario is left out"));
    }
    for imperfection in &scenario.imperfections {
        notes.push(format!("the ideal loop: {} of this scenario is left out", imperfection.kind()));
    }
    if scenario.estimator.is_some() {
        notes.push("true states: the estimator of this scenario is left out".to_owned());
    }
    if scenario.guard.is_some() {
        notes.push(
            "the torque of the law: while the guard of this scenario limits or stops, nothing is said"
                .to_owned(),
        );
    }
    let robot = &scenario.robot;
    notes.extend(tolerances(robot));
    for (i, joint) in robot.joints.iter().enumerate() {
        let (lower, upper) = (robot.limits.lower[i], robot.limits.upper[i]);
        if joint.kind == robot::JointKind::Prismatic && lower.is_finite() && upper.is_finite() {
            notes
                .push(format!("{} slides between {lower} and {upper} m: nothing is said beyond", joint.name));
        }
    }
    notes
}

/// What is to be said of a robot with tolerances.
fn tolerances(robot: &robot::Robot) -> Vec<String> {
    if robot.tolerances.are_none() {
        return Vec::new();
    }
    let mut notes = vec![
        "rates, region, structures and tube are those of the numbers of the robot file: its tolerances are no part of the \
         certificate"
            .to_owned(),
    ];
    for (key, values) in robot.tolerances.named() {
        let without = robot.joints.iter().zip(values).filter(|(_, tolerance)| **tolerance == 0.0);
        let without: Vec<&str> = without.map(|(joint, _)| &*joint.name).collect();
        if !without.is_empty() {
            let joints =
                if without.len() == values.len() { "all joints".to_owned() } else { without.join(", ") };
            notes.push(format!("{key} of {joints} is taken as it stands: it has no tolerance"));
        }
    }
    notes.push(
        "the links' lengths, centres of mass and the directions of their inertias are taken as they stand: they have no tolerances"
            .to_owned(),
    );
    notes
}
