//! A scenario with what a SPEC file replaces in it.

use std::path::Path;

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

use crate::design::spec::SpecFile;
use crate::files::source::Source;
use crate::files::{Outside, Problem, Problems, Reading, change};
use crate::laws::Controller;
use crate::scenario::{self, Hold, Scenario};

/// The loops that gains are wanted for, and the file that they go into.
#[derive(Clone, Debug)]
pub struct Specified {
    /// The loop under each reference of the SPEC, with the longest delay.
    pub scenarios: Vec<Scenario>,
    /// The file of the first of them.
    document: DocumentMut,
}

impl Specified {
    /// The scenario at a path, or the built-in one of that name, with what `spec` replaces, after the changes of `reading`.
    ///
    /// # Errors
    /// With everything that is wrong with the scenario that comes of it; `unsupported` for a change of the robot's file, which is not
    /// the file that gains go into.
    pub fn load<'a>(
        path_or_name: &str,
        reading: impl Into<Reading<'a>>,
        spec: &SpecFile,
    ) -> Result<Self, Problems> {
        let Reading { outside, changes } = reading.into();
        let (source, base) = scenario::load::source(path_or_name, outside)?;
        if let Some(change) = changes.iter().find(|change| change.is_of_robot()) {
            return Err(change.of_another_file().into());
        }
        // What is wrong with the scenario itself is told with its own lines.
        let own = scenario::document::read(&source, &base, changes)?;
        if own.hold == Hold::Continuous {
            let help = "remove hold: the torque is then held between control instants";
            let message = "hold is \"continuous\": gains are tuned for loops with control periods";
            return Err(own.places.problem("hold", "unsupported", message, help).into());
        }
        let mut document = change::edited(&source, changes);
        spec.replace_in(&mut document);
        let references = spec.references();
        let name = if spec.name.is_empty() {
            source.name.to_string()
        } else {
            format!("{} with {}", source.name, spec.name)
        };
        let read = |document: &DocumentMut| {
            let mut scenario =
                scenario::document::read(&Source::new(&name, &document.to_string()), &base, &[])?;
            scenario.name.clone_from(&own.name);
            Ok::<_, Problems>(scenario)
        };
        let mut scenarios = Vec::new();
        for reference in references.iter().rev() {
            document.insert("reference", Item::Table(reference.clone()));
            scenarios.insert(0, read(&document)?);
        }
        if references.is_empty() {
            scenarios.push(read(&document)?);
        }
        Ok(Self { scenarios, document })
    }

    /// The scenario file with `controller` in it, below a `comment`.
    pub fn with(&self, controller: &Controller, comment: &str) -> String {
        let mut document = self.document.clone();
        let gains: DocumentMut = controller.to_toml().parse().unwrap_or_default();
        if let Some(mut item) = gains.get("controller").cloned() {
            // Where the old one stood, with the comments before it.
            if let (Some(new), Some(old)) =
                (item.as_table_mut(), document.get("controller").and_then(Item::as_table))
            {
                new.decor_mut().clone_from(old.decor());
                new.set_position(old.position());
            }
            document.insert("controller", item);
        }
        let comment: Vec<String> = comment.lines().map(|line| format!("# {line}")).collect();
        format!("{}\n{document}", comment.join("\n"))
    }

    /// That the file would be read beside `path`: what it names must be found from there.
    ///
    /// # Errors
    /// If it is not.
    pub fn belongs(&self, path: &Path, outside: Outside) -> Result<(), Problem> {
        let text = self.document.to_string();
        let base = crate::files::base::Base::of(path, outside);
        let read = scenario::document::read(&Source::new(&path.display().to_string(), &text), &base, &[]);
        read.map(drop).map_err(|problems| {
            let message = format!(
                "{} may not be written there: what the scenario names would not be found from that folder: {}",
                path.display(),
                problems.iter().next().map_or_else(String::new, ToString::to_string)
            );
            Problem::new("outside", message, "write it into the folder of the scenario")
        })
    }
}

impl SpecFile {
    /// The references of the SPEC: none, one table, or an array of them.
    fn references(&self) -> Vec<Table> {
        match self.document.get("reference") {
            Some(Item::Table(one)) => vec![one.clone()],
            Some(Item::ArrayOfTables(several)) => several.iter().cloned().collect(),
            _ => Vec::new(),
        }
    }

    /// Puts what the SPEC has in the place of what the scenario has, references aside.
    fn replace_in(&self, document: &mut DocumentMut) {
        if let Some(period) = self.document.get("control_period") {
            document.insert("control_period", period.clone());
        }
        if let Some(accept) = self.document.get("accept").and_then(Item::as_table_like) {
            let own = document.entry("accept").or_insert(Item::Table(Table::new()));
            if let Some(own) = own.as_table_like_mut() {
                for (key, item) in accept.iter() {
                    own.insert(key, item.clone());
                }
            }
        }
        if let Some(imperfections) = self.document.get("imperfection").and_then(Item::as_array_of_tables) {
            for imperfection in imperfections {
                replace(document, imperfection.clone());
            }
        }
        if let Some([_, longest]) = self.spec.delay {
            let mut delay = Table::new();
            delay.insert("kind", value("delay"));
            delay.insert("computation", value(longest));
            delay.insert("actuation", value(0.0));
            replace(document, delay);
        }
    }
}

/// Puts `imperfection` in the place of the one of its kind, placement and side, or behind the others.
fn replace(document: &mut DocumentMut, mut imperfection: Table) {
    let item = document.entry("imperfection").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    let Some(entries) = item.as_array_of_tables_mut() else { return };
    let alike = |entry: &Table| {
        ["kind", "placement", "side"].iter().all(|key| {
            let text = |table: &Table| table.get(key).and_then(Item::as_str).map(str::to_owned);
            text(entry) == text(&imperfection)
        })
    };
    let index = entries.iter().position(alike);
    match index {
        Some(index) => {
            if let Some(entry) = entries.get_mut(index) {
                *imperfection.decor_mut() = entry.decor().clone();
                imperfection.set_position(entry.position());
                *entry = imperfection;
            }
        }
        None => entries.push(imperfection),
    }
}
