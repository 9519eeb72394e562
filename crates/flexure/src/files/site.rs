//! A place in a file, under the name that messages have for it.

use std::ops::Range;

use crate::files::diagnostic::{Problem, Problems};
use crate::files::document::Log;
use crate::files::suggest;

/// Where something stands, what it is called, and where its problems go.
#[derive(Clone, Debug)]
pub(crate) struct Site<'a> {
    pub span: Range<usize>,
    /// `joints.stiffness[1]` in TOML, `joint 'elbow': origin xyz` in a URDF.
    pub path: String,
    pub log: &'a Log,
}

impl Site<'_> {
    /// Notes an error here.
    pub fn error(&self, code: &'static str, message: impl Into<String>, help: impl Into<String>) {
        self.log.error(self.span.clone(), code, message, help);
    }

    /// `text` if it can be a name: not empty, and nothing in it that a terminal might obey.
    pub fn name<'t>(&self, text: &'t str) -> Option<&'t str> {
        if text.trim().is_empty() || text.chars().any(char::is_control) {
            let message = format!("{} is {}, must be a name", self.path, suggest::quoted(text));
            self.error("name", message, "letters, digits and the like, no control characters");
            return None;
        }
        Some(text)
    }

    /// The line, counted from 1.
    pub fn line(&self) -> usize {
        let (part, span) = self.log.source.part_with(self.span.clone());
        part.line_column(span.start).map_or(0, |(line, _)| line)
    }

    /// What another file was read to; its problems are noted as they are, at this place if they have none.
    pub fn absorb<T>(&self, read: Result<T, Problems>) -> Option<T> {
        match read {
            Ok(value) => Some(value),
            Err(problems) => {
                for problem in problems {
                    self.log.push(problem.or_at(&self.log.source, self.span.clone()));
                }
                None
            }
        }
    }

    /// Notes a warning here.
    pub fn warn(&self, code: &'static str, message: impl Into<String>, help: impl Into<String>) {
        self.log.push(Problem::new(code, message, help).at(&self.log.source, self.span.clone()).warning());
    }
}
