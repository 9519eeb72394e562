//! What has a name: built-in files, and the kinds that files choose from.

use crate::files::{Entry, ROBOTS, SCENARIOS, TASKS};
use crate::imperfections::IMPERFECTIONS;
use crate::laws::{CONTROLLERS, SHAPING};
use crate::references::REFERENCES;
use crate::robot::DRIVES;

/// Names with a line on each.
pub type Section = Vec<(&'static str, String)>;

/// Every section, by its name.
pub fn registered() -> [(&'static str, Section); 7] {
    [
        ("robots", files(ROBOTS)),
        ("scenarios", files(&[SCENARIOS, TASKS].concat())),
        ("controllers", entries(CONTROLLERS)),
        ("shaping", entries(SHAPING)),
        ("references", entries(REFERENCES)),
        ("imperfections", entries(IMPERFECTIONS)),
        ("drives", entries(&DRIVES.iter().map(|class| class.entry).collect::<Vec<_>>())),
    ]
}

fn entries(registry: &[Entry]) -> Section {
    registry.iter().map(|entry| (entry.name, entry.summary.to_owned())).collect()
}

/// Built-in files, summarised by the first sentence of their leading comment.
fn files(registry: &[(&'static str, &'static str)]) -> Section {
    registry
        .iter()
        .map(|&(name, text)| {
            let comment: Vec<_> =
                text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim).collect();
            let comment = comment.join(" ");
            (name, comment.split(". ").next().unwrap_or_default().trim_end_matches('.').to_owned())
        })
        .collect()
}
