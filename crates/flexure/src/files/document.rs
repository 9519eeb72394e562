//! A TOML document while it is read: its text, the problems found so far, and where every key stands.

use std::cell::{Cell, Ref, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use crate::files::bounds;
use crate::files::change::Change;
use crate::files::decimals::Decimals;
use crate::files::diagnostic::{Problem, Problems};
use crate::files::normal::Normal;
use crate::files::quantity::Quantity;
use crate::files::source::Source;
use crate::files::table::Table;

/// Errors beyond these are not reported, nor are warnings beyond as many: nobody reads them.
const MOST_PROBLEMS: usize = 24;

/// Where problems are noted while a file is read.
#[derive(Debug)]
pub(crate) struct Log {
    pub source: Source,
    problems: RefCell<Vec<Problem>>,
    decimals: Cell<Decimals>,
    contents: RefCell<BTreeMap<String, Normal>>,
}

impl Log {
    pub fn new(source: &Source) -> Self {
        Self {
            source: source.clone(),
            problems: RefCell::default(),
            decimals: Cell::default(),
            contents: RefCell::default(),
        }
    }

    /// Notes `problem` as it is.
    pub fn push(&self, problem: Problem) {
        if self.count(problem.is_warning()) < MOST_PROBLEMS {
            self.problems.borrow_mut().push(problem);
        }
    }

    /// What the numbers read so far were read from.
    pub fn decimals(&self) -> Decimals {
        self.decimals.get()
    }

    /// Notes what other numbers were read from.
    pub fn note(&self, decimals: Decimals) {
        self.decimals.set(self.decimals.get().and(decimals));
    }

    /// Notes what stands in the file that is named at `path`.
    pub fn contain(&self, path: &str, content: Normal) {
        self.contents.borrow_mut().insert(path.to_owned(), content);
    }

    /// What stands in the files named so far, by the path of the key that names it.
    pub fn contents(&self) -> Ref<'_, BTreeMap<String, Normal>> {
        self.contents.borrow()
    }

    /// Warnings, or errors, noted so far.
    fn count(&self, warnings: bool) -> usize {
        self.problems.borrow().iter().filter(|problem| problem.is_warning() == warnings).count()
    }

    /// Whether something is wrong.
    fn has_errors(&self) -> bool {
        self.count(false) > 0
    }

    /// Whether more errors would go unreported.
    pub fn is_full(&self) -> bool {
        self.count(false) >= MOST_PROBLEMS
    }

    /// Notes what another file's log finished with, and gives its value.
    pub fn absorb<T>(&self, finished: Result<(T, Vec<Problem>), Problems>) -> Option<T> {
        let (value, problems) = match finished {
            Ok((value, warnings)) => (Some(value), warnings),
            Err(problems) => (None, problems.into_iter().collect()),
        };
        for problem in problems {
            self.push(problem);
        }
        value
    }

    /// Notes an error at `span`.
    pub fn error(
        &self,
        span: Range<usize>,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push(Problem::new(code, message, help).at(&self.source, span));
    }

    /// The number `x` called `name`, unless something worse than doubt speaks against it.
    pub fn accept(&self, name: &str, x: f64, quantity: &Quantity, span: Range<usize>) -> Option<f64> {
        let Some(problem) = quantity.objection(name, x) else { return Some(x) };
        let usable = problem.is_warning();
        self.push(problem.at(&self.source, span));
        usable.then_some(x)
    }

    /// The value if there was no error, with the warnings.
    pub fn finish<T>(self, value: Option<T>) -> Result<(T, Vec<Problem>), Problems> {
        let source = self.source;
        let warnings = Problems::or_warnings(self.problems.into_inner())?;
        match value {
            Some(value) => Ok((value, warnings)),
            None => Err(Problem::new(
                "invalid",
                "the file cannot be used",
                "this is a bug of the reader: report it",
            )
            .at(&source, 0..0)
            .into()),
        }
    }
}

/// A kind of file.
pub(crate) struct Form {
    /// What it is called in messages.
    pub what: &'static str,
    /// Keys that must be there.
    pub required: &'static [&'static str],
    /// Keys that may be there.
    pub optional: &'static [&'static str],
    /// A key of the other kind of file, what that is called, and what to do with it instead.
    pub other: (&'static str, &'static str, &'static str),
}

impl Form {
    /// Notes an error if there is nothing in the file, or if it is of the other kind.
    fn refuse_stranger(&self, root: &DeTable<'_>, log: &Log) -> bool {
        let required = self.required.join(", ");
        let (key, other, instead) = self.other;
        if root.is_empty() && !self.required.is_empty() {
            let message = format!("missing keys {required}: the file is empty");
            log.error(
                0..0,
                "empty",
                message,
                format!("a {} has at least these keys; is it the right file?", self.what),
            );
        } else if let Some((found, _)) =
            root.get_key_value(key).filter(|_| !self.required.iter().any(|own| root.contains_key(*own)))
        {
            let message = format!("this is a {other}, must be a {}", self.what);
            log.error(found.span(), "wrong-kind", message, instead);
        } else {
            return false;
        }
        true
    }
}

