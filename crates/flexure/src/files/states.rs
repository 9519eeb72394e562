//! States files: JSON Lines, one state a line.

use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use serde::de;
use serde::de::{DeserializeSeed, MapAccess, Visitor};

use crate::files::diagnostic::Problem;
use crate::files::source::Source;
use crate::files::suggest;

/// Longest line that is read \[bytes\].
const LONGEST: usize = 1 << 20;

/// A time, a state, perhaps a torque and higher derivatives of the link positions; one number per joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateRow {
    /// Line of the file, counted from 1.
    pub line: usize,
    /// Time \[s\]; 0 if not given.
    pub t: f64,
    /// Link positions \[rad\].
    pub q_l: Vec<f64>,
    /// Motor positions \[rad\].
    pub q_m: Vec<f64>,
    /// Link velocities [rad/s].
    pub dq_l: Vec<f64>,
    /// Motor velocities [rad/s].
    pub dq_m: Vec<f64>,
    /// Motor torques [N m].
    pub u_m: Option<Vec<f64>>,
    /// Link accelerations [rad/s²].
    pub ddq_l: Option<Vec<f64>>,
    /// Link jerks [rad/s³]; only with accelerations.
    pub d3q_l: Option<Vec<f64>>,
    /// Fourth derivatives of the link positions [rad/s⁴]; only with jerks.
    pub d4q_l: Option<Vec<f64>>,
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
                Ok(length) if length <= LONGEST => match String::from_utf8(without_mark(bytes, self.line)) {
                    Ok(line) if line.trim().is_empty() => continue,
                    Ok(line) => return Some(Ok(line)),
                    Err(_) => return Some(Err(self.problem("encoding", "", 0, "the line is not UTF-8"))),
                },
                Ok(_) => self.problem("huge", "", 0, &format!("the line is longer than {LONGEST} bytes")),
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
            "one JSON object a line with q_l, q_m, dq_l, dq_m = {numbers}, optional t (a number), u_m, ddq_l, d3q_l and d4q_l = {numbers}"
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
        let row = Row { joints: self.joints, line: self.line }
            .deserialize(&mut json)
            .and_then(|row| json.end().map(|()| row));
        Some(row.map_err(|error| {
            let text = error.to_string();
            let what = text.split(" at line ").next().unwrap_or_default();
            // What breaks the grammar has no words of ours.
            let what = if error.is_data() { what.to_owned() } else { format!("not JSON: {what}") };
            self.problem("state", &line, error.column().saturating_sub(1), &what)
        }))
    }
}

/// All states of a file.
#[derive(Clone, Debug)]
pub struct StateFile {
    /// Stands for the file in messages.
    pub name: String,
    /// A state each, at least one.
    pub rows: Vec<StateRow>,
}

impl StateFile {
    /// Every state in `reader`, of a robot with `joints` joints; `name` stands for the file in messages.
    ///
    /// # Errors
    /// With the first line that is bad, or if there is none.
    pub fn read(reader: impl BufRead, joints: usize, name: &str) -> Result<Self, Problem> {
        let mut states = States::new(reader, joints, name);
        let rows = states.by_ref().collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() {
            return Err(states.problem("empty", "", 0, "no states: the file is empty"));
        }
        Ok(Self { name: name.to_owned(), rows })
    }

    /// A problem with the state at `row`. `code` is one word; `help` says what to do.
    pub fn problem(
        &self,
        row: &StateRow,
        code: &'static str,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Problem {
        Problem::new(code, what, help).at(&Source::part(&self.name, "", row.line.saturating_sub(1)), 0..0)
    }
}

/// Reads the states file at `path`, or standard input if that is `-`.
///
/// # Errors
/// If it cannot be read, with the first line that is bad, or if there is no state in it.
pub fn load_states(path: &Path, joints: usize) -> Result<StateFile, Problem> {
    if path.as_os_str() == "-" {
        return StateFile::read(std::io::stdin().lock(), joints, "standard input");
    }
    let name = path.display();
    let unreadable = |error| {
        let help = "give a file of JSON Lines with q_l, q_m, dq_l, dq_m, or - for standard input";
        Problem::new("unreadable", format!("cannot read {name}: {error}"), help)
    };
    let file = File::open(path).map_err(unreadable)?;
    if file.metadata().map_err(unreadable)?.is_dir() {
        return Err(unreadable(std::io::ErrorKind::IsADirectory.into()));
    }
    StateFile::read(BufReader::new(file), joints, &name.to_string())
}

