//! A table of a TOML document: which keys it may have, and reading them.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::files::decimals::Decimals;
use crate::files::document::Log;
use crate::files::field::{Field, Joints};
use crate::files::normal::Normal;
use crate::files::quantity::Quantity;
use crate::files::site::Site;
use crate::files::suggest;

/// A table, and the log that its problems go to.
///
/// Every reader returns `None` after it has noted what is wrong.
#[derive(Clone, Debug)]
pub(crate) struct Table<'a> {
    entries: &'a DeTable<'a>,
    path: String,
    span: Range<usize>,
    log: &'a Log,
}

impl<'a> Table<'a> {
    pub fn new(entries: &'a DeTable<'a>, path: String, span: Range<usize>, log: &'a Log) -> Self {
        Self { entries, path, span, log }
    }

    /// What the numbers of the file that were read so far were read from.
    pub fn decimals(&self) -> Decimals {
        self.log.decimals()
    }

    /// What the table says, with the content of the files that it names: after it was read.
    pub fn normal(&self) -> Normal {
        Normal::table(self.entries, &self.path, &self.log.contents())
    }

    /// Notes every key that is not in `known`.
    pub fn refuse_unknown(&self, known: &[&str]) {
        self.refuse_unknown_but(known, &[]);
    }

    /// Notes every key that is neither in `known` nor in `more`, which hints do not speak of.
    pub fn refuse_unknown_but(&self, known: &[&str], more: &[&str]) {
        let is_known = |key: &str| known.contains(&key) || more.contains(&key);
        for key in self.entries.keys().filter(|key| !is_known(key.get_ref())) {
            let message = match self.path.as_str() {
                "" => format!("unknown key {}", suggest::quoted(key.get_ref())),
                path => format!("unknown key {} in [{path}]", suggest::quoted(key.get_ref())),
            };
            self.log.error(
                key.span(),
                "unknown-key",
                message,
                suggest::hint(key.get_ref(), known.iter().copied()),
            );
        }
    }

    /// Notes an error about the table as a whole.
    pub fn error(&self, code: &'static str, message: impl Into<String>, help: impl Into<String>) {
        self.log.error(self.span.clone(), code, message, help);
    }

    /// The dotted path of `key` of this table.
    pub fn key(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn field(&self, key: &str, value: &'a Spanned<DeValue<'a>>) -> Field<'a> {
        let site = Site { span: value.span(), path: self.key(key), log: self.log };
        Field { value: value.get_ref(), site }
    }

    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        let value = self.entries.get(key)?;
        Some(self.field(key, value))
    }

    /// Every key with its value.
    pub fn fields(&self) -> impl Iterator<Item = (&'a str, Field<'a>)> {
        self.entries.iter().map(|(key, value)| {
            let key: &'a str = key.get_ref();
            (key, self.field(key, value))
        })
    }

    /// `Some(None)` without the key; `None` if its value is bad.
    #[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
    pub fn optional<T>(&self, key: &str, read: impl FnOnce(&Field<'a>) -> Option<T>) -> Option<Option<T>> {
        match self.get(key) {
            None => Some(None),
            Some(field) => read(&field).map(Some),
        }
    }

    /// The key, which must be there; `what` says in the hint what it is.
    pub fn required(&self, key: &str, what: &str) -> Option<Field<'a>> {
        let field = self.get(key);
        if field.is_none() {
            let place = if self.path.is_empty() { "the file".into() } else { format!("[{}]", self.path) };
            self.error(
                "missing-key",
                format!("missing key {}", self.key(key)),
                format!("add {key} to {place}: {what}"),
            );
        }
        field
    }

    pub fn number(&self, key: &str, quantity: &Quantity) -> Option<f64> {
        self.required(key, &quantity.described())?.number(quantity)
    }

    pub fn array<const N: usize>(&self, key: &str, quantity: &Quantity, entries: &str) -> Option<[f64; N]> {
        let what = format!("{N} numbers ({entries}), {}", quantity.described());
        self.required(key, &what)?.array(quantity, entries)
    }

    pub fn array_or<const N: usize>(
        &self,
        key: &str,
        quantity: &Quantity,
        entries: &str,
    ) -> Option<[f64; N]> {
        Some(self.optional(key, |field| field.array(quantity, entries))?.unwrap_or([0.0; N]))
    }

    pub fn per_joint(&self, key: &str, joints: &Joints, quantity: &Quantity) -> Option<Vec<f64>> {
        let what = format!("{}, {}", joints.expected(), quantity.described());
        self.required(key, &what)?.per_joint(joints, quantity)
    }

    /// Zero for every joint without the key.
    pub fn per_joint_or_zero(&self, key: &str, joints: &Joints, quantity: &Quantity) -> Option<Vec<f64>> {
        match self.get(key) {
            Some(field) => field.per_joint(joints, quantity),
            None => joints.count.map(|n| vec![0.0; n]),
        }
    }

    /// The name chosen at `key` among `options`.
    pub fn choice<T: Copy>(&self, key: &str, options: &[(&str, T)]) -> Option<T> {
        let names = options.iter().map(|&(name, _)| name).collect::<Vec<_>>().join(", ");
        self.required(key, &format!("one of {names}"))?.choice(options)
    }
}