/// Reads `source` as TOML, makes the `changes` and hands the root table to `read`.
pub(crate) fn parse<T>(
    source: &Source,
    changes: &[Change],
    form: &Form,
    read: impl FnOnce(&Table<'_>, &Places) -> Option<T>,
) -> Result<(T, Vec<Problem>), Problems> {
    let source = &source.with(changes);
    let log = Log::new(source);
    if source.of_file().trim_start().starts_with('<') {
        let message = format!("this is XML; a {} is TOML", form.what);
        let help = "a URDF has no springs and no motors: `flexure import robot.urdf > robot.toml` writes a robot file \
                    to complete";
        log.error(0..0, "wrong-kind", message, help);
        return log.finish(None);
    }
    if let Some((span, objection)) = bounds::objection(source.of_file()) {
        let help = format!("a {} is far smaller: is it the right file?", form.what);
        log.error(span, "huge", objection, help);
        return log.finish(None);
    }
    let (mut root, errors) = DeTable::parse_recoverable(source.of_file());
    for error in distinct(&errors) {
        let help =
            "not valid TOML: text stands in quotes, numbers like 0.5, arrays like [1.0, 2.0], one key a line";
        log.error(error.span().unwrap_or(0..0), "syntax", error.message(), help);
    }
    if !errors.is_empty() {
        return log.finish(None);
    }
    if form.refuse_stranger(root.get_ref(), &log) {
        return log.finish(None);
    }
    for (change, at) in changes.iter().zip(source.changes()) {
        if let Err(problem) = change.apply(root.get_mut(), at, source) {
            log.push(problem);
        }
    }
    if log.has_errors() {
        return log.finish(None);
    }
    let places = Places::of(source, root.get_ref());
    let table = Table::new(root.get_ref(), String::new(), 0..0, &log);
    table.refuse_unknown(&[form.required, form.optional].concat());
    let value = read(&table, &places);
    log.finish(value)
}

/// The first errors that differ: one slip in nested brackets is reported once for each of them.
fn distinct(errors: &[Error]) -> Vec<&Error> {
    let same = |a: &Error, b: &Error| a.message() == b.message() && a.span() == b.span();
    let mut kept: Vec<&Error> = Vec::new();
    for error in errors {
        if kept.len() < MOST_PROBLEMS && !kept.iter().any(|other| same(other, error)) {
            kept.push(error);
        }
    }
    kept
}

/// Where the keys of a file stand: to report what only shows once the file is used.
#[derive(Clone, Debug)]
pub struct Places {
    source: Source,
    spans: BTreeMap<String, Range<usize>>,
}

impl Places {
    pub(super) fn of(source: &Source, root: &DeTable<'_>) -> Self {
        let mut places = Self { source: source.clone(), spans: BTreeMap::new() };
        places.visit("", root);
        places
    }

    fn visit(&mut self, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            let key = key.get_ref();
            self.enter(if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }, value);
        }
    }

    fn enter(&mut self, path: String, value: &Spanned<DeValue<'_>>) {
        match value.get_ref() {
            DeValue::Table(table) => self.visit(&path, table),
            DeValue::Array(array) if array.iter().any(|entry| entry.get_ref().is_table()) => {
                for (i, entry) in array.iter().enumerate() {
                    self.enter(format!("{path}[{i}]"), entry);
                }
            }
            _ => {}
        }
        self.spans.insert(path, value.span());
    }

    /// Name of the file.
    pub fn file(&self) -> &str {
        &self.source.name
    }

    /// Whether the file gives `key`, dotted.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.spans.contains_key(key)
    }

    /// Where the value of `key`, dotted, stands in the text.
    pub(crate) fn span(&self, key: &str) -> Option<Range<usize>> {
        self.spans.get(key).cloned()
    }

    /// The file, or the change, in which the value of `key`, dotted, stands, and where.
    pub(crate) fn origin(&self, key: &str) -> Option<(Source, Range<usize>)> {
        self.span(key).map(|span| self.source.part_with(span))
    }

    /// Dotted keys with where their values stand.
    pub(super) fn spans(&self) -> impl Iterator<Item = (&str, &Range<usize>)> {
        self.spans.iter().map(|(key, span)| (key.as_str(), span))
    }

    /// A problem at `key` (dotted, like `reference.amplitude` or `links.joint[2].mass`), or at the start of the file if
    /// there is no such key. `code` is one word; `help` says what to do.
    pub fn problem(
        &self,
        key: &str,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Problem {
        Problem::new(code, message, help).at(&self.source, self.spans.get(key).cloned().unwrap_or(0..0))
    }

    /// Dotted keys with their text, those inside `[sources]` apart.
    pub(crate) fn keys(&self) -> impl Iterator<Item = (&str, &str)> {
        self.spans.iter().filter_map(|(key, span)| Some((key.as_str(), self.source.text.get(span.clone())?)))
    }
}
