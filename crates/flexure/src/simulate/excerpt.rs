//! Which columns and rows of a run its trace file has.

use std::num::NonZeroU32;

use crate::files::{Problem, suggest};
use crate::simulate::interface::Signal;

/// Some columns of a trace, and every so many rows.
#[derive(Clone, Debug)]
pub struct Excerpt {
    /// Index and name of each column, in the order of the trace.
    columns: Vec<(usize, String)>,
    every: NonZeroU32,
}

impl Excerpt {
    /// All columns and all rows of a run that has these signals.
    pub fn whole(signals: &[Signal]) -> Self {
        let columns = signals.iter().map(|signal| signal.name.clone()).enumerate().collect();
        Self { columns, every: NonZeroU32::MIN }
    }

    /// The columns that a pattern of `patterns` stands for, in the order of the trace, each once and the time always: names, in which
    /// `*` is any text and `?` any character; spaces around them do not count. Without patterns all of them. Of the rows the first, and every `every`-th after it.
    ///
    /// # Errors
    /// `unknown-name` for a pattern that stands for no column.
    pub fn new(signals: &[Signal], patterns: &[String], every: NonZeroU32) -> Result<Self, Problem> {
        let names = signals.iter().map(|signal| signal.name.as_str());
        let patterns: Vec<&str> = patterns.iter().map(|pattern| pattern.trim()).collect();
        for pattern in &patterns {
            if !names.clone().any(|name| matches(pattern, name)) {
                let what = if pattern.contains(['*', '?']) { "matches" } else { "is" };
                let message =
                    format!("--columns: no column of the trace {what} {}", suggest::quoted(pattern));
                let hint = suggest::hint(pattern, names) + "; q_l* is all that begin with q_l";
                return Err(Problem::new("unknown-name", message, hint));
            }
        }
        let asked = |name: &str| {
            patterns.is_empty() || name == TIME || patterns.iter().any(|pattern| matches(pattern, name))
        };
        let mut columns = Self::whole(signals).columns;
        columns.retain(|(_, name)| asked(name));
        Ok(Self { columns, every })
    }

    /// The indices of its columns.
    pub(super) fn columns(&self) -> impl Iterator<Item = usize> {
        self.columns.iter().map(|&(column, _)| column)
    }

    /// The names of its columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(_, name)| name.as_str())
    }

    /// Of so many rows there is one.
    pub fn every(&self) -> NonZeroU32 {
        self.every
    }
}

/// The column that is always there.
const TIME: &str = "t";

/// Whether `name` is what `pattern` stands for.
fn matches(pattern: &str, name: &str) -> bool {
    // On a mismatch the last star takes one character more: earlier ones need not be tried again.
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&c) if c == '?' || c == name[n] => (p, n) = (p + 1, n + 1),
            _ => {
                let Some((at, taken)) = star else { return false };
                star = Some((at, taken + 1));
                (p, n) = (at + 1, taken + 1);
            }
        }
    }
    pattern[p..].iter().all(|&c| c == '*')
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::{Excerpt, matches};
    use crate::simulate::interface::Signal;

    fn chosen(patterns: &[&str]) -> Result<Vec<String>, String> {
        let names = ["t", "q_l1", "q_l2", "q_ld1", "u_m1", "rate"];
        let signals = names.map(|name| Signal { name: name.to_owned(), unit: "" });
        let patterns: Vec<String> = patterns.iter().map(|&pattern| pattern.to_owned()).collect();
        Excerpt::new(&signals, &patterns, NonZeroU32::MIN)
            .map(|excerpt| excerpt.names().map(str::to_owned).collect())
            .map_err(|problem| format!("{}: {problem}; {}", problem.code_word(), problem.hint()))
    }

    #[test]
    fn columns_are_in_the_order_of_the_trace_and_once() {
        let named = |patterns: &[&str]| chosen(patterns).unwrap().join(" ");
        assert_eq!(named(&[]), "t q_l1 q_l2 q_ld1 u_m1 rate");
        assert_eq!(named(&["u_m1", "q_l2", "u_m1", "u_*"]), "t q_l2 u_m1");
        assert_eq!(named(&["t"]), "t");
        assert_eq!(named(&["q_l?"]), "t q_l1 q_l2");
        assert_eq!(named(&["*"]), named(&[]));
    }

    #[test]
    fn what_is_no_column_is_told_with_the_nearest() {
        for (pattern, fragment) in [
            ("q_l3", "unknown-name: --columns: no column of the trace is 'q_l3'; did you mean 'q_l1'?"),
            ("q_l", "did you mean 'q_l1'?"),
            ("Q_L1", "did you mean 'q_l1'?"),
            ("sigma*", "no column of the trace matches 'sigma*'; known: t, q_l1"),
            ("", "no column of the trace is ''"),
        ] {
            let told = chosen(&["q_l1", pattern]).unwrap_err();
            assert!(told.contains(fragment), "{told}");
        }
    }

    #[test]
    fn stars_and_question_marks() {
        for (pattern, name) in
            [("*", ""), ("*", "t"), ("q*1", "q_l1"), ("**", "q"), ("?_*_?", "a_b_b_c"), ("*ab*ab", "abaabab")]
        {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in
            [("?", ""), ("q", "q_l1"), ("*1", "q_l2"), ("q_l1*1", "q_l1"), ("", "t"), ("a*b*c", "acb")]
        {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }
}
