//! `flexure list`: what is registered.

use std::collections::BTreeMap;

use flexure::files::{Entry, ROBOTS, SCENARIOS, TASKS};
use flexure::imperfections::IMPERFECTIONS;
use flexure::laws::{CONTROLLERS, SHAPING};
use flexure::references::REFERENCES;
use flexure::robot::DRIVES;

use super::print;
use crate::args::Kind;
use crate::failure::Failure;

pub fn list(kind: Option<Kind>, json: bool) -> Result<(), Failure> {
    let sections: Vec<(&str, Vec<(&str, String)>)> = [
        (Kind::Robots, "robots", files(ROBOTS)),
        (Kind::Scenarios, "scenarios", files(&[SCENARIOS, TASKS].concat())),
        (Kind::Controllers, "controllers", entries(CONTROLLERS)),
        (Kind::Shaping, "shaping", entries(SHAPING)),
        (Kind::References, "references", entries(REFERENCES)),
        (Kind::Imperfections, "imperfections", entries(IMPERFECTIONS)),
        (Kind::Drives, "drives", entries(&DRIVES.iter().map(|class| class.entry).collect::<Vec<_>>())),
    ]
    .into_iter()
    .filter(|(own, ..)| kind.is_none_or(|kind| kind == *own))
    .map(|(_, name, members)| (name, members))
    .collect();
    if json {
        let document: BTreeMap<_, BTreeMap<_, _>> =
            sections.into_iter().map(|(name, members)| (name, members.into_iter().collect())).collect();
        return print::json(&document);
    }
    let width =
        sections.iter().flat_map(|(_, members)| members).map(|(member, _)| member.len()).max().unwrap_or(0);
    for (name, members) in sections {
        print::line(name)?;
        for (member, summary) in members {
            print::line(&format!("  {member:<width$}  {summary}"))?;
        }
    }
    Ok(())
}

fn entries(registry: &[Entry]) -> Vec<(&'static str, String)> {
    registry.iter().map(|entry| (entry.name, entry.summary.to_owned())).collect()
}

/// Built-in files, summarised by the first sentence of their leading comment.
fn files(registry: &[(&'static str, &'static str)]) -> Vec<(&'static str, String)> {
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
