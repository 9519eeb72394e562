//! States files: JSON Lines, one state a line.

use std::fmt;
use std::io::BufRead;

use serde::de::{self, DeserializeSeed, MapAccess, Visitor};

use super::diagnostic::Problem;
use super::source::Source;
use super::suggest;

/// Longest line that is read [bytes].
const LONGEST: usize = 1 << 20;

/// A time, a state and perhaps a torque; one number per joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateRow {
    /// Time [s]; 0 if not given.
    pub t: f64,
    /// Link positions [rad].
    pub q_l: Vec<f64>,
    /// Motor positions [rad].
    pub q_m: Vec<f64>,
    /// Link velocities [rad/s].
    pub dq_l: Vec<f64>,
    /// Motor velocities [rad/s].
    pub dq_m: Vec<f64>,
    /// Motor torques [N m].
    pub u_m: Option<Vec<f64>>,
}

/// The states in a stream, one by one; after an error the next line goes on. Blank lines are skipped.
#[derive(Debug)]
pub struct States<R> {
    reader: R,
    joints: usize,
    name: String,
    line: usize,
    broken: bool,
}

impl<R: BufRead> States<R> {
    /// The states in `reader` of a robot with `joints` joints; `name` stands for the file in messages.
    pub fn new(reader: R, joints: usize, name: impl Into<String>) -> Self {
        Self { reader, joints, name: name.into(), line: 0, broken: false }
    }

    /// The next line that is not blank.
    fn next_line(&mut self) -> Option<Result<String, Problem>> {
        loop {
            self.line += 1;
            let mut bytes = Vec::new();
            let limit = LONGEST as u64 + 1;
            let read = std::io::Read::take(&mut self.reader, limit).read_until(b'\n', &mut bytes);
            let broken = match read {
                Ok(0) => return None,
                Ok(length) if length <= LONGEST => match String::from_utf8(bytes) {
                    Ok(line) if line.trim().is_empty() => continue,
                    Ok(line) => return Some(Ok(line)),
                    Err(_) => return Some(Err(self.problem("encoding", "", 0, "not UTF-8"))),
                },
                Ok(_) => self.problem("huge", "", 0, &format!("longer than {LONGEST} bytes")),
                Err(error) => self.problem("unreadable", "", 0, &format!("cannot be read: {error}")),
            };
            self.broken = true;
            return Some(Err(broken));
        }
    }

    /// A problem at the byte `column` (from 0) of the current `line`.
    fn problem(&self, code: &'static str, line: &str, column: usize, what: &str) -> Problem {
        let n = self.joints;
        let numbers = if n == 1 { "[one number]".into() } else { format!("[{n} numbers]") };
        let help = format!(
            "one JSON object a line with q_l, q_m, dq_l, dq_m = {numbers}, optional t (a number) and u_m = {numbers}"
        );
        let start = (0..=column.min(line.len())).rev().find(|&i| line.is_char_boundary(i)).unwrap_or(0);
        Problem::new(code, what, help).at(&Source::part(&self.name, line, self.line - 1), start..start)
    }
}

impl<R: BufRead> Iterator for States<R> {
    type Item = Result<StateRow, Problem>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.broken {
            return None;
        }
        let line = match self.next_line()? {
            Ok(line) => line,
            Err(problem) => return Some(Err(problem)),
        };
        let mut json = serde_json::Deserializer::from_str(&line);
        let row = Row { joints: self.joints }.deserialize(&mut json).and_then(|row| json.end().map(|()| row));
        Some(row.map_err(|error| {
            let text = error.to_string();
            let what = text.split(" at line ").next().unwrap_or_default();
            self.problem("state", &line, error.column().saturating_sub(1), what)
        }))
    }
}

/// One line, for a known number of joints.
struct Row {
    joints: usize,
}

const KEYS: &[&str] = &["t", "q_l", "q_m", "dq_l", "dq_m", "u_m"];

