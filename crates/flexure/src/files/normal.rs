//! What a file says, in one spelling: two files that say the same have the same text here, whatever their comments, blanks,
//! spelling of numbers and order of keys. The text is JSON as RFC 8785 has it; `docs/certificate.md` states what stands in it.

use std::collections::BTreeMap;
use std::fmt::Write;

use toml::de::{DeTable, DeValue};

/// A value in its one spelling.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Normal {
    Truth(bool),
    /// A finite number, as the nearest double.
    Number(f64),
    Text(String),
    List(Vec<Normal>),
    Table(BTreeMap<String, Normal>),
}

/// Whole numbers beyond are no doubles: they are texts.
const LARGEST_WHOLE: i128 = 1 << 53;

impl Normal {
    /// A number of a file; what is not finite is a text.
    pub fn number(x: f64) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Text(x.to_string()) }
    }

    /// A table of a TOML file at `path`. What `contents` has for a path stands there instead: the content of a file that is
    /// named there.
    pub fn table(table: &DeTable<'_>, path: &str, contents: &BTreeMap<String, Self>) -> Self {
        let entry = |(key, value): (_, &toml::Spanned<DeValue<'_>>)| {
            let key: &toml::Spanned<std::borrow::Cow<'_, str>> = key;
            let key = key.get_ref();
            let path = if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
            (key.to_string(), Self::value(value.get_ref(), &path, contents))
        };
        Self::Table(table.iter().map(entry).collect())
    }

    fn value(value: &DeValue<'_>, path: &str, contents: &BTreeMap<String, Self>) -> Self {
        if let Some(content) = contents.get(path) {
            return content.clone();
        }
        match value {
            DeValue::String(text) => Self::Text(text.to_string()),
            DeValue::Boolean(truth) => Self::Truth(*truth),
            DeValue::Integer(integer) => match i128::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(whole) if whole.abs() <= LARGEST_WHOLE => Self::Number(whole as f64),
                Ok(whole) => Self::Text(whole.to_string()),
                Err(_) => Self::Text(integer.as_str().to_owned()),
            },
            DeValue::Float(float) => {
                float.as_str().parse().map_or_else(|_| Self::Text(float.as_str().to_owned()), Self::number)
            }
            DeValue::Datetime(date) => Self::Text(date.to_string()),
            DeValue::Array(array) => {
                let entry = |(i, entry): (usize, &toml::Spanned<DeValue<'_>>)| {
                    Self::value(entry.get_ref(), &format!("{path}[{i}]"), contents)
                };
                Self::List(array.iter().enumerate().map(entry).collect())
            }
            DeValue::Table(table) => Self::table(table, path, contents),
        }
    }

    /// Without these keys.
    pub fn without(mut self, keys: &[&str]) -> Self {
        if let Self::Table(entries) = &mut self {
            entries.retain(|key, _| !keys.contains(&key.as_str()));
        }
        self
    }

    /// Without a key that has the value that it would have without being there.
    pub fn without_default(mut self, key: &str, default: &Self) -> Self {
        if let Self::Table(entries) = &mut self {
            entries.retain(|own, value| own != key || value != default);
        }
        self
    }

    /// The text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text);
        text
    }

    fn write(&self, to: &mut String) {
        match self {
            Self::Truth(truth) => to.push_str(if *truth { "true" } else { "false" }),
            Self::Number(x) => to.push_str(&decimal(*x)),
            Self::Text(text) => to.push_str(&serde_json::Value::from(text.as_str()).to_string()),
            Self::List(list) => {
                to.push('[');
                for (i, entry) in list.iter().enumerate() {
                    if i > 0 {
                        to.push(',');
                    }
                    entry.write(to);
                }
                to.push(']');
            }
            Self::Table(entries) => {
                to.push('{');
                for (i, (key, entry)) in entries.iter().enumerate() {
                    if i > 0 {
                        to.push(',');
                    }
                    to.push_str(&serde_json::Value::from(key.as_str()).to_string());
                    to.push(':');
                    entry.write(to);
                }
                to.push('}');
            }
        }
    }

    /// SHA-256 of the text, in hexadecimal.
    pub fn digest(&self) -> String {
        hexadecimal(hmac_sha256::Hash::hash(self.text().as_bytes()))
    }
}

/// A hash in digits.
pub(crate) fn hexadecimal(bytes: [u8; 32]) -> String {
    let mut digits = String::new();
    for byte in bytes {
        // Writing to a text does not fail.
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

/// The fewest digits that restore `x`, laid out as ECMAScript does.
fn decimal(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if (1e-6..1e21).contains(&x.abs()) {
        return x.to_string();
    }
    let text = format!("{x:e}");
    if text.contains("e-") { text } else { text.replace('e', "e+") }
}

#[cfg(test)]
mod tests {
    use toml::de::DeTable;

    use super::Normal;

    fn normal(text: &str) -> Normal {
        let table = DeTable::parse(text).expect("TOML");
        Normal::table(table.get_ref(), "", &[("deep[1].file".to_owned(), Normal::Number(7.0))].into())
    }

    #[test]
    fn spelling_and_order_are_left_behind() {
        let one = "b = 1 # a comment\na = [0.10, 1e3, -0.0]\n[t]\nx = 'y'\n[[deep]]\n[[deep]]\nfile = 'p'\n";
        let other = "a = [1e-1, 1_000, 0]\nb = 1.0\ndeep = [{}, {file = \"q\"}]\nt.x = \"y\"\n";
        let text = r#"{"a":[0.1,1000,0],"b":1,"deep":[{},{"file":7}],"t":{"x":"y"}}"#;
        assert_eq!((normal(one).text().as_str(), normal(other).text().as_str()), (text, text));
        assert_ne!(normal("a = 1").text(), normal("a = '1'").text());
    }

    /// The layouts of RFC 8785, appendix B, and what JSON has no number for.
    #[test]
    fn numbers_have_one_layout() {
        let text = "a = [333333333.33333329, 1e30, 4.50, 2e-3, 1e-27, 1e-6, 1e-7, 1e21, 1e20, 5e-324, inf, 9223372036854775807, 0x10]";
        let laid_out = r#"{"a":[333333333.3333333,1e+30,4.5,0.002,1e-27,0.000001,1e-7,1e+21,100000000000000000000,5e-324,"inf","9223372036854775807",16]}"#;
        assert_eq!(normal(text).text(), laid_out);
    }

    /// SHA-256 of "{}" from elsewhere.
    #[test]
    fn the_digest_is_sha_256() {
        let digest = normal("").digest();
        assert_eq!(digest, "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a");
    }
}
