//! A document with every file that it names, as they were when they were read: the same anywhere, whatever becomes of the files.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::files::base::Base;
use crate::files::change::Change;
use crate::files::diagnostic::Problem;
use crate::files::kept::Kept;
use crate::files::source::Source;

/// A scenario's or a robot's file, the files that it names, those that these name, and what is changed in them.
///
/// ```
/// use flexure::{Scenario, files::Bundle};
/// let (scenario, bundle) = Scenario::bundled("two-link-tanh", flexure::files::Outside::Refused)?;
/// let elsewhere = Bundle::from_document(&bundle.document())?;
/// assert_eq!(Scenario::of(&elsewhere)?.digest(), scenario.digest());
/// # Ok::<(), flexure::Problems>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bundle {
    pub(crate) source: Source,
    pub(crate) changes: Vec<Change>,
    kept: Kept,
}

/// How it is written.
#[derive(Deserialize, Serialize)]
struct Document {
    name: String,
    text: String,
    set: Vec<String>,
    files: BTreeMap<String, String>,
}

impl Bundle {
    /// Of `source`, from whose `base` files are read as they are asked for, until it is [closed](Self::closed).
    pub(crate) fn new(source: Source, base: Base, changes: &[Change]) -> Self {
        Self { source, changes: changes.to_vec(), kept: Kept::of(base) }
    }

    /// What was read so far, and nothing else from here on.
    pub(crate) fn closed(self) -> Self {
        Self { kept: self.kept.closed(), ..self }
    }

    /// Where the files are.
    pub(crate) fn base(&self) -> Base {
        Base::Kept(self.kept.clone())
    }

    /// The same with more changes.
    pub fn with(&self, changes: &[Change]) -> Self {
        Self { changes: [&self.changes[..], changes].concat(), ..self.clone() }
    }

    /// The same with one more file, at `path` from the document, whether there is such a file elsewhere or not.
    pub fn with_file(&self, path: &str, text: &str) -> Self {
        Self { kept: self.kept.with(path, text), ..self.clone() }
    }

    /// The same with the first `count` changes only.
    pub(crate) fn with_first(&self, count: usize) -> Self {
        Self { changes: self.changes[..count].to_vec(), ..self.clone() }
    }

    /// All of it, as JSON.
    pub fn document(&self) -> String {
        let document = Document {
            name: self.source.name.to_string(),
            text: self.source.of_file().to_owned(),
            set: self.changes.iter().map(|change| change.text().to_owned()).collect(),
            files: self.kept.files(),
        };
        serde_json::to_string(&document).unwrap_or_default()
    }

    /// From what [`document`](Self::document) wrote.
    ///
    /// # Errors
    /// `syntax` if it is none.
    pub fn from_document(text: &str) -> Result<Self, Problem> {
        let Document { name, text, set, files } = serde_json::from_str(text).map_err(|error| {
            Problem::new(
                "syntax",
                format!("this is no bundle of files: {error}"),
                "Bundle::document writes them",
            )
        })?;
        let changes = set.iter().map(|set| Change::parse(set)).collect::<Result<_, _>>()?;
        Ok(Self { source: Source::new(&name, &text), changes, kept: Kept::holding(&files) })
    }
}
