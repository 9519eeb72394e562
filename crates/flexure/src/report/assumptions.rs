//! What was assumed, for reports.

use crate::files;
use crate::report::AssumedNumber;
use crate::scenario::Scenario;
use crate::units::Unit;

/// Every assumption of every file, once; a scenario's include its robot's.
pub fn assumptions<'a>(scenarios: impl Iterator<Item = &'a Scenario>) -> Vec<AssumedNumber> {
    let mut all: Vec<AssumedNumber> = Vec::new();
    for scenario in scenarios {
        for assumed in &scenario.assumptions {
            let seen = all.iter().any(|a| a.file == assumed.file && a.key == assumed.key);
            if !seen {
                all.push(AssumedNumber {
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

/// Unit of the value at `key` of a robot or scenario file, behind a blank; empty for none and for whole tables.
fn unit(key: &str) -> String {
    Unit::of_key(key).map(|unit| format!(" {}", unit.raised)).unwrap_or_default()
}
