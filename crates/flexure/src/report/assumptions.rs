//! What was assumed, for reports.

use crate::files;
use crate::report::Assumption;
use crate::scenario::Scenario;

/// Every assumption of every file, once; a scenario's include its robot's.
pub fn assumptions<'a>(scenarios: impl Iterator<Item = &'a Scenario>) -> Vec<Assumption> {
    let mut all: Vec<Assumption> = Vec::new();
    for scenario in scenarios {
        for assumed in &scenario.assumptions {
            let seen = all.iter().any(|a| a.file == assumed.file && a.key == assumed.key);
            if !seen {
                all.push(Assumption {
                    file: assumed.file.clone(),
                    key: assumed.key.clone(),
                    value: value(assumed),
                    note: assumed.note.clone(),
                });
            }
        }
    }
    all
}

/// The assumed value with its unit; whole tables are named, not printed.
fn value(assumed: &files::Assumption) -> String {
    if assumed.value == format!("[{}]", assumed.key) {
        return "the whole table".to_owned();
    }
    format!("{}{}", assumed.value, unit(&assumed.key).replace(' ', "\u{a0}"))
}

/// Unit of the value at `key` of a robot or scenario file; empty for none and for whole tables.
fn unit(key: &str) -> &'static str {
    match key.rsplit('.').next().unwrap_or_default() {
        "duration" | "control_period" | "settle" | "rise" => " s",
        "gravity" => " m/s²",
        "mass" => " kg",
        "length" | "com" => " m",
        "inertia" | "motor_inertia" => " kg m²",
        "stiffness" | "metric" => " N m/rad",
        "link_damping" | "motor_damping" | "damping" => " N m s/rad",
        "torque_limit" => " N m",
        "torque_rate_limit" => " N m/s",
        "velocity_limit" => " rad/s",
        "deflection_limit" => " rad",
        "spring_hardening" | "metric_hardening" => " N m/rad³",
        "kappa" => " 1/s",
        _ => "",
    }
}
