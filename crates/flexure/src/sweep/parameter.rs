//! A key of a scenario that a sweep changes, and its values.

use std::fmt;

use flexure_core::scalar::Scalar;
use serde::Serialize;

use crate::files::change::Numbers;
use crate::files::{Change, Problem};
use crate::units::{self, Unit};

/// What changes made here are called in messages.
pub(super) const PARAMETERS: &str = "[parameters]";

/// A key of a scenario, or with `robot.` of its robot's file, and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The key, dotted, as `--set` takes it: a column of the rows.
    pub key: String,
    /// Its values.
    pub values: Values,
    /// Whether they are factors on what the file says there.
    pub relative: bool,
    /// The keys that factors are on, and what the file says there; none for values.
    pub(super) base: Vec<(String, Numbers)>,
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers between two others.
    Between {
        /// One end.
        from: f64,
        /// The other end.
        to: f64,
        /// Whether equal factors, not equal differences, are equally far.
        logarithmic: bool,
        /// How many a grid has.
        points: u64,
    },
    /// These, each with its text in TOML: all of them numbers, or none.
    Listed(Vec<(Value, String)>),
}

/// A value of a parameter: what stands in the column.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text, a truth or an array, as TOML has it, without quotes.
    Text(String),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) => x.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl Parameter {
    /// Values on a grid.
    pub fn count(&self) -> u64 {
        match &self.values {
            Values::Between { points, .. } => *points,
            Values::Listed(values) => values.len() as u64,
        }
    }

    /// The unit of its numbers; empty for factors, and where none is known.
    pub fn unit(&self) -> &'static str {
        let known = Unit::of_key(self.key.split('[').next().unwrap_or_default());
        // What is wrong with a robot is told in parts of its numbers; times are times everywhere.
        let is_part = |unit: &Unit| self.key.starts_with("imperfection") && *unit != units::TIME;
        known.filter(|unit| !self.relative && !is_part(unit)).map_or("", |unit| unit.plain)
    }

    /// Whether its column has numbers.
    pub fn is_number(&self) -> bool {
        match &self.values {
            Values::Between { .. } => true,
            Values::Listed(values) => values.iter().all(|(value, _)| matches!(value, Value::Number(_))),
        }
    }

    /// The value `number` of a grid.
    pub(super) fn on_grid(&self, number: u64) -> Value {
        match &self.values {
            Values::Between { from, points: 1, .. } => Value::Number(*from),
            Values::Between { to, points, .. } if number + 1 == *points => Value::Number(*to),
            Values::Between { points, .. } => self.along(number as f64 / (points - 1) as f64),
            Values::Listed(values) => values[usize::try_from(number).unwrap_or(0)].0.clone(),
        }
    }

    /// The value at a part from [0, 1) of the way.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from [0, length)")]
    pub(super) fn along(&self, part: f64) -> Value {
        match &self.values {
            Values::Between { from, to, logarithmic: false, .. } => Value::Number(from + (to - from) * part),
            Values::Between { from, to, logarithmic: true, .. } => {
                let ratio: f64 = to / from;
                Value::Number(from * Scalar::exp(Scalar::ln(ratio) * part))
            }
            Values::Listed(values) => {
                let number = (part * values.len() as f64) as usize;
                values[number.min(values.len() - 1)].0.clone()
            }
        }
    }

    /// Its least and largest value, or all that are listed.
    pub(super) fn ends(&self) -> Vec<Value> {
        match &self.values {
            Values::Between { from, to, .. } => vec![Value::Number(*from), Value::Number(*to)],
            Values::Listed(values) => values.iter().map(|(value, _)| value.clone()).collect(),
        }
    }

    /// The changes of the scenario that give it this value.
    ///
    /// # Errors
    /// If the key is none.
    pub(super) fn changes(&self, value: &Value) -> Result<Vec<Change>, Problem> {
        let change = |key: &str, text: &str| Change::parse_from(PARAMETERS, &format!("{key} = {text}"));
        match (value, self.base.as_slice()) {
            (Value::Number(x), []) => Ok(vec![change(&self.key, &decimal(*x))?]),
            (Value::Number(x), base) => {
                let times = |(key, base): &(String, Numbers)| match base {
                    Numbers::One(base) => change(key, &decimal(x * base)),
                    Numbers::Array(base) => {
                        let entries: Vec<String> = base.iter().map(|base| decimal(x * base)).collect();
                        change(key, &format!("[{}]", entries.join(", ")))
                    }
                };
                base.iter().map(times).collect()
            }
            (Value::Text(text), _) => {
                // As it was written, with its quotes.
                let written = match &self.values {
                    Values::Listed(values) => values.iter().find(|(listed, _)| listed == value),
                    Values::Between { .. } => None,
                };
                Ok(vec![change(&self.key, written.map_or(text, |(_, text)| text))?])
            }
        }
    }
}

/// The fewest digits that restore `x`; whole numbers without a point, which keys of whole numbers take, too.
fn decimal(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::{Parameter, Value, Values};
    use crate::files::change::Numbers;

    fn between(from: f64, to: f64, logarithmic: bool, points: u64) -> Parameter {
        let values = Values::Between { from, to, logarithmic, points };
        Parameter { key: "a.b".to_owned(), values, relative: false, base: Vec::new() }
    }

    fn number(value: &Value) -> f64 {
        match value {
            Value::Number(x) => *x,
            Value::Text(text) => panic!("{text} is no number"),
        }
    }

    /// Ends are the ends to the bit; between them differences or factors are equal.
    #[test]
    fn grids_are_even() {
        let values = |parameter: &Parameter| -> Vec<f64> {
            (0..parameter.count()).map(|i| number(&parameter.on_grid(i))).collect()
        };
        let (linear, logarithmic) =
            (values(&between(0.1, 0.7, false, 4)), values(&between(1e-3, 10.0, true, 5)));
        let ends = [linear[0], linear[3], logarithmic[0], logarithmic[4]].map(f64::to_bits);
        assert_eq!(ends, [0.1, 0.7, 1e-3, 10.0].map(f64::to_bits));
        assert!(linear.windows(2).all(|pair| (pair[1] - pair[0] - 0.2).abs() < 1e-15));
        assert!(logarithmic.windows(2).all(|pair| (pair[1] / pair[0] - 10.0).abs() < 1e-12));
        assert_eq!(values(&between(3.0, 4.0, false, 1)).len(), 1);
    }

    #[test]
    fn values_become_changes() {
        let text = |parameter: &Parameter, value| parameter.changes(&value).unwrap()[0].text().to_owned();
        let mut parameter = between(0.0, 1.0, false, 2);
        assert_eq!(text(&parameter, Value::Number(0.1 + 0.2)), "a.b = 0.30000000000000004");
        assert_eq!(text(&parameter, Value::Number(3.0)), "a.b = 3");
        parameter.base = vec![("a.b".to_owned(), Numbers::Array(vec![9.0, 4.0]))];
        assert_eq!(text(&parameter, Value::Number(0.5)), "a.b = [4.5, 2]");
        let listed = ["pd", "vcbc"].map(|text| (Value::Text(text.to_owned()), format!("{text:?}"))).to_vec();
        let parameter = Parameter { values: Values::Listed(listed), base: Vec::new(), ..parameter };
        assert_eq!(parameter.along(0.6), Value::Text("vcbc".to_owned()));
        assert_eq!(text(&parameter, parameter.on_grid(0)), "a.b = \"pd\"");
    }
}
