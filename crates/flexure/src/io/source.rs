//! The text of a file, read with care.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;

use super::diagnostic::Problem;

/// Largest file that is read [bytes].
const LIMIT: u64 = 16 << 20;

/// A file's name and text; cheap to clone.
pub(super) type Source = NamedSource<Arc<str>>;

/// A source from text that is at hand.
pub(super) fn named(name: &str, text: &str) -> Source {
    NamedSource::new(name, Arc::from(text))
}

/// Reads the text file at `path`.
pub(super) fn read(path: &Path) -> Result<Source, Problem> {
    let name = path.display();
    let unreadable = |error: std::io::Error| {
        Problem::new(
            "unreadable",
            format!("cannot read {name}: {error}"),
            "give the path of a text file (a path inside a file is relative to that file), or the name of a \
             built-in robot or scenario",
        )
    };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(LIMIT + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > LIMIT {
        return Err(Problem::new(
            "huge",
            format!("{name} is larger than {} MiB", LIMIT >> 20),
            "robot, scenario and sample files are small; is it the right file?",
        ));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = error.as_bytes().get(..valid).unwrap_or_default();
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        let clean = String::from_utf8_lossy(error.as_bytes());
        Problem::new(
            "encoding",
            format!("{name} is not UTF-8: invalid byte {valid} in line {line}"),
            "save the file as UTF-8 text",
        )
        .at(&named(&name.to_string(), &clean), valid..valid)
    })?;
    Ok(named(&name.to_string(), &text))
}
