//! Files that a command may write over.

use std::io::ErrorKind;
use std::path::Path;

use crate::files::diagnostic::Problem;
use crate::files::source::read_text;

/// Largest file that is looked into \[bytes\].
const LARGEST: u64 = 16 << 20;

/// That `out` may be written: nothing is there, or a file of the kind `what`, as `is_one` tells by its text, and none of `inputs`.
///
/// # Errors
/// `exists` if something else is there: it is left as it is.
pub fn spare(
    out: &Path,
    what: &str,
    is_one: impl FnOnce(&str) -> bool,
    inputs: &[&Path],
) -> Result<(), Problem> {
    // Links that lead nowhere, and what may not be looked at, are in the way as well.
    let missing = [ErrorKind::NotFound, ErrorKind::NotADirectory];
    if out.symlink_metadata().is_err_and(|error| missing.contains(&error.kind())) {
        return Ok(());
    }
    let place = out.canonicalize().ok();
    let is_input = inputs.iter().any(|input| place.is_some() && input.canonicalize().ok() == place);
    let reason = if is_input {
        "is what is read".to_owned()
    } else if out.is_file() && read_text(out, LARGEST).is_ok_and(|text| is_one(&text)) {
        return Ok(());
    } else {
        format!("exists and is no {what}")
    };
    let message = format!("{} {reason}: it is left as it is", out.display());
    Err(Problem::new("exists", message, "name another file with --out, or remove this one"))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::spare;

    #[test]
    fn only_files_of_the_kind_that_are_no_inputs() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (name, text) in [("mine", "# mine, older"), ("input", "# mine, read"), ("notes", "notes, # mine")]
        {
            fs::write(at(name), text).unwrap();
        }
        let may = |name: &str| {
            let found = spare(
                &at(name),
                "such file",
                |text| text.starts_with("# mine"),
                &[&at("input"), &at("none")],
            );
            found.map_err(|problem| (problem.code_word(), problem.to_string()))
        };
        assert_eq!((may("mine"), may("new"), may("none")), (Ok(()), Ok(()), Ok(())));
        for (name, reason) in
            [("input", "is what is read"), ("notes", "is no such file"), ("", "is no such file")]
        {
            let (code, message) = may(name).unwrap_err();
            assert!(code == "exists" && message.contains(reason), "{name}: {message}");
        }
    }
}
