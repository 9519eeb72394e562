//! `[sources]`: where numbers come from, and which of them are assumed.

use std::collections::BTreeSet;

use crate::files::document::Places;
use crate::files::field::Field;
use crate::files::suggest;
use crate::files::table::Table;

/// A number that no source vouches for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumption {
    /// Dotted key in the file, like `joints.stiffness`.
    pub key: String,
    /// The value as it stands there, `[9.0, 4.0]`.
    pub value: String,
    /// Reason after `assumed:` in the file.
    pub note: String,
    /// Name of the file that the number stands in.
    pub file: String,
}

/// Reads `[sources]` of `root`: each key names a key of the same file, in full or by its last parts.
pub(crate) fn assumptions(root: &Table<'_>, places: &Places) -> Option<Vec<Assumption>> {
    let Some(sources) = root.get("sources") else { return Some(Vec::new()) };
    let known = Known::of(places);
    let mut assumed = Vec::new();
    visit(&sources.any_table()?, "", &known, places, &mut assumed)?;
    Some(assumed)
}

/// The keys that may be named.
struct Known<'a> {
    /// As they stand in the file.
    indexed: Vec<Key<'a>>,
    /// Without the indices of arrays.
    plain: Vec<Key<'a>>,
}

struct Key<'a> {
    path: String,
    /// Without the name of a joint: a number of one joint is found like the one of all joints.
    of_all: String,
    text: &'a str,
}

impl<'a> Known<'a> {
    fn of(places: &'a Places) -> Self {
        let of = |name: fn(&str) -> String| {
            // A tolerance is from where its number is: `stiffness` means that.
            let is_named = |path: &str| !path.starts_with("sources") && !path.starts_with("tolerances");
            let keys = places.keys().filter(|(path, _)| is_named(path));
            let key = |(path, text): (&str, &'a str)| {
                let path = name(path);
                Key { of_all: without_joint(&path), path, text }
            };
            keys.map(key).collect()
        };
        Self { indexed: of(str::to_owned), plain: of(without_indices) }
    }
}

/// A dotted key without quotes is a table inside `[sources]`: both notations mean the same.
fn visit(
    table: &Table<'_>,
    prefix: &str,
    known: &Known<'_>,
    places: &Places,
    assumed: &mut Vec<Assumption>,
) -> Option<()> {
    for (key, field) in table.fields() {
        let key = if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") };
        let is_there = || known.plain.iter().any(|known| known.path == key);
        if field.value.is_table() {
            visit(&field.any_table()?, &key, known, places, assumed)?;
        } else if field.log.source.has_replaced(&key) && !is_there() {
            // It was about a number that is no longer there.
        } else if let Some(note) = field.text()?.strip_prefix("assumed:") {
            let (key, value) = named_by(&key, &field, known)?;
            let note = note.trim().to_owned();
            assumed.push(Assumption { key, value, note, file: places.file().to_owned() });
        } else {
            named_by(&key, &field, known)?;
        }
    }
    Some(())
}

/// The full key that `key` names, and its text in the file.
fn named_by(key: &str, field: &Field<'_>, known: &Known<'_>) -> Option<(String, String)> {
    let known = if key.contains('[') { &known.indexed } else { &known.plain };
    let ending = format!(".{key}");
    let mut matches: Vec<_> = known.iter().filter(|k| k.path == key).map(|k| (&k.path, k.text)).collect();
    if matches.is_empty() {
        let by_its_end = known.iter().filter(|k| k.of_all == key || k.of_all.ends_with(&ending));
        matches = by_its_end.map(|k| (&k.of_all, k.text)).collect();
    }
    let Some((first, text)) = matches.first().copied() else {
        let known: BTreeSet<&str> = known.iter().map(|k| &*k.path).collect();
        let message = format!("{} names no key of this file", suggest::quoted(key));
        field.error("unknown-source", message, suggest::hint(key, known.iter().copied()));
        return None;
    };
    if let Some((other, _)) = matches.iter().find(|(path, _)| *path != first) {
        let message = format!("{} may mean {first} or {other}", suggest::quoted(key));
        field.error("ambiguous-source", message, format!("write the whole key, \"{first}\""));
        return None;
    }
    let value = match matches.len() {
        1 => text.split_whitespace().collect::<Vec<_>>().join(" "),
        n => format!("{n} values"),
    };
    Some((first.clone(), value))
}

/// `links.joint[2].mass` → `links.joint.mass`.
fn without_indices(path: &str) -> String {
    path.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect()
}

/// `joints.elbow.stiffness` → `joints.stiffness`.
fn without_joint(path: &str) -> String {
    match (path.strip_prefix("joints."), path.rsplit_once('.')) {
        (Some(_), Some((_, key))) => format!("joints.{key}"),
        _ => path.to_owned(),
    }
}
