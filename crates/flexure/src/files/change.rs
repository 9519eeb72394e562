//! A change of a document from outside: `KEY=VALUE`, as `--set` takes it.
//!
//! Changes are made to the document that a file is parsed to, before anything is read from it, so that a changed value is
//! validated as one of the file is. Their texts are appended to that of the file: every value has its place, in the file or in
//! a change.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

use crate::files::diagnostic::Problem;
use crate::files::source::Source;
use crate::files::suggest;

/// What changes are called in messages, as a file is by its name.
pub(crate) const NAME: &str = "--set";

/// Arrays of tables whose entries have a `kind` that names them where there is no index.
const KINDS: [&str; 1] = ["imperfection"];

/// Most keys in a row, as in a file.
const DEEPEST: usize = 8;

/// A value for a key of a document.
///
/// Keys are dotted: `controller.link.metric`, `imperfection[0].computation`, or `imperfection.delay.computation`, where the only entry
/// of that kind is meant, or a new one if there is none. Values are TOML; bare words are text. `robot.` begins a key of the file
/// that `robot` of a scenario names.
///
/// ```
/// use flexure::files::{Change, Reading};
/// let changes = [Change::parse("control_period = 0.002")?, Change::parse("robot.joints.stiffness=[20, 10]")?];
/// let scenario = flexure::scenario::load_scenario_with("two-link-tanh", Reading::changed(&changes))?;
/// assert_eq!((scenario.control_period, scenario.robot.stiffness), (0.002, vec![20.0, 10.0]));
/// # Ok::<(), flexure::files::Problems>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Where it stands: what a file is by its name.
    from: &'static str,
    text: String,
    steps: Vec<Step>,
    value: Range<usize>,
}

/// A part of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Step {
    what: What,
    span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum What {
    Key(String),
    Index(usize),
}

impl What {
    fn key(&self) -> Option<&str> {
        match self {
            Self::Key(key) => Some(key),
            Self::Index(_) => None,
        }
    }
}

