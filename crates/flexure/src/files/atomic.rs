//! Output files that appear whole or not at all.

use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use miette::Diagnostic;
use tempfile::NamedTempFile;

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
    /// No file can be called so.
    #[error("{} has a name that is too long", path.display())]
    LongName {
        /// File that was to be written.
        path: PathBuf,
    },
    /// There is such a file, and it shall stay.
    #[error("{} exists", path.display())]
    Exists {
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
        Some(Box::new(match self {
            Self::Exists { .. } => "error[exists]",
            Self::Folder { .. } | Self::NotAFile { .. } | Self::LongName { .. } | Self::Content { .. } => {
                "error[write]"
            }
        }))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(match self {
            Self::Folder { .. } => "name a folder in which files can be created",
            Self::LongName { .. } => {
                "outputs are called as their scenarios and robots: give them shorter names"
            }
            Self::NotAFile { .. } => "name a file that does not exist yet, or one to replace",
            Self::Exists { .. } => "name another place, or replace what is there with --force",
            Self::Content { .. } => "is the disk full, or the file in use?",
        }))
    }
}

/// The folder that `path` lies in.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file that is being written: under a temporary name in its folder until it is [kept](Self::keep), and gone if it never is.
#[derive(Debug)]
pub struct Pending {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl Pending {
    /// A file that will be at `path`; its folder is made if it is missing.
    ///
    /// # Errors
    /// If the folder is not writable, or the target is not a regular file.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        if fs::metadata(path).is_ok_and(|existing| !existing.is_file()) {
            return Err(WriteError::NotAFile { path: path.into() });
        }
        make(folder_of(path))?;
        Self::beside(path)
    }

    /// The same where the folder is there.
    fn beside(path: &Path) -> Result<Self, WriteError> {
        let folder = folder_of(path);
        let file =
            leftover::create(folder).map_err(|cause| WriteError::Folder { folder: folder.into(), cause })?;
        Ok(Self { path: path.into(), file: BufWriter::new(file) })
    }

    /// Where it will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name, in the place of one that was there, once it is down on the disk.
    ///
    /// # Errors
    /// If the system fails.
    pub fn keep(self) -> Result<(), WriteError> {
        let path = self.path.clone();
        let file = self.down()?;
        file.persist(&path).map_err(|error| WriteError::Content { path, cause: error.error })?;
        Ok(())
    }

    /// What was written, down on the disk.
    fn down(self) -> Result<NamedTempFile, WriteError> {
        let Self { path, file } = self;
        let failed = |cause| WriteError::Content { path, cause };
        let file = match file.into_inner() {
            Ok(file) => file,
            Err(error) => return Err(failed(error.into_error())),
        };
        match file.as_file().sync_all() {
            Ok(()) => Ok(file),
            Err(cause) => Err(failed(cause)),
        }
    }

    /// With what `write` writes.
    fn with(mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Self, WriteError> {
        match write(&mut self.file) {
            Ok(()) => Ok(self),
            Err(cause) => Err(WriteError::Content { path: self.path, cause }),
        }
    }
}

impl Write for Pending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Writes `path` by `write`, into a temporary file in the same folder that takes the name at the end; the folder is made if it is
/// missing.
///
/// # Errors
/// If the folder is not writable, the target is not a regular file, or `write` or the system fails.
pub fn write_atomic(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    Pending::create(path)?.with(write)?.keep()
}

/// Writes texts that belong together: none is written if one cannot be. Files that exist are replaced if `replace`, one by one, and
/// are an error otherwise; folders must be there.
///
/// # Errors
/// As [`write_atomic`], and for what exists.
pub fn write_together(files: &[(PathBuf, &str)], replace: bool) -> Result<(), WriteError> {
    for (path, _) in files {
        match fs::metadata(path) {
            Ok(existing) if !existing.is_file() => return Err(WriteError::NotAFile { path: path.into() }),
            Ok(_) if !replace => return Err(WriteError::Exists { path: path.into() }),
            Ok(_) | Err(_) => {}
        }
    }
    let written = |(path, text): &(PathBuf, &str)| {
        Pending::beside(path)?.with(|out| out.write_all(text.as_bytes()))?.down()
    };
    let written: Vec<_> = files.iter().map(written).collect::<Result<_, _>>()?;
    for (i, (file, (path, _))) in written.into_iter().zip(files).enumerate() {
        let named = if replace { file.persist(path) } else { file.persist_noclobber(path) };
        if let Err(error) = named {
            if !replace {
                // What was not there before is not there now.
                files.iter().take(i).for_each(|(path, _)| drop(fs::remove_file(path)));
            }
            return Err(WriteError::Content { path: path.into(), cause: error.error });
        }
    }
    Ok(())
}

