//! Sweep files: which scenario, which of its numbers change, which points, what is kept.

use std::collections::BTreeSet;

use toml::de::DeValue;

use super::design::{Design, KINDS, Kind};
use super::metric::{METRICS, Metric};
use super::parameter::{PARAMETERS, Parameter, Value, Values};
use super::sobol;
use crate::files::Change;
use crate::files::document::Form;
use crate::files::field::Field;
use crate::files::quantity::Quantity;
use crate::files::suggest;
use crate::files::table::Table;
use crate::units;

pub(super) const FORM: Form = Form {
    what: "sweep file",
    required: &["scenario", "parameters"],
    optional: &["design", "points", "seed", "seeds", "shard", "metrics", "set"],
    other: (
        "controller",
        "scenario file",
        "a sweep file names it: scenario = \"PATH\", and says which of its numbers change",
    ),
};

/// Of a scenario in hand, or one that was read before.
pub(super) const IN_HAND: Form = Form {
    required: &["parameters"],
    optional: &["scenario", "design", "points", "seed", "seeds", "shard", "metrics", "set"],
    ..FORM
};

/// What changes in `[set]` are called in messages.
const SET: &str = "[set]";

/// Rows of a shard where nothing is said.
const SHARD: u64 = 1000;

/// Most rows, points, and rows of a shard.
const MOST_ROWS: u64 = 1_000_000_000_000;
const MOST_IN_A_SHARD: u64 = 10_000_000;

/// Most parameters, so that a row fits into a table that people look at.
const MOST_PARAMETERS: usize = sobol::DIMENSIONS;

/// Largest seed: all are numbers that JSON and floats keep.
const LARGEST_SEED: u64 = 1 << 53;

/// The seeds of a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Seeds {
    /// So many runs of each point, each with a seed of its own.
    Own(u64),
    /// Runs of each point with these.
    Shared(Vec<u64>),
}

impl Seeds {
    /// Runs of each point.
    pub fn count(&self) -> u64 {
        match self {
            Self::Own(count) => *count,
            Self::Shared(seeds) => seeds.len() as u64,
        }
    }
}

/// The scenario that a sweep file names.
pub(super) fn scenario(root: &Table<'_>) -> Option<String> {
    let field = root.required("scenario", "path of a scenario file or name of a built-in scenario");
    field.and_then(|field| field.text().map(str::to_owned))
}

/// What a sweep file says besides.
#[derive(Clone, Debug)]
pub(super) struct Said {
    pub set: Vec<Change>,
    pub parameters: Vec<Parameter>,
    pub design: Design,
    pub seeds: Seeds,
    pub shard: u64,
    pub metrics: Vec<&'static Metric>,
}

const NUMBER: Quantity = Quantity::any("value of the key", units::NONE);

/// Reads the root table.
pub(super) fn said(root: &Table<'_>) -> Option<Said> {
    let set = root.optional("set", |field| changes(&field.any_table()?));
    let parameters = root.required("parameters", "a table with a line for each key that changes");
    let parameters = parameters.and_then(|field| parameters_of(&field));
    let kind = root.optional("design", |field| field.choice(&KINDS)).map(|kind| kind.unwrap_or(Kind::Grid));
    let points = root.optional("points", |field| field.whole("points of the design", 1, MOST_ROWS));
    let seed = root.optional("seed", |field| field.whole("seed of the sweep", 0, LARGEST_SEED));
    let seeds = root.optional("seeds", seeds).map(|seeds| seeds.unwrap_or(Seeds::Own(1)));
    let shard = root.optional("shard", |field| field.whole("rows of a file", 1, MOST_IN_A_SHARD));
    let metrics = root.optional("metrics", metrics);
    let (parameters, kind) = (parameters?, kind?);
    refuse_grid_points(root, kind)?;
    let points = points_of(root, kind, points?, &parameters)?;
    let seeds = seeds?;
    if points.saturating_mul(seeds.count()) > MOST_ROWS {
        let message = format!("{points} points with {} seeds each are too many", seeds.count());
        root.error("range", message, format!("a sweep has at most {MOST_ROWS} rows"));
        return None;
    }
    Some(Said {
        set: set?.unwrap_or_default(),
        parameters,
        design: Design { kind, points, seed: seed?.unwrap_or(0) },
        seeds,
        shard: shard?.unwrap_or(SHARD),
        metrics: metrics?.unwrap_or_else(|| METRICS.iter().filter(|metric| metric.usual).collect()),
    })
}