impl Change {
    /// Reads `KEY=VALUE`.
    ///
    /// # Errors
    /// `syntax` if it is none.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        Self::parse_from(NAME, text)
    }

    /// As [`parse`](Self::parse); messages say that it stands in `from`.
    pub(crate) fn parse_from(from: &'static str, text: &str) -> Result<Self, Problem> {
        let refuse = |span: Range<usize>, message: &str| {
            let hint = "write KEY=VALUE: control_period=0.002, controller.link.metric=[1, 2], imperfection.delay.computation=1e-3";
            Problem::new("syntax", message, hint).at(&Source::new(from, text), span)
        };
        let (mut steps, mut at) = (Vec::new(), 0);
        let value = loop {
            let rest = &text[at..];
            let blank = rest.len() - rest.trim_start().len();
            let (start, rest) = (at + blank, rest.trim_start());
            let (what, length) = match rest.chars().next() {
                Some(quote @ ('"' | '\'')) => {
                    let Some(end) = rest[1..].find(quote) else {
                        return Err(refuse(start..text.len(), &format!("a quote {quote} has no end")));
                    };
                    (What::Key(rest[1..=end].to_owned()), end + 2)
                }
                Some('[') if !steps.is_empty() => {
                    let index = rest.find(']').and_then(|end| Some((rest[1..end].trim().parse().ok()?, end)));
                    let Some((index, end)) = index else {
                        return Err(refuse(start..text.len(), "an index is a whole number in brackets"));
                    };
                    (What::Index(index), end + 1)
                }
                _ => {
                    let bare = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
                    let length = rest.find(|c| !bare(c)).unwrap_or(rest.len());
                    let key = &rest[..length];
                    if key.is_empty() {
                        return Err(refuse(start..text.len(), "a key is missing"));
                    }
                    (key.parse().map_or_else(|_| What::Key(key.to_owned()), What::Index), length)
                }
            };
            let end = start + length;
            steps.push(Step { what, span: start..end });
            let after = text[end..].trim_start();
            at = text.len() - after.len();
            match after.chars().next() {
                Some('=') => break at + 1..text.len(),
                Some('.') => at += 1,
                Some('[') => {}
                _ => return Err(refuse(end..text.len(), "= and a value are missing behind the key")),
            }
        };
        if steps.len() > DEEPEST {
            return Err(refuse(
                0..value.start,
                &format!("{} keys in a row, must be <= {DEEPEST}", steps.len()),
            ));
        }
        let given = &text[value.clone()];
        let start = value.start + given.len() - given.trim_start().len();
        Ok(Self { from, text: text.to_owned(), steps, value: start..start + given.trim().len() })
    }

    /// Whether it is about the inside of `robot`: the robot's file.
    pub(crate) fn is_of_robot(&self) -> bool {
        matches!(self.steps.as_slice(), [Step { what: What::Key(key), .. }, _, ..] if key == "robot")
    }

    /// The same change of the robot's file, if it is about that.
    pub(crate) fn of_robot(&self) -> Option<Self> {
        self.is_of_robot().then(|| Self { steps: self.steps[1..].to_vec(), ..self.clone() })
    }

    /// That a change of the robot's file cannot be written into a scenario.
    pub(crate) fn of_another_file(&self) -> Problem {
        let message = "this changes the robot's file, and what is written is the scenario's";
        let help = "copy the robot's file, change the copy, and name it: --set robot=COPY.toml; `run` and others take the change as it is";
        Problem::new("unsupported", message, help)
            .at(&Source::new(self.from, &self.text), 0..self.value.start)
    }

    /// The number, or the numbers of the array, that stand at the key in `source` after `changes`; none where something else does, or
    /// nothing.
    pub(crate) fn numbers(&self, source: &Source, changes: &[Self]) -> Option<Numbers> {
        self.found(source, changes, |value| match value {
            DeValue::Array(array) => {
                array.iter().map(|entry| number(entry.get_ref())).collect::<Option<_>>().map(Numbers::Array)
            }
            one => number(one).map(Numbers::One),
        })
    }

    /// Keys like `robot.joints.stiffness` for the tables beside it, as `robot.joints."elbow".stiffness`, where these have one.
    pub(crate) fn of_each(&self, robot: &Source, changes: &[Self]) -> Vec<String> {
        let names: Option<[&str; 3]> = match self.steps.as_slice() {
            [robot, table, key] => [robot, table, key]
                .map(|step| step.what.key())
                .into_iter()
                .collect::<Option<Vec<_>>>()
                .and_then(|names| names.try_into().ok()),
            _ => None,
        };
        let Some([of, table, key]) = names else { return Vec::new() };
        let Ok(parent) = Self::parse(&format!("{table} = 0")) else { return Vec::new() };
        let entries = parent.found(robot, changes, |value| {
            let DeValue::Table(entries) = value else { return None };
            let has = |value: &DeValue<'_>| value.get(key).is_some();
            let named =
                entries.iter().filter(|(_, value)| value.get_ref().is_table() && has(value.get_ref()));
            Some(named.map(|(name, _)| format!("{of}.{table}.\"{}\".{key}", name.get_ref())).collect())
        });
        entries.unwrap_or_default()
    }

    /// The text that stands there.
    pub(crate) fn said(&self, source: &Source, changes: &[Self]) -> Option<String> {
        self.found(source, changes, |value| value.as_str().map(str::to_owned))
    }

    fn found<T>(
        &self,
        source: &Source,
        changes: &[Self],
        read: impl FnOnce(&DeValue<'_>) -> Option<T>,
    ) -> Option<T> {
        let with = source.with(changes);
        let (mut root, _) = DeTable::parse_recoverable(with.of_file());
        for (change, at) in changes.iter().zip(with.changes()) {
            change.apply(root.get_mut(), at, &with).ok()?;
        }
        let root = DeValue::Table(root.into_inner());
        let end = self.steps.iter().try_fold(&root, |value, step| match (&step.what, value) {
            (What::Key(key), DeValue::Table(table)) => table.get(key.as_str()).map(Spanned::get_ref),
            (What::Key(kind), DeValue::Array(array)) => {
                let mut found = array.iter().map(Spanned::get_ref).filter(|entry| is_of_kind(entry, kind));
                found.next().filter(|_| found.next().is_none())
            }
            (What::Index(index), DeValue::Array(array)) => array.get(*index).map(Spanned::get_ref),
            _ => None,
        })?;
        read(end)
    }

    /// The key as it was written.
    pub(crate) fn key(&self) -> &str {
        let before = self.text.get(..self.value.start).unwrap_or_default();
        before.trim_end().trim_end_matches('=').trim()
    }

    /// Where it stands.
    pub(crate) fn from(&self) -> &'static str {
        self.from
    }

    /// As it was written.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Changes `root`, in whose source the text of the change begins at byte `at`.
    ///
    /// # Errors
    /// If the value is none, or the key leads nowhere.
    pub(crate) fn apply<'a>(
        &'a self,
        root: &mut DeTable<'a>,
        at: usize,
        source: &Source,
    ) -> Result<Vec<Turn>, Problem> {
        let shifted = |span: &Range<usize>| span.start + at..span.end + at;
        let value = match parsed(&self.text[self.value.clone()]) {
            Ok(value) => shift(value, at + self.value.start),
            Err(message) => {
                let help = "values are as in files: 0.5, [1.0, 2.0], true, \"text\"; text without quotes may be bare words";
                let span = self.value.start.min(self.text.len().saturating_sub(1))..self.text.len();
                return Err(Problem::new("syntax", message, help).at(source, shifted(&span)));
            }
        };
        let steps: Vec<Step> =
            self.steps.iter().map(|step| Step { span: shifted(&step.span), ..step.clone() }).collect();
        let mut walk = Walk { so_far: String::new(), turns: Vec::new(), source };
        walk.in_table(root, &steps, value)?;
        Ok(walk.turns)
    }
}

