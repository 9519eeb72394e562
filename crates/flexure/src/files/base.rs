//! What paths inside a file are relative to.

use std::path::{Path, PathBuf};

use crate::files::diagnostic::Problem;
use crate::files::source::{self, Source};
use crate::files::{builtin, suggest};

/// Where the file that is being read came from.
#[derive(Clone, Debug)]
pub(crate) enum Base {
    /// From this folder: relative paths start there.
    Folder(PathBuf),
    /// Out of the program: a relative path names another file in it.
    BuiltIn,
}

impl Base {
    /// The folder of the file at `path`.
    pub fn of(path: &Path) -> Self {
        Self::Folder(path.parent().unwrap_or(Path::new("")).to_owned())
    }

    /// The base of what stands in the file at `path` of this one.
    pub fn beside(&self, path: &str) -> Self {
        match self {
            Self::Folder(folder) => Self::of(&folder.join(path)),
            Self::BuiltIn => Self::of(Path::new(path)),
        }
    }

    /// The file at `path`, of at most `limit` bytes.
    pub fn read(&self, path: &str, limit: u64) -> Result<Source, Problem> {
        match self {
            Self::Folder(folder) => source::read(&folder.join(path), limit),
            Self::BuiltIn => {
                if let Some(text) = builtin::file(path) {
                    return Ok(Source::new(path, text));
                }
                if Path::new(path).is_absolute() {
                    return source::read(Path::new(path), limit);
                }
                let message =
                    format!("{} is a relative path in a file that is in no folder", suggest::quoted(path));
                Err(Problem::new(
                    "unreadable",
                    message,
                    "give the whole path, or save the file that names it",
                ))
            }
        }
    }
}
