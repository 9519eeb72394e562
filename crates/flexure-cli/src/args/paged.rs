//! Where the page of an answer goes.

use std::path::{Path, PathBuf};

use clap::Args;
use flexure::files::prepare_for;
use flexure::report::{page_names, stem};

use crate::failure::Failure;

/// Where the page of an answer goes.
#[derive(Debug, Args)]
pub struct Paged {
    /// Write a page with the answer as a picture and in numbers into this folder, too; created if missing.
    #[arg(long, value_name = "FOLDER")]
    pub page: Option<PathBuf>,
}

impl Paged {
    /// What is said of what was broken off: `hint`, and that no page was written, if one was asked for.
    pub fn broken_off(&self, hint: &str) -> String {
        // Of a part a page would be taken for the whole.
        if self.page.is_some() {
            format!("{hint}; no page is written of what was broken off")
        } else {
            hint.to_owned()
        }
    }

    /// That a page about `name` with so many figures can be written, if one is asked for, and that it is not in the place of one of the other `files`:
    /// said before the work, not after.
    pub fn prepare(
        &self,
        name: &str,
        command: &str,
        figures: usize,
        files: &[impl AsRef<Path>],
    ) -> Result<(), Failure> {
        let Some(folder) = &self.page else { return Ok(()) };
        let names = page_names(&stem(name, command), figures);
        let place = |path: &Path| std::path::absolute(path).ok();
        let taken = |file: &&Path| {
            std::iter::once(folder.clone())
                .chain(names.iter().map(|name| folder.join(name)))
                .any(|path| place(&path) == place(file))
        };
        if let Some(file) = files.iter().map(AsRef::as_ref).find(taken) {
            let message = format!("{} is what --out writes, and where the page goes", file.display());
            return Err(Failure::input("usage", message, "give the page a folder of its own"));
        }
        Ok(prepare_for(folder, names)?)
    }
}