/// Numbers of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Numbers {
    One(f64),
    Array(Vec<f64>),
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        _ => None,
    }
}

/// Whether it is a table with this `kind`.
fn is_of_kind(entry: &DeValue<'_>, kind: &str) -> bool {
    entry.get("kind").and_then(|kind| kind.get_ref().as_str()) == Some(kind)
}

/// The value that `text` is: TOML, or bare words.
fn parsed(text: &str) -> Result<Spanned<DeValue<'_>>, String> {
    match DeValue::parse(text) {
        Ok(value) => Ok(value),
        Err(_)
            if !text.is_empty() && !text.contains(['"', '\'', '[', ']', '{', '}', '=', ',', '#', '\n']) =>
        {
            Ok(Spanned::new(0..text.len(), DeValue::String(Cow::Borrowed(text))))
        }
        Err(error) => Err(format!("the value is none: {}", error.message())),
    }
}

/// `value` with every place `by` bytes later.
fn shift<'a>(value: Spanned<DeValue<'a>>, by: usize) -> Spanned<DeValue<'a>> {
    let span = value.span().start + by..value.span().end + by;
    let value = match value.into_inner() {
        DeValue::Array(array) => {
            let mut moved = DeArray::new();
            array.iter().for_each(|entry| moved.push(shift(entry.clone(), by)));
            DeValue::Array(moved)
        }
        DeValue::Table(table) => {
            let entry = |(key, value): (&Spanned<Cow<'a, str>>, &Spanned<DeValue<'a>>)| {
                let span = key.span().start + by..key.span().end + by;
                (Spanned::new(span, key.get_ref().clone()), shift(value.clone(), by))
            };
            DeValue::Table(table.iter().map(entry).collect())
        }
        other => other,
    };
    Spanned::new(span, value)
}

/// On the way to a value.
struct Walk<'s> {
    /// The key as far as it was followed.
    so_far: String,
    /// The same, to be followed again.
    turns: Vec<Turn>,
    source: &'s Source,
}

/// A step on the way to a value that was found.
pub(crate) enum Turn {
    Key(String),
    Entry(usize),
    /// A new entry of this kind, behind the others.
    New(String),
}