/// That values on a grid are counted where there is none.
fn refuse_grid_points(root: &Table<'_>, kind: Kind) -> Option<()> {
    let entries = flat(&root.get("parameters")?.any_table()?, &is_leaf)?;
    for (key, field) in entries {
        let Some(points) = field.any_table()?.get("points").filter(|_| kind != Kind::Grid) else { continue };
        let message = format!("{key} has points, and the design is no grid");
        points.error("contradiction", message, "points of all parameters stand above [parameters]");
        return None;
    }
    Some(())
}

/// Whether a table is a parameter, not a part of keys.
fn is_leaf(field: &Field<'_>) -> bool {
    match field.value {
        DeValue::Table(entries) => LEAF.iter().any(|key| entries.contains_key(*key)),
        _ => true,
    }
}

/// How many points there are.
fn points_of(root: &Table<'_>, kind: Kind, said: Option<u64>, parameters: &[Parameter]) -> Option<u64> {
    let field = root.get("points");
    let refuse = |code, message: String, help: &str| match &field {
        Some(field) => field.error(code, message, help.to_owned()),
        None => root.error(code, message, help.to_owned()),
    };
    match (kind, said) {
        (Kind::Grid, Some(_)) => {
            let message = "a grid has as many points as its parameters have values".to_owned();
            refuse("contradiction", message, "leave points out, or choose design = \"sobol\"");
            None
        }
        (Kind::Grid, None) => {
            let count =
                parameters.iter().try_fold(1_u64, |count, parameter| count.checked_mul(parameter.count()));
            let count = count.filter(|count| *count <= MOST_ROWS);
            if count.is_none() {
                let message = format!("the grid has more than {MOST_ROWS} points");
                refuse("range", message, "give parameters fewer points, or choose design = \"sobol\"");
            }
            count
        }
        (_, None) => {
            refuse(
                "missing-key",
                "missing key points".to_owned(),
                "add points = 1024: how many the design has",
            );
            None
        }
        (Kind::Sobol, Some(points)) if points > sobol::POINTS => {
            let message = format!("points is {points}, must be at most {}", sobol::POINTS);
            refuse(
                "range",
                message,
                "there are no more points of Sobol's sequence here: choose design = \"uniform\"",
            );
            None
        }
        (_, Some(points)) => Some(points),
    }
}

/// How many, or which.
fn seeds(field: &Field<'_>) -> Option<Seeds> {
    const WHAT: &str = "runs of each point with seeds of their own, or a list of seeds that all points share";
    let DeValue::Array(entries) = field.value else {
        return field.whole(WHAT, 1, MOST_ROWS).map(Seeds::Own);
    };
    if entries.is_empty() {
        field.error("empty", "seeds is empty", WHAT);
        return None;
    }
    let seeds: Vec<_> = field.each()?.iter().map(|entry| entry.whole("seed", 0, LARGEST_SEED)).collect();
    let seeds: Vec<u64> = seeds.into_iter().collect::<Option<_>>()?;
    if seeds.iter().collect::<BTreeSet<_>>().len() < seeds.len() {
        field.error("duplicate", "seeds has one more than once", "each gives the same run again");
        return None;
    }
    Some(Seeds::Shared(seeds))
}

