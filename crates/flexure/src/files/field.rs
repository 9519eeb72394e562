//! One value of a TOML document, with its path, its place and the log: the one mechanism that validates numbers.

use std::borrow::Cow;
use std::ops::Deref;

use toml::de::{DeArray, DeValue};

use crate::files::decimals::Decimals;
use crate::files::quantity::Quantity;
use crate::files::site::Site;
use crate::files::suggest;
use crate::files::table::Table;

/// A value at its key.
#[derive(Clone, Debug)]
pub(crate) struct Field<'a> {
    pub value: &'a DeValue<'a>,
    pub site: Site<'a>,
}

impl<'a> Deref for Field<'a> {
    type Target = Site<'a>;

    fn deref(&self) -> &Site<'a> {
        &self.site
    }
}

/// How many numbers a per-joint array has, and whose joints they are.
#[derive(Clone, Debug)]
pub(crate) struct Joints {
    /// None if the robot could not be read: then any length goes.
    pub count: Option<usize>,
    pub robot: String,
}

impl Joints {
    pub fn expected(&self) -> String {
        let robot = &self.robot;
        match self.count {
            Some(1) => format!("1 number expected, {robot} has one joint"),
            Some(n) => format!("{n} numbers expected, one per joint of {robot}"),
            None => format!("one number per joint of {robot} expected"),
        }
    }
}

impl<'a> Field<'a> {
    fn wrong_type(&self, expected: &str, help: impl Into<String>) {
        let found = match self.value {
            DeValue::String(_) => "text",
            DeValue::Integer(_) | DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.error("type", format!("{} is {found}, must be {expected}", self.path), help);
    }

    /// The number, if it is one and nothing but doubt speaks against it.
    pub fn number(&self, quantity: &Quantity) -> Option<f64> {
        let decimal = match self.value {
            // Any integer is meant as a number; those in hexadecimal are small enough or refused.
            DeValue::Integer(integer) if integer.radix() == 10 => Some(Cow::Borrowed(integer.as_str())),
            DeValue::Integer(integer) => {
                let exact = i64::from_str_radix(integer.as_str(), integer.radix());
                exact.ok().map(|exact| Cow::Owned(exact.to_string()))
            }
            DeValue::Float(float) => Some(Cow::Borrowed(float.as_str())),
            _ => None,
        };
        let parsed = decimal.and_then(|decimal| Some((decimal.parse().ok()?, decimal)));
        let Some((x, decimal)) = parsed else {
            self.wrong_type("a number", quantity.described());
            return None;
        };
        self.log.note(Decimals::of(&decimal, x));
        self.log.accept(&self.path, x, quantity, self.span.clone())
    }

    /// Whether text stands here.
    pub fn is_text(&self) -> bool {
        matches!(self.value, DeValue::String(_))
    }

    /// Whether `nan` stands here, for a number that is still to be supplied.
    pub fn is_nan(&self) -> bool {
        is_nan(self.value)
    }

    /// Where `nan` stands in the array here.
    pub fn nans(&self) -> Vec<usize> {
        let DeValue::Array(array) = self.value else { return Vec::new() };
        let nan = array.iter().enumerate().filter(|(_, entry)| is_nan(entry.get_ref()));
        nan.map(|(i, _)| i).collect()
    }

    /// The whole number from `least` to `most`, called `what` in hints.
    pub fn whole(&self, what: &str, least: u64, most: u64) -> Option<u64> {
        let expected = format!("a whole number from {least} to {most}");
        let DeValue::Integer(integer) = self.value else {
            self.wrong_type(&expected, what);
            return None;
        };
        let number = i128::from_str_radix(integer.as_str(), integer.radix()).ok();
        let found = number.and_then(|x| u64::try_from(x).ok()).filter(|x| (least..=most).contains(x));
        if found.is_none() {
            let shown = number.map_or_else(|| "beyond all bounds".to_owned(), |x| x.to_string());
            self.error("range", format!("{} is {shown}, must be {expected}", self.path), what);
        }
        found
    }

    fn entries(&self, array: &'a DeArray<'a>) -> impl Iterator<Item = Field<'a>> {
        array.iter().enumerate().map(|(i, entry)| Field {
            value: entry.get_ref(),
            site: Site { span: entry.span(), path: format!("{}[{i}]", self.path), log: self.log },
        })
    }

    /// Every number of `array`, all of them checked.
    fn checked(&self, array: &'a DeArray<'a>, quantity: &Quantity) -> Option<Vec<f64>> {
        let numbers: Vec<_> = self.entries(array).map(|entry| entry.number(quantity)).collect();
        numbers.into_iter().collect()
    }