/// That files can be created in `folder`, or in the nearest folder above that is there: to know before a long run that its outputs can
/// be written. What is missing is not made before they are. Removes temporary files that runs left there which were killed.
///
/// # Errors
/// If they cannot.
pub fn prepare(folder: &Path) -> Result<(), WriteError> {
    let missing =
        |place: &Path| fs::metadata(place).is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
    let mut place = folder;
    while missing(place) && place != Path::new(".") {
        place = folder_of(place);
    }
    if place == folder {
        leftover::remove(folder);
    }
    tempfile::tempfile_in(place)
        .map(drop)
        .map_err(|cause| WriteError::Folder { folder: folder.into(), cause })
}

/// Bytes of a file's name, at most, on every system in use.
const LONGEST_NAME: usize = 255;

/// As [`prepare`], and that files of these names can be written there: none is that of a folder or a device, or too long.
///
/// # Errors
/// If they cannot.
pub fn prepare_for(folder: &Path, names: impl IntoIterator<Item = String>) -> Result<(), WriteError> {
    prepare(folder)?;
    for name in names {
        let path = folder.join(&name);
        if name.len() > LONGEST_NAME {
            return Err(WriteError::LongName { path });
        }
        if fs::metadata(&path).is_ok_and(|what| !what.is_file()) {
            return Err(WriteError::NotAFile { path });
        }
    }
    Ok(())
}

/// Creates `folder` if it is missing, and removes temporary files from it that runs left there which were killed.
///
/// # Errors
/// If it cannot be created.
pub fn create_folder(folder: &Path) -> Result<(), WriteError> {
    make(folder)?;
    leftover::remove(folder);
    Ok(())
}

fn make(folder: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(folder).map_err(|cause| WriteError::Folder { folder: folder.into(), cause })
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io;
    use std::path::Path;

    use super::{WriteError, prepare, write_atomic, write_together};

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
    fn together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let pair = [(at("a"), "1"), (at("b"), "2")];
        fs::write(at("b"), "old").unwrap();
        assert!(matches!(write_together(&pair, false), Err(WriteError::Exists { path }) if path == at("b")));
        assert_eq!((count(), fs::read(at("b")).unwrap()), (1, b"old".to_vec()));
        write_together(&pair, true).unwrap();
        assert_eq!(
            (count(), fs::read(at("a")).unwrap(), fs::read(at("b")).unwrap()),
            (2, b"1".to_vec(), b"2".to_vec())
        );
        let nowhere = [(at("c"), "3"), (at("none").join("d"), "4")];
        assert!(matches!(write_together(&nowhere, false), Err(WriteError::Folder { .. })));
        assert_eq!(count(), 2, "c is not there");
    }

    #[test]
    fn says_what_is_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), "").unwrap();
        let inside = folder.path().join("file").join("trace.csv");
        assert!(matches!(write_atomic(&inside, |_| Ok(())), Err(WriteError::Folder { .. })));
        assert!(matches!(write_atomic(folder.path(), |_| Ok(())), Err(WriteError::NotAFile { .. })));
    }

    #[test]
    fn folders_are_made_with_their_first_file() {
        let folder = tempfile::tempdir().unwrap();
        let (new, blocked) = (folder.path().join("a").join("b"), folder.path().join("file").join("b"));
        fs::write(folder.path().join("file"), "").unwrap();
        prepare(&new).unwrap();
        assert!(matches!(prepare(&blocked), Err(WriteError::Folder { folder, .. }) if folder == blocked));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the file alone");
        write_atomic(&new.join("trace.csv"), |_| Ok(())).unwrap();
        prepare(&new).unwrap();
        assert!(new.join("trace.csv").is_file());
        prepare(Path::new("none-in-the-current-folder")).unwrap();
    }
}