impl Walk<'_> {
    fn refuse(&self, step: &Step, code: &'static str, message: String, hint: &str) -> Problem {
        Problem::new(code, message, hint).at(self.source, step.span.clone())
    }

    /// Follows `steps` from the table that was reached.
    fn in_table<'a>(
        &mut self,
        table: &mut DeTable<'a>,
        steps: &[Step],
        value: Spanned<DeValue<'a>>,
    ) -> Result<(), Problem> {
        let Some((step, rest)) = steps.split_first() else { return Ok(()) };
        let key = match &step.what {
            What::Key(key) => key.clone(),
            What::Index(index) => index.to_string(),
        };
        self.so_far = if self.so_far.is_empty() { key.clone() } else { format!("{}.{key}", self.so_far) };
        self.turns.push(Turn::Key(key.clone()));
        let named = Spanned::new(step.span.clone(), Cow::Owned(key.clone()));
        if rest.is_empty() {
            table.insert(named, value);
            return Ok(());
        }
        if !table.contains_key(key.as_str()) {
            let new = if KINDS.contains(&key.as_str()) {
                DeValue::Array(DeArray::new())
            } else {
                DeValue::Table(DeTable::new())
            };
            table.insert(named, Spanned::new(step.span.clone(), new));
        }
        match table.get_mut(key.as_str()) {
            Some(inner) => self.in_value(inner.get_mut(), rest, value),
            None => Ok(()),
        }
    }

    /// Follows `steps`, at least one, from the value that was reached.
    fn in_value<'a>(
        &mut self,
        inner: &mut DeValue<'a>,
        steps: &[Step],
        value: Spanned<DeValue<'a>>,
    ) -> Result<(), Problem> {
        match inner {
            DeValue::Table(table) => self.in_table(table, steps, value),
            DeValue::Array(array) => self.in_array(array, steps, value),
            _ => {
                let message = format!("{} is no table: there is nothing in it to set", self.so_far);
                Err(self.refuse(&steps[0], "type", message, "a key that is one value is set as a whole"))
            }
        }
    }

    /// Follows `steps`, at least one, from the array that was reached.
    fn in_array<'a>(
        &mut self,
        array: &mut DeArray<'a>,
        steps: &[Step],
        value: Spanned<DeValue<'a>>,
    ) -> Result<(), Problem> {
        let (step, rest) = (&steps[0], &steps[1..]);
        let count = array.len();
        let index = match &step.what {
            What::Index(index) => *index,
            What::Key(kind) => self.of_kind(array, kind, step)?,
        };
        self.turns.push(match &step.what {
            What::Key(kind) if index == count => Turn::New(kind.clone()),
            _ => Turn::Entry(index),
        });
        let Some(entry) = array.get_mut(index) else {
            let message =
                format!("{}[{index}]: {} has {count} entries, counted from 0", self.so_far, self.so_far);
            return Err(self.refuse(step, "range", message, "name an entry that is there"));
        };
        if let (What::Key(kind), true, false) = (&step.what, rest.is_empty(), value.get_ref().is_table()) {
            let path = format!("{}.{kind}", self.so_far);
            let hint = format!("set one of its keys: {path}.KEY=VALUE");
            return Err(self.refuse(step, "type", format!("{path} is a table, not one value"), &hint));
        }
        self.so_far = format!("{}[{index}]", self.so_far);
        if rest.is_empty() {
            *entry = value;
            return Ok(());
        }
        self.in_value(entry.get_mut(), rest, value)
    }

    /// The index of the only entry of a kind; of a new one if there is none.
    fn of_kind(&self, array: &mut DeArray<'_>, kind: &str, step: &Step) -> Result<usize, Problem> {
        let found: Vec<usize> = (0..array.len()).filter(|&i| is_of_kind(array[i].get_ref(), kind)).collect();
        match found.as_slice() {
            [one] => Ok(*one),
            [] if KINDS.contains(&self.so_far.as_str()) => {
                let named = |text: &str| Spanned::new(step.span.clone(), Cow::Owned(text.to_owned()));
                let mut entry = DeTable::new();
                let text = DeValue::String(Cow::Owned(kind.to_owned()));
                entry.insert(named("kind"), Spanned::new(step.span.clone(), text));
                array.push(Spanned::new(step.span.clone(), DeValue::Table(entry)));
                Ok(array.len() - 1)
            }
            [] => {
                let message =
                    format!("{} is an array: {} is no index of it", self.so_far, suggest::quoted(kind));
                Err(self.refuse(step, "type", message, "entries have indices, counted from 0: key[0]"))
            }
            many => {
                let path = &self.so_far;
                let message =
                    format!("{} entries of {path} are of the kind {}", many.len(), suggest::quoted(kind));
                let known: Vec<_> = many.iter().map(|i| format!("{path}[{i}]")).collect();
                Err(self.refuse(step, "ambiguous-key", message, &format!("one of {}", known.join(", "))))
            }
        }
    }
}

/// The text of the file of `source` after `changes` that were made to it before without an error, with its comments.
pub(crate) fn edited(source: &Source, changes: &[Change]) -> DocumentMut {
    let mut document: DocumentMut = source.text.parse().unwrap_or_default();
    let with = source.with(changes);
    let (mut root, _) = DeTable::parse_recoverable(with.of_file());
    for (change, at) in changes.iter().zip(with.changes()) {
        let Ok(turns) = change.apply(root.get_mut(), at, &with) else { continue };
        let text = &change.text[change.value.clone()];
        let value: Value = text.parse().unwrap_or_else(|_| text.into());
        let mut item = document.as_item_mut();
        for turn in turns {
            item = match turn {
                Turn::Key(key) => &mut item[key.as_str()],
                Turn::Entry(index) => &mut item[index],
                Turn::New(kind) => {
                    if item.is_none() {
                        *item = Item::ArrayOfTables(ArrayOfTables::new());
                    }
                    let mut entry = Table::new();
                    entry.insert("kind", kind.into());
                    let Some(entries) = item.as_array_of_tables_mut() else { break };
                    entries.push(entry);
                    let last = entries.len() - 1;
                    &mut item[last]
                }
            };
        }
        *item = Item::Value(value);
    }
    document
}
