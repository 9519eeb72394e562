//! What paths inside a file are relative to, and which files may be named there.

use std::path::{Component, Path, PathBuf};
use std::{fs, io};

use crate::files::change::Change;
use crate::files::diagnostic::Problem;
use crate::files::kept::Kept;
use crate::files::source::{self, Source};
use crate::files::{builtin, suggest};

/// Whether a file may name files outside of its folder.
///
/// What is wrong with a file is shown with the line that it is in. A scenario of unknown origin that names
/// `robot = "../../../etc/passwd"` would show a line of that.
///
/// ```
/// use flexure::files::Outside;
/// use flexure::scenario::load_scenario_with;
/// assert!(load_scenario_with("two-link-tanh", Outside::Refused).is_ok());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// Files that a file names lie in its folder or below, links resolved: others are not opened.
    #[default]
    Refused,
    /// A file may name any file.
    Allowed,
}

/// How a document is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading<'a> {
    /// Whether the file may name files outside of its folder.
    pub outside: Outside,
    /// What is changed before anything is read.
    pub changes: &'a [Change],
}

impl<'a> Reading<'a> {
    /// With these changes.
    pub fn changed(changes: &'a [Change]) -> Self {
        Self { changes, ..Self::default() }
    }
}

impl From<Outside> for Reading<'_> {
    fn from(outside: Outside) -> Self {
        Self { outside, changes: &[] }
    }
}

/// Where the file that is being read came from.
#[derive(Clone, Debug)]
pub(crate) enum Base {
    /// From this folder: relative paths start there.
    Folder(PathBuf, Outside),
    /// Out of the program: a relative path names another file in it.
    BuiltIn,
    /// From one of these two; what was read once is not read again.
    Kept(Kept),
}

impl Base {
    /// The folder of the file at `path`; of what is no file, as a pipe, the current one.
    pub fn of(path: &Path, outside: Outside) -> Self {
        let folder = if path.metadata().is_ok_and(|what| !what.is_file()) { None } else { path.parent() };
        Self::Folder(folder.unwrap_or(Path::new("")).to_owned(), outside)
    }

    /// The base of what stands in the file at `path` of this one.
    pub fn beside(&self, path: &str) -> Self {
        match self {
            Self::Folder(folder, outside) => Self::of(&folder.join(path), *outside),
            Self::BuiltIn => Self::BuiltIn,
            Self::Kept(kept) => Self::Kept(kept.beside(path)),
        }
    }

    /// The file at `path`, of at most `limit` bytes.
    pub fn read(&self, path: &str, limit: u64) -> Result<Source, Problem> {
        match self {
            Self::Folder(folder, Outside::Allowed) => source::read(&folder.join(path), limit),
            Self::Folder(folder, Outside::Refused) => {
                let named = folder.join(path);
                let real =
                    inside(folder, Path::new(path)).map_err(|error| source::unreadable(&named, &error))?;
                let real = real.ok_or_else(|| outside(path, folder))?;
                source::read_as(&named, &real, limit)
            }
            Self::BuiltIn => builtin::file(path).map(|text| Source::new(path, text)).ok_or_else(|| {
                let message = format!("no built-in file is called {}", suggest::quoted(path));
                Problem::new("unreadable", message, "built-in files name built-in files only")
            }),
            Self::Kept(kept) => kept.read(path, limit),
        }
    }

    /// Whether files come out of the program.
    pub fn is_built_in(&self) -> bool {
        match self {
            Self::BuiltIn => true,
            Self::Folder(..) => false,
            Self::Kept(kept) => kept.is_built_in(),
        }
    }

    /// The bytes of the file at `path`, at most `limit` of them; none if there is no such file, or it may not be named.
    pub fn bytes(&self, path: &str, limit: u64) -> Option<Vec<u8>> {
        let (folder, outside) = match self {
            Self::Folder(folder, outside) => (folder, outside),
            Self::Kept(kept) => return kept.bytes(path, limit),
            Self::BuiltIn => return None,
        };
        let real = match outside {
            Outside::Allowed => folder.join(path),
            Outside::Refused => inside(folder, Path::new(path)).ok()??,
        };
        let what = real.metadata().ok().filter(|what| what.is_file() && what.len() <= limit)?;
        let bytes = fs::read(real).ok()?;
        (bytes.len() as u64 <= limit.max(what.len())).then_some(bytes)
    }
}

/// The file at `path` from `folder` with all links resolved; none if it is not in `folder` or below. Nothing is said of
/// what is outside, not even whether it is there.
fn inside(folder: &Path, path: &Path) -> io::Result<Option<PathBuf>> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let home = here.canonicalize()?;
    match here.join(path).canonicalize() {
        Ok(real) => Ok(real.starts_with(&home).then_some(real)),
        Err(error) if plain(&home.join(path)).starts_with(&home) => Err(error),
        Err(_) => Ok(None),
    }
}

/// `path` with every `..` taken back, by name alone.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    plain
}

fn outside(path: &str, folder: &Path) -> Problem {
    let folder = match folder.display().to_string() {
        none if none.is_empty() => "the current folder".to_owned(),
        folder => suggest::quoted(&folder),
    };
    let message =
        format!("{} is outside of {folder}, where the file that names it is", suggest::quoted(path));
    let help =
        "keep both in one folder, or allow such files with --allow-outside (in Rust: Outside::Allowed)";
    Problem::new("outside", message, help)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::{Base, Outside, inside, plain};

    #[test]
    fn dots_are_taken_back() {
        for (path, expected) in
            [("/a/b/../c", "/a/c"), ("/a/./b", "/a/b"), ("/../../a", "/a"), ("/a/../..", "/")]
        {
            assert_eq!(plain(Path::new(path)), Path::new(expected));
        }
    }

    /// Inside: at the same place or below, whatever the path looks like and whoever links to whom.
    #[test]
    #[cfg(unix)]
    fn inside_is_where_the_file_is() {
        use std::os::unix::fs::symlink;
        let top = tempfile::tempdir().unwrap();
        let (home, away) = (top.path().join("home"), top.path().join("home-away"));
        fs::create_dir_all(home.join("sub")).unwrap();
        fs::create_dir(&away).unwrap();
        for file in [home.join("sub/in"), away.join("out"), top.path().join("out")] {
            fs::write(file, "secret").unwrap();
        }
        symlink(away.join("out"), home.join("link")).unwrap();
        symlink(&away, home.join("folder")).unwrap();
        symlink("sub/in", home.join("near")).unwrap();
        symlink(&home, top.path().join("alias")).unwrap();
        let absolute = |path: &Path| path.to_str().unwrap().to_owned();
        for folder in [&home, &top.path().join("alias")] {
            for path in
                ["sub/in", "./sub/../sub/in", "near", "../home/sub/in", &absolute(&home.join("sub/in"))]
            {
                assert!(inside(folder, Path::new(path)).unwrap().is_some(), "{path}");
            }
            for path in [
                "../out",
                "../home-away/out",
                "sub/../../out",
                "link",
                "folder/out",
                "../none",
                "/etc/passwd",
                "/none/none",
                &absolute(&away.join("out")),
            ] {
                assert!(inside(folder, Path::new(path)).unwrap().is_none(), "{path}");
            }
            assert!(inside(folder, Path::new("none")).is_err());
        }
        let read = |outside| Base::Folder(home.clone(), outside).read("../out", 100);
        assert_eq!(&*read(Outside::Allowed).unwrap().text, "secret");
        let refused = read(Outside::Refused).unwrap_err();
        assert!(!format!("{refused:?}").contains("secret"));
    }
}
