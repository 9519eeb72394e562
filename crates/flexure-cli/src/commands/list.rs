//! `flexure list`: what is registered.

use std::collections::BTreeMap;

use clap::ValueEnum;
use flexure::registered::registered;

use super::print;
use crate::args::Kind;
use crate::failure::Failure;

pub fn list(kind: Option<Kind>, json: bool) -> Result<(), Failure> {
    let name = kind.and_then(|kind| kind.to_possible_value());
    let is_asked = |section: &str| name.as_ref().is_none_or(|name| name.get_name() == section);
    let sections: Vec<_> = registered().into_iter().filter(|(section, _)| is_asked(section)).collect();
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