/// The bytes of a line; the first may begin with the mark that some editors put before UTF-8.
fn without_mark(mut bytes: Vec<u8>, line: usize) -> Vec<u8> {
    if line == 1 && bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    bytes
}

/// One line, for a known number of joints.
struct Row {
    joints: usize,
    line: usize,
}

const KEYS: &[&str] = &["t", "q_l", "q_m", "dq_l", "dq_m", "u_m", "ddq_l", "d3q_l", "d4q_l"];

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
        let mut vectors: [Option<Vec<f64>>; 8] = Default::default();
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
        let [q_l, q_m, dq_l, dq_m, u_m, ddq_l, d3q_l, d4q_l] = vectors;
        for (key, given, lower, lower_given) in [
            ("d3q_l", d3q_l.is_some(), "ddq_l", ddq_l.is_some()),
            ("d4q_l", d4q_l.is_some(), "d3q_l", d3q_l.is_some()),
        ] {
            if given && !lower_given {
                return Err(de::Error::custom(format!("{key} without {lower}: torque rates need both")));
            }
        }
        let missing = |key: &'static str| move || de::Error::custom(format!("missing key {key}"));
        Ok(StateRow {
            line: self.line,
            t: time.unwrap_or(0.0),
            q_l: q_l.ok_or_else(missing("q_l"))?,
            q_m: q_m.ok_or_else(missing("q_m"))?,
            dq_l: dq_l.ok_or_else(missing("dq_l"))?,
            dq_m: dq_m.ok_or_else(missing("dq_m"))?,
            u_m,
            ddq_l,
            d3q_l,
            d4q_l,
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
            line: 2,
            t: 0.5,
            q_l: vec![1.0, 2.0],
            q_m: vec![3.0, 4.0],
            dq_l: vec![5.0, 6.0],
            dq_m: vec![7.0, 8.5],
            u_m: Some(vec![0.0, -1e3]),
            ..StateRow::default()
        };
        let later = StateRow { line: 4, ..expected.clone() };
        assert_eq!(rows, [Ok(expected), Ok(later)]);
        assert!(read(&format!("\u{feff}{line}"))[0].is_ok());
        let along = line.replace("\"u_m\"", r#""d3q_l": [3, 3], "d4q_l": [4, 4], "ddq_l""#);
        let row = read(&along).remove(0).unwrap();
        assert_eq!((row.u_m, row.ddq_l), (None, Some(vec![0.0, -1e3])));
        assert_eq!((row.d3q_l, row.d4q_l), (Some(vec![3.0; 2]), Some(vec![4.0; 2])));
    }

    #[test]
    fn bad_lines_name_line_column_and_key() {
        let rest = r#""q_m": [3, 4], "dq_l": [5, 6], "dq_m": [7, 8]}"#;
        for (line, expected) in [
            (format!(r#"{{"q_l": [1, "x"], {rest}"#), "s.jsonl:3:15: q_l: invalid type: string"),
            (format!(r#"{{"q_l": [1], {rest}"#), "q_l: 2 numbers expected, one per joint; got 1"),
            (format!(r#"{{"q_l": [1, 1e999], {rest}"#), "q_l: number out of range"),
            (format!(r#"{{"q_l": [1, NaN], {rest}"#), "q_l: expected value"),
            (format!(r#"{{"q_l": [1, null], {rest}"#), "q_l: invalid type: null"),
            (format!(r#"{{"ql": [1, 2], {rest}"#), "unknown key 'ql': did you mean 'q_l'?"),
            (format!("{{{rest}"), "missing key q_l"),
            (format!(r#"{{"q_m": [1, 2], {rest}"#), "q_m is given twice"),
            (format!(r#"{{"t": 1, "t": 1, "q_l": [1, 2], {rest}"#), "t is given twice"),
            (format!(r#"{{"q_l": [1, 2], {rest} 3"#), "trailing characters"),
            (format!(r#"{{"ddq_l": [1], "q_l": [1, 2], {rest}"#), "ddq_l: 2 numbers expected"),
            (format!(r#"{{"d3q_l": [1, 2], "q_l": [1, 2], {rest}"#), "d3q_l without ddq_l"),
            (format!(r#"{{"d4q_l": [1, 2], "ddq_l": [1, 2], "q_l": [1, 2], {rest}"#), "d4q_l without d3q_l"),
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