    /// One number per joint; a single number stands for all of them.
    pub fn per_joint(&self, joints: &Joints, quantity: &Quantity) -> Option<Vec<f64>> {
        let DeValue::Array(array) = self.value else {
            let x = self.number(quantity)?;
            return joints.count.map(|n| vec![x; n]);
        };
        if joints.count.is_some_and(|n| n != array.len()) {
            let message = format!("{}: {}; got {}", self.path, joints.expected(), array.len());
            self.error(
                "length",
                message,
                format!("{}; a single number stands for all joints", quantity.described()),
            );
            return None;
        }
        self.checked(array, quantity)
    }

    /// Exactly `N` numbers, called `entries` in messages.
    pub fn array<const N: usize>(&self, quantity: &Quantity, entries: &str) -> Option<[f64; N]> {
        let DeValue::Array(array) = self.value else {
            self.wrong_type(
                &format!("an array of {N} numbers"),
                format!("[{entries}], {}", quantity.described()),
            );
            return None;
        };
        if array.len() != N {
            let message = format!("{}: {N} numbers expected ({entries}); got {}", self.path, array.len());
            self.error("length", message, quantity.described());
            return None;
        }
        self.checked(array, quantity)?.try_into().ok()
    }

    /// The text, which must not be empty.
    pub fn text(&self) -> Option<&'a str> {
        match self.value {
            DeValue::String(text) if !text.trim().is_empty() => Some(text),
            DeValue::String(_) => {
                self.error("empty", format!("{} is empty", self.path), "write some text between the quotes");
                None
            }
            _ => {
                self.wrong_type("text", "text stands in quotes");
                None
            }
        }
    }

    /// The entries of an array.
    pub fn each(&self) -> Option<Vec<Field<'a>>> {
        let DeValue::Array(array) = self.value else {
            self.wrong_type("an array", "like [1.0, 2.0]");
            return None;
        };
        Some(self.entries(array).collect())
    }

    /// The value as it is written.
    pub fn text_of(&self) -> &str {
        self.log.source.text.get(self.span.clone()).unwrap_or_default()
    }

    /// Whether an array stands here.
    pub fn is_array(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    /// The texts of an array, none of them empty.
    pub fn texts(&self) -> Option<Vec<String>> {
        let DeValue::Array(array) = self.value else {
            self.wrong_type("an array of texts", "like [\"a\", \"b\"]");
            return None;
        };
        let texts: Vec<_> = self.entries(array).map(|entry| entry.text().map(str::to_owned)).collect();
        texts.into_iter().collect()
    }

    /// True or false.
    pub fn boolean(&self) -> Option<bool> {
        let DeValue::Boolean(value) = self.value else {
            self.wrong_type("true or false", "without quotes");
            return None;
        };
        Some(*value)
    }

    /// The one of `options` that is named here.
    pub fn choice<T: Copy>(&self, options: &[(&str, T)]) -> Option<T> {
        let text = self.text()?;
        let found = options.iter().find(|(name, _)| *name == text).map(|&(_, value)| value);
        if found.is_none() {
            let message = format!("{} is {}, which is not known", self.path, suggest::quoted(text));
            self.error("unknown-name", message, suggest::hint(text, options.iter().map(|&(name, _)| name)));
        }
        found
    }

    /// The table here, with no keys but the `known` ones.
    pub fn table(&self, known: &[&str]) -> Option<Table<'a>> {
        let table = self.any_table()?;
        table.refuse_unknown(known);
        Some(table)
    }

    /// The table here, whatever its keys.
    pub fn any_table(&self) -> Option<Table<'a>> {
        let DeValue::Table(entries) = self.value else {
            self.wrong_type("a table", format!("write it as [{}] with keys below", self.path));
            return None;
        };
        Some(Table::new(entries, self.path.clone(), self.span.clone(), self.log))
    }

    /// The entries of an array of tables, which must have some.
    pub fn tables(&self) -> Option<Vec<Field<'a>>> {
        match self.value {
            DeValue::Array(array) if !array.is_empty() => Some(self.entries(array).collect()),
            _ => {
                self.wrong_type("an array of tables", format!("write [[{}]], once for each", self.path));
                None
            }
        }
    }
}

fn is_nan(value: &DeValue<'_>) -> bool {
    matches!(value, DeValue::Float(float) if float.as_str().trim_start_matches(['+', '-']) == "nan")
}