impl<'de> DeserializeSeed<'de> for Row {
    type Value = StateRow;
    fn deserialize<D: de::Deserializer<'de>>(self, deserializer: D) -> Result<StateRow, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Row {
    type Value = StateRow;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with q_l, q_m, dq_l and dq_m")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<StateRow, A::Error> {
        let mut time = None;
        let mut vectors: [Option<Vec<f64>>; 5] = Default::default();
        while let Some(key) = map.next_key::<String>()? {
            // The position travels in the message: serde_json finds it there again.
            let named = |error: A::Error| de::Error::custom(format!("{key}: {error}"));
            let position = KEYS.iter().position(|known| *known == key).ok_or_else(|| {
                let hint = suggest::hint(&key, KEYS.iter().copied());
                de::Error::custom(format!("unknown key {}: {hint}", suggest::quoted(&key)))
            })?;
            let repeated = || de::Error::custom(format!("{key} is given twice"));
            match position.checked_sub(1).and_then(|i| vectors.get_mut(i)) {
                None if time.is_some() => return Err(repeated()),
                None => time = Some(map.next_value().map_err(named)?),
                Some(Some(_)) => return Err(repeated()),
                Some(slot) => {
                    let numbers: Vec<f64> = map.next_value().map_err(named)?;
                    let (n, got) = (self.joints, numbers.len());
                    if got != n {
                        return Err(de::Error::custom(format!(
                            "{key}: {n} numbers expected, one per joint; got {got}"
                        )));
                    }
                    *slot = Some(numbers);
                }
            }
        }
        let [q_l, q_m, dq_l, dq_m, u_m] = vectors;
        let missing = |key: &'static str| move || de::Error::custom(format!("missing key {key}"));
        Ok(StateRow {
            t: time.unwrap_or(0.0),
            q_l: q_l.ok_or_else(missing("q_l"))?,
            q_m: q_m.ok_or_else(missing("q_m"))?,
            dq_l: dq_l.ok_or_else(missing("dq_l"))?,
            dq_m: dq_m.ok_or_else(missing("dq_m"))?,
            u_m,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Problems;
    use super::{StateRow, States};

    fn read(text: &str) -> Vec<Result<StateRow, String>> {
        let states = States::new(text.as_bytes(), 2, "s.jsonl");
        states.map(|row| row.map_err(|problem| Problems::from(problem).to_string())).collect()
    }

    #[test]
    fn good_lines_and_blank_ones() {
        let line =
            r#"{"q_l": [1, 2], "q_m": [3, 4], "dq_l": [5, 6], "dq_m": [7, 8.5], "u_m": [0, -1e3], "t": 0.5}"#;
        let rows = read(&format!("\n{line}\r\n   \n{line}"));
        assert_eq!(rows.len(), 2);
        let expected = StateRow {
            t: 0.5,
            q_l: vec![1.0, 2.0],
            q_m: vec![3.0, 4.0],
            dq_l: vec![5.0, 6.0],
            dq_m: vec![7.0, 8.5],
            u_m: Some(vec![0.0, -1e3]),
        };
        assert_eq!(rows, [Ok(expected.clone()), Ok(expected)]);
    }

    #[test]
    fn bad_lines_name_line_column_and_key() {
        let rest = r#""q_m": [3, 4], "dq_l": [5, 6], "dq_m": [7, 8]}"#;
        for (line, expected) in [
            (format!(r#"{{"q_l": [1, "x"], {rest}"#), "s.jsonl:3:16: q_l: invalid type: string"),
            (format!(r#"{{"q_l": [1], {rest}"#), "q_l: 2 numbers expected, one per joint; got 1"),
            (format!(r#"{{"q_l": [1, 1e999], {rest}"#), "q_l: number out of range"),
            (format!(r#"{{"q_l": [1, NaN], {rest}"#), "q_l: expected value"),
            (format!(r#"{{"q_l": [1, null], {rest}"#), "q_l: invalid type: null"),
            (format!(r#"{{"ql": [1, 2], {rest}"#), "unknown key 'ql': did you mean 'q_l'?"),
            (format!("{{{rest}"), "missing key q_l"),
            (format!(r#"{{"q_m": [1, 2], {rest}"#), "q_m is given twice"),
            (format!(r#"{{"t": 1, "t": 1, "q_l": [1, 2], {rest}"#), "t is given twice"),
            (format!(r#"{{"q_l": [1, 2], {rest} 3"#), "trailing characters"),
            ("[1, 2]".into(), "invalid type: sequence, expected an object"),
            (r#"{"q_l": [1, "#.into(), "q_l: EOF"),
        ] {
            let rows = read(&format!("\n\n{line}\n"));
            let error = rows[0].as_ref().unwrap_err();
            assert!(error.contains(expected), "{line}: {error}");
            assert!(error.starts_with("s.jsonl:3:"), "{error}");
        }
    }

    #[test]
    fn goes_on_after_a_bad_line_and_stops_at_one_without_end() {
        let good = r#"{"q_l": [1, 2], "q_m": [3, 4], "dq_l": [5, 6], "dq_m": [7, 8]}"#;
        let rows = read(&format!("?\n{good}\n"));
        assert!(rows[0].is_err() && rows[1].is_ok());
        let rows = read(&" ".repeat(super::LONGEST + 2));
        assert_eq!(rows.len(), 1);
        assert!(rows[0].as_ref().unwrap_err().contains("longer than"));
        assert!(States::new(&b"\xff\n"[..], 2, "s").next().unwrap().is_err());
    }
}
