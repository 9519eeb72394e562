//! Output files that appear whole or not at all.

use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use miette::Diagnostic;

use crate::files::leftover;

/// Why a file was not written. Nothing is left behind, and a file that was there before is as it was.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// No file can be created beside the target.
    #[error("cannot create files in {}: {cause}", folder.display())]
    Folder {
        /// Folder that could not be made.
        folder: PathBuf,
        /// Reason that the operating system gave.
        #[source]
        cause: io::Error,
    },
    /// The target is a folder or a device.
    #[error("{} is not a regular file", path.display())]
    NotAFile {
        /// File that was to be written.
        path: PathBuf,
    },
    /// Writing failed on the way.
    #[error("cannot write {}: {cause}", path.display())]
    Content {
        /// File that was to be written.
        path: PathBuf,
        /// What the system or the writer said.
        #[source]
        cause: io::Error,
    },
}

impl Diagnostic for WriteError {
    fn code<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new("error[write]"))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(match self {
            Self::Folder { .. } => "name a folder in which files can be created",
            Self::NotAFile { .. } => "name a file that does not exist yet, or one to replace",
            Self::Content { .. } => "is the disk full, or the file in use?",
        }))
    }
}

/// Writes `path` by `write`, into a temporary file in the same folder that takes the name at the end.
///
/// # Errors
/// If the folder is not writable, the target is not a regular file, or `write` or the system fails.
pub fn write_atomic(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    if fs::metadata(path).is_ok_and(|existing| !existing.is_file()) {
        return Err(WriteError::NotAFile { path: path.into() });
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |cause| WriteError::Content { path: path.into(), cause };
    let file =
        leftover::create(folder).map_err(|cause| WriteError::Folder { folder: folder.into(), cause })?;
    let mut buffered = BufWriter::new(file);
    write(&mut buffered).map_err(failed)?;
    let file = buffered.into_inner().map_err(|error| failed(error.into_error()))?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Creates `folder` if it is missing, and a file in it that is gone again: to know before a long run that its outputs
/// can be written.
///
/// # Errors
/// If they cannot.
pub fn prepare(folder: &Path) -> Result<(), WriteError> {
    create_folder(folder)?;
    tempfile::tempfile_in(folder)
        .map(drop)
        .map_err(|cause| WriteError::Folder { folder: folder.into(), cause })
}

/// Creates `folder` if it is missing, and removes temporary files from it that runs left there which were killed.
///
/// # Errors
/// If it cannot be created.
pub fn create_folder(folder: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(folder).map_err(|cause| WriteError::Folder { folder: folder.into(), cause })?;
    leftover::remove(folder);
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io;

    use super::{WriteError, write_atomic};

    #[test]
    fn whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.csv");
        write_atomic(&path, |out| out.write_all(b"old")).unwrap();
        let failed = write_atomic(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("out of ideas"))
        });
        assert!(failed.unwrap_err().to_string().contains("out of ideas"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary file is gone");
        write_atomic(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn says_what_is_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none").join("trace.csv");
        assert!(matches!(write_atomic(&missing, |_| Ok(())), Err(WriteError::Folder { .. })));
        assert!(matches!(write_atomic(folder.path(), |_| Ok(())), Err(WriteError::NotAFile { .. })));
    }
}