fn metrics(field: &Field<'_>) -> Option<Vec<&'static Metric>> {
    let names: Vec<(&str, &'static Metric)> = METRICS.iter().map(|metric| (metric.name, metric)).collect();
    let chosen: Vec<_> = field.each()?.iter().map(|entry| entry.choice(&names)).collect();
    let chosen: Vec<&'static Metric> = chosen.into_iter().collect::<Option<_>>()?;
    let distinct: BTreeSet<_> = chosen.iter().map(|metric| metric.name).collect();
    if distinct.len() < chosen.len() {
        field.error("duplicate", "metrics has one more than once", "each is a column");
        return None;
    }
    Some(chosen)
}

/// Every value of `table` and of the tables in it, with its dotted key.
fn flat<'a>(table: &Table<'a>, is_leaf: &dyn Fn(&Field<'a>) -> bool) -> Option<Vec<(String, Field<'a>)>> {
    let mut found = Vec::new();
    for (key, field) in table.fields() {
        if is_leaf(&field) {
            found.push((key.to_owned(), field));
        } else {
            let inner = flat(&field.any_table()?, is_leaf)?;
            found.extend(inner.into_iter().map(|(rest, field)| (format!("{key}.{rest}"), field)));
        }
    }
    Some(found)
}

/// The values of `[set]` as changes.
fn changes(table: &Table<'_>) -> Option<Vec<Change>> {
    let entries = flat(table, &|field| !matches!(field.value, DeValue::Table(_)))?;
    entries.iter().map(|(key, field)| change(field, SET, key, field.text_of())).collect()
}

/// The change of `key` to the value `text`.
fn change(field: &Field<'_>, from: &'static str, key: &str, text: &str) -> Option<Change> {
    let changed = Change::parse_from(from, &format!("{key} = {text}"));
    changed
        .map_err(|problem| field.error("syntax", format!("{key}: {problem}"), problem.hint().to_owned()))
        .ok()
}

fn parameters_of(field: &Field<'_>) -> Option<Vec<Parameter>> {
    let table = field.any_table()?;
    let entries = flat(&table, &is_leaf)?;
    if entries.is_empty() || entries.len() > MOST_PARAMETERS {
        let message = format!("[parameters] has {} keys, must have 1 to {MOST_PARAMETERS}", entries.len());
        field.error(
            "range",
            message,
            "\"controller.link.metric\" = { from = 0.5, to = 2.0, relative = true, points = 9 }",
        );
        return None;
    }
    let parameters: Vec<_> = entries.into_iter().map(|(key, field)| parameter(key, &field)).collect();
    parameters.into_iter().collect()
}

/// Keys of which a parameter has one.
const LEAF: [&str; 3] = ["from", "to", "values"];

fn parameter(key: String, field: &Field<'_>) -> Option<Parameter> {
    let table = field.table(&["from", "to", "values", "points", "scale", "relative"])?;
    change(field, PARAMETERS, &key, "0")?;
    if key == "seed" {
        field.error(
            "unsupported",
            "seed is no parameter",
            "seeds = 10, or seeds = [1, 2, 3], above [parameters]",
        );
        return None;
    }
    let relative = table.optional("relative", Field::boolean)?.unwrap_or(false);
    let values = match table.get("values") {
        Some(listed) => {
            let other = ["from", "to", "points", "scale"].iter().find_map(|key| Some((key, table.get(key)?)));
            if let Some((other, field)) = other {
                let message = format!("{key} has values and {other}");
                field.error("contradiction", message, "values = [...], or from and to");
                return None;
            }
            let entries = listed.each()?;
            if entries.is_empty() {
                listed.error("empty", format!("{key} has no values"), "values = [1.0, 2.0]");
                return None;
            }
            let texts: Vec<String> = entries.iter().map(|entry| entry.text_of().to_owned()).collect();
            if texts.iter().collect::<BTreeSet<_>>().len() < texts.len() {
                listed.error(
                    "duplicate",
                    format!("{key} has a value more than once"),
                    "seeds = 2 runs each point twice",
                );
                return None;
            }
            let is_number =
                |entry: &Field<'_>| matches!(entry.value, DeValue::Float(_) | DeValue::Integer(_));
            let are_numbers = entries.iter().all(is_number);
            let value = |entry: &Field<'_>| match entry.value {
                _ if are_numbers => entry.number(&NUMBER).map(Value::Number),
                DeValue::String(text) => Some(Value::Text(text.to_string())),
                _ => Some(Value::Text(entry.text_of().to_owned())),
            };
            let values: Vec<_> = entries.iter().map(value).collect();
            let values: Vec<Value> = values.into_iter().collect::<Option<_>>()?;
            Values::Listed(values.into_iter().zip(texts).collect())
        }
        None => between(&table)?,
    };
    let parameter = Parameter { key, values, relative, base: Vec::new() };
    if relative && !parameter.is_number() {
        let message = format!("{} is relative, and its values are no numbers", parameter.key);
        field.error("type", message, "factors on what the file says are numbers");
        return None;
    }
    Some(parameter)
}

fn between(table: &Table<'_>) -> Option<Values> {
    let from = table.number("from", &NUMBER);
    let to = table.number("to", &NUMBER);
    let points = table.optional("points", |field| field.whole("values on a grid", 1, MOST_ROWS));
    let logarithmic = table.optional("scale", |field| field.choice(&[("linear", false), ("log", true)]));
    let (from, to, logarithmic) = (from?, to?, logarithmic?.unwrap_or(false));
    if logarithmic && (from <= 0.0 || to <= 0.0) {
        let help = "scale = \"linear\", or ends above zero";
        table.error(
            "range",
            format!("scale is log, and an end is {}", suggest::quoted(&from.min(to).to_string())),
            help,
        );
        return None;
    }
    Some(Values::Between { from, to, logarithmic, points: points?.unwrap_or(11) })
}
