//! Files kept as they were when they were first read: what is read once more says the same, and all of it can go elsewhere.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::files::base::Base;
use crate::files::diagnostic::Problem;
use crate::files::source::Source;
use crate::files::suggest;

/// The files that a document names, those that they name, and so on, by the paths on the way from the document.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    files: Arc<Mutex<BTreeMap<String, Source>>>,
    /// Where a file is read the first time; none if all are there.
    from: Option<Box<Base>>,
    /// The folder of the document that is being read, from that of the first.
    here: PathBuf,
}

impl Kept {
    /// Files of `base`, read as they are asked for.
    pub fn of(base: Base) -> Self {
        Self { files: Arc::default(), from: Some(Box::new(base)), here: PathBuf::new() }
    }

    /// These files and no others.
    pub fn holding(files: &BTreeMap<String, String>) -> Self {
        let sources = files.iter().map(|(path, text)| (path.clone(), Source::new(path, text))).collect();
        Self { files: Arc::new(Mutex::new(sources)), from: None, here: PathBuf::new() }
    }

    /// With one more, at `path` from the document.
    pub fn with(&self, path: &str, text: &str) -> Self {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner).clone();
        files.insert(path.to_owned(), Source::new(path, text));
        Self { files: Arc::new(Mutex::new(files)), ..self.clone() }
    }

    /// What is kept so far.
    pub fn files(&self) -> BTreeMap<String, String> {
        let files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        files.iter().map(|(path, source)| (path.clone(), source.text.to_string())).collect()
    }

    /// From here on nothing else is read.
    pub fn closed(self) -> Self {
        Self { from: None, ..self }
    }

    /// The file at `path`, of at most `limit` bytes.
    pub fn read(&self, path: &str, limit: u64) -> Result<Source, Problem> {
        let key = self.here.join(path).display().to_string();
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(source) = files.get(&key) {
            return Ok(source.clone());
        }
        let Some(from) = &self.from else {
            let message = format!("{} is none of the files that were kept", suggest::quoted(&key));
            return Err(Problem::new(
                "unreadable",
                message,
                "name one of those that were there at the start",
            ));
        };
        let source = from.read(path, limit)?;
        files.insert(key, source.clone());
        Ok(source)
    }

    /// Whether they came out of the program.
    pub fn is_built_in(&self) -> bool {
        self.from.as_ref().is_some_and(|from| from.is_built_in())
    }

    /// The bytes of a file that is not kept, if there are still files to be read: of pictures, which no document depends on.
    pub fn bytes(&self, path: &str, limit: u64) -> Option<Vec<u8>> {
        self.from.as_ref()?.bytes(path, limit)
    }

    /// What is relative to the file at `path`.
    pub fn beside(&self, path: &str) -> Self {
        let here = self.here.join(path);
        Self {
            files: Arc::clone(&self.files),
            from: self.from.as_ref().map(|from| Box::new(from.beside(path))),
            here: here.parent().unwrap_or(Path::new("")).to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::Kept;
    use crate::files::Outside;
    use crate::files::base::Base;

    /// What was read once is read again although it is gone, here and where only what was kept is; what was not is not.
    #[test]
    fn what_was_read_stays() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("arms")).unwrap();
        for (path, text) in [("arms/a.toml", "a"), ("arms/a.urdf", "u"), ("late", "l")] {
            fs::write(folder.path().join(path), text).unwrap();
        }
        let base = Base::of(&folder.path().join("scenario.toml"), Outside::Refused);
        let kept = Kept::of(base);
        let text = |kept: &Kept, path: &str| kept.read(path, 10).map(|source| source.text.to_string());
        assert_eq!(text(&kept, "arms/a.toml").unwrap(), "a");
        assert_eq!(text(&kept.beside("arms/a.toml"), "a.urdf").unwrap(), "u");
        fs::remove_dir_all(folder.path().join("arms")).unwrap();
        for kept in [&kept, &Kept::holding(&kept.files())] {
            assert_eq!(text(kept, "arms/a.toml").unwrap(), "a");
            assert_eq!(text(&kept.beside("arms/a.toml"), "a.urdf").unwrap(), "u");
        }
        assert!(kept.clone().closed().read("late", 10).is_err());
        assert!(Kept::holding(&kept.files()).read("late", 10).is_err() && Path::new("late") != folder.path());
        assert_eq!(text(&kept, "late").unwrap(), "l");
    }
}
