//! A scenario with what a SPEC file replaces in it.

use std::path::Path;

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

use crate::design::spec::SpecFile;
use crate::files::source::Source;
use crate::files::traced::traced;
use crate::files::{Bundle, Outside, Problem, Problems, Reading, change, spare};
use crate::laws::Controller;
use crate::scenario::{Hold, Scenario, document};

/// What the first line of the files begins with that tuning writes, as a comment.
pub(super) const TUNED: &str = "Tuned by flexure";

/// That a tuned scenario may be written to `out`: it is none of `inputs`, and no file that something else has written.
///
/// # Errors
/// If it is.
pub fn spare_out(out: &Path, inputs: &[&Path]) -> Result<(), Problem> {
    let is_tuned = |text: &str| text.strip_prefix("# ").is_some_and(|text| text.starts_with(TUNED));
    spare(out, "scenario that was tuned", is_tuned, inputs)
}

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
        let (own, bundle) = Scenario::bundled(path_or_name, reading)?;
        Self::of(&own, &bundle, spec)
    }

    /// The same from a scenario that was read, and its bundle.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn of(own: &Scenario, bundle: &Bundle, spec: &SpecFile) -> Result<Self, Problems> {
        let Bundle { source, changes, .. } = bundle;
        if let Some(change) = changes.iter().find(|change| change.is_of_robot()) {
            return Err(change.of_another_file().into());
        }
        let base = bundle.base();
        if own.hold == Hold::Continuous {
            let help = "remove hold: the torque is then held between control instants";
            let message = "hold is \"continuous\": gains are tuned for loops with control periods";
            return Err(own.places.problem("hold", "unsupported", message, help).into());
        }
        let mut document = change::edited(source, changes);
        let replaced = spec.replace_in(&mut document);
        let references = spec.references();
        let read = |document: &DocumentMut, reference: &str| {
            let origin = |key: &str| {
                let spec = spec.places.as_ref();
                let of_spec = || spec?.origin(&named_in_spec(key, reference, &replaced)?);
                of_spec().or_else(|| own.places.origin(key))
            };
            let source = traced(&source.name, &document.to_string(), origin);
            document::read(&source, &base, &[]).map(|scenario| scenario.by_collocation())
        };
        let mut scenarios = Vec::new();
        for (name, reference) in references.iter().rev() {
            let mut reference = reference.clone();
            stand(
                &mut reference,
                document.get("reference").and_then(Item::as_table).and_then(Table::position),
            );
            document.insert("reference", Item::Table(reference));
            scenarios.insert(0, read(&document, name)?);
        }
        if references.is_empty() {
            scenarios.push(read(&document, "")?);
        }
        Ok(Self { scenarios, document })
    }

    /// The scenario file with `controller` in it, below a `comment`.
    pub fn with(&self, controller: &Controller, comment: &str) -> String {
        let mut document = self.document.clone();
        let gains: DocumentMut = controller.to_toml().parse().unwrap_or_default();
        if let Some(mut item) = gains.get("controller").cloned() {
            // Where the old one stood, with the comments above it.
            if let (Some(new), Some(old)) =
                (item.as_table_mut(), document.get("controller").and_then(Item::as_table))
            {
                if let Some(above) = old.decor().prefix() {
                    new.decor_mut().set_prefix(above.clone());
                }
                stand(new, old.position());
                let sides = new.iter_mut().filter_map(|(_, item)| item.as_table_mut());
                sides.for_each(|side| side.decor_mut().set_prefix("\n"));
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
        let read = document::read(&Source::new(&path.display().to_string(), &text), &base, &[]);
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

/// Lets `table`, and those in it, stand at `position` of a document.
fn stand(table: &mut Table, position: Option<isize>) {
    table.set_position(position);
    for (_, item) in table.iter_mut() {
        if let Some(inner) = item.as_table_mut() {
            stand(inner, position);
        }
    }
}

/// What the `key` of a scenario that comes from a SPEC is called there; `reference` is the name of its reference, and `imperfections`
/// are indices of those that were replaced, with their names. None of what only the scenario has.
fn named_in_spec(key: &str, reference: &str, imperfections: &[(usize, String)]) -> Option<String> {
    if let Some(rest) = key.strip_prefix("reference") {
        return Some(format!("{reference}{rest}"));
    }
    let of_imperfection = |(index, name): &(usize, String)| {
        let rest = key.strip_prefix(&format!("imperfection[{index}]"))?;
        // A delay is one number there.
        Some(if name == "delay" { name.clone() } else { format!("{name}{rest}") })
    };
    match imperfections.iter().find_map(of_imperfection) {
        Some(name) => Some(name),
        // The scenario's own: in the SPEC that number is another one.
        None if key.starts_with("imperfection[") => None,
        None => Some(key.to_owned()),
    }
}

impl SpecFile {
    /// The references of the SPEC with their names: none, one table, or an array of them.
    fn references(&self) -> Vec<(String, Table)> {
        match self.document.get("reference") {
            Some(Item::Table(one)) => vec![("reference".to_owned(), one.clone())],
            Some(Item::ArrayOfTables(several)) => {
                let named = several.iter().enumerate();
                named.map(|(i, one)| (format!("reference[{i}]"), one.clone())).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Puts what the SPEC has in the place of what the scenario has, references aside; the indices of imperfections that it has, with
    /// their names in the SPEC.
    fn replace_in(&self, document: &mut DocumentMut) -> Vec<(usize, String)> {
        let mut replaced = Vec::new();
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
            for (i, imperfection) in imperfections.iter().enumerate() {
                let index = replace(document, imperfection.clone());
                replaced.extend(index.map(|index| (index, format!("imperfection[{i}]"))));
            }
        }
        if let Some([_, longest]) = self.spec.delay {
            let mut delay = Table::new();
            delay.insert("kind", value("delay"));
            delay.insert("computation", value(longest));
            delay.insert("actuation", value(0.0));
            let index = replace(document, delay);
            replaced.extend(index.map(|index| (index, "delay".to_owned())));
        }
        replaced
    }
}

/// Puts `imperfection` in the place of the one of its kind, placement and side, or behind the others; its index.
fn replace(document: &mut DocumentMut, mut imperfection: Table) -> Option<usize> {
    let item = document.entry("imperfection").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    let entries = item.as_array_of_tables_mut()?;
    let alike = |entry: &Table| {
        ["kind", "placement", "side"].iter().all(|key| {
            let text = |table: &Table| table.get(key).and_then(Item::as_str).map(str::to_owned);
            text(entry) == text(&imperfection)
        })
    };
    let index = entries.iter().position(alike);
    if let Some(index) = index {
        let entry = entries.get_mut(index)?;
        *imperfection.decor_mut() = entry.decor().clone();
        stand(&mut imperfection, entry.position());
        *entry = imperfection;
        return Some(index);
    }
    entries.push(imperfection);
    Some(entries.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::named_in_spec;

    /// Numbers of the scenario are not looked up in the SPEC, where other imperfections have the same indices.
    #[test]
    fn what_is_the_scenarios_own_has_no_name_in_the_spec() {
        let replaced = [(2, "delay".to_owned()), (3, "imperfection[0]".to_owned())];
        let named = |key| named_in_spec(key, "reference[1]", &replaced);
        assert_eq!(named("imperfection[0].resolution"), None);
        assert_eq!(named("imperfection[3].resolution").as_deref(), Some("imperfection[0].resolution"));
        assert_eq!(named("imperfection[2].computation").as_deref(), Some("delay"));
        assert_eq!(named("reference.amplitude").as_deref(), Some("reference[1].amplitude"));
        assert_eq!(named("accept.error").as_deref(), Some("accept.error"));
    }
}
