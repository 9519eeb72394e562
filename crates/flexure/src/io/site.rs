//! A place in a file, under the name that messages have for it.

use std::ops::Range;

use super::diagnostic::Problem;
use super::document::Log;

/// Where something stands, what it is called, and where its problems go.
#[derive(Clone, Debug)]
pub(super) struct Site<'a> {
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

    /// Notes a warning here.
    pub fn warn(&self, code: &'static str, message: impl Into<String>, help: impl Into<String>) {
        self.log.push(Problem::new(code, message, help).at(&self.log.source, self.span.clone()).warning());
    }
}
