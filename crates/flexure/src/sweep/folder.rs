//! The folder of a sweep: what it is, and a file for each shard that is done.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::parquet::{Columns, beside, empty, read};
use super::{Statistics, Sweep};
use crate::files::{
    Problem, Problems, Unfinished, WriteError, create_folder, read_text, suggest, write_atomic,
    write_together,
};
use crate::progress::Progress;

/// The file that says what sweep a folder is of.
pub const MANIFEST: &str = "sweep.json";

/// Largest of them.
const LARGEST: u64 = 256 << 20;

/// Name of the file of a shard.
pub fn part_name(shard: u64) -> String {
    format!("part-{shard:05}.parquet")
}

/// The shard whose file has this name.
fn shard_of(name: &str) -> Option<u64> {
    let number = name.strip_prefix("part-")?.strip_suffix(".parquet")?;
    let shard = number.parse().ok()?;
    (part_name(shard) == name).then_some(shard)
}

/// The folder of a sweep.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// The folder at `path` for this sweep, made if it is missing. What is there of it stays.
    ///
    /// # Errors
    /// If it is of another sweep, or cannot be written.
    pub fn of(sweep: &Sweep, path: &Path) -> Result<Self, Unfinished> {
        create_folder(path)?;
        let folder = Self { path: path.to_owned() };
        let manifest = path.join(MANIFEST);
        if !manifest.exists() {
            if let Some(shard) = folder.parts()?.first() {
                let message = format!("{} has {} and no {MANIFEST}", path.display(), part_name(*shard));
                return Err(Problem::new("occupied", message, "name another folder with --out").into());
            }
            match write_together(&[(manifest, &sweep.document())], false) {
                // Another program was first.
                Err(WriteError::Exists { .. }) => {}
                Err(WriteError::Content { cause, .. }) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                written => written?,
            }
        }
        let (_, there) = Self::open(path)?;
        if there.identity() != sweep.identity() {
            let message = format!(
                "{} is of another sweep: {}, {} rows",
                path.display(),
                suggest::quoted(there.name()),
                there.rows()
            );
            let help =
                "name another folder with --out, or bring the files of the sweep back to what they were";
            return Err(Problem::new("occupied", message, help).into());
        }
        Ok(folder)
    }

    /// The folder at `path`, and its sweep.
    ///
    /// # Errors
    /// If it is not of a sweep.
    pub fn open(path: &Path) -> Result<(Self, Sweep), Problems> {
        let manifest = path.join(MANIFEST);
        if !manifest.is_file() {
            let message = format!("{} has no {MANIFEST}: it is no folder of a sweep", path.display());
            return Err(Problem::new("unreadable", message, "name what `flexure sweep --out` named").into());
        }
        let sweep = Sweep::from_document(&read_text(&manifest, LARGEST)?)?;
        Ok((Self { path: path.to_owned() }, sweep))
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The shards that are there.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn parts(&self) -> Result<BTreeSet<u64>, Problem> {
        let unreadable = |error: io::Error| {
            let message = format!("cannot read {}: {error}", self.path.display());
            Problem::new("unreadable", message, "name the folder of a sweep")
        };
        let mut found = BTreeSet::new();
        for entry in fs::read_dir(&self.path).map_err(unreadable)? {
            found.extend(entry.map_err(unreadable)?.file_name().to_str().and_then(shard_of));
        }
        Ok(found)
    }

    /// Computes the shards in `range` that are not there, one after the other, the rows of each side by side; a shard is there as
    /// soon as it is written. `progress` is told the fraction of `range` that is there. Returns how many were computed.
    ///
    /// # Errors
    /// If one cannot be written, and [`Problems::interrupted`] if it was broken off: what was written until then stays.
    pub fn complete(
        &self,
        sweep: &Sweep,
        range: Range<u64>,
        progress: Progress<'_>,
    ) -> Result<u64, Unfinished> {
        let there = self.parts()?;
        let count = (range.end - range.start) as f64;
        let missing: Vec<u64> = range.filter(|shard| !there.contains(shard)).collect();
        for (done, &shard) in missing.iter().enumerate() {
            let before = count - missing.len() as f64 + done as f64;
            let bytes = sweep.shard(shard, &|fraction| progress((before + fraction) / count))?;
            self.write(shard, &bytes)?;
        }
        Ok(missing.len() as u64)
    }

    /// Writes the file of a shard, whole or not at all.
    fn write(&self, shard: u64, bytes: &[u8]) -> Result<(), WriteError> {
        write_atomic(&self.path.join(part_name(shard)), |out| out.write_all(bytes))
    }

    /// What the rows that are there come to; only the ends of the files are read.
    ///
    /// # Errors
    /// If a file is damaged, or of another sweep.
    pub fn statistics(&self, sweep: &Sweep) -> Result<Statistics, Problems> {
        let mut statistics = Statistics::none(sweep);
        for shard in self.parts()? {
            let found = beside(&self.part(shard)?).and_then(|found| found.of(sweep, shard));
            statistics.absorb(&found.map_err(|error| self.damaged(shard, &error))?);
        }
        Ok(statistics)
    }

    /// Columns of the rows that are there, by their names, in the order of the rows.
    ///
    /// # Errors
    /// If there is no such column, or a file is damaged.
    pub fn columns(&self, sweep: &Sweep, names: &[String]) -> Result<Columns, Problems> {
        let mut columns = empty(sweep, names)?;
        for shard in self.parts()? {
            let file = fs::read(self.path.join(part_name(shard))).map_err(|error| error.to_string());
            let read = file.and_then(|file| read(sweep, shard, file, &mut columns));
            read.map_err(|error| self.damaged(shard, &error))?;
        }
        Ok(columns)
    }

    fn part(&self, shard: u64) -> Result<File, Problem> {
        File::open(self.path.join(part_name(shard))).map_err(|error| self.damaged(shard, &error.to_string()))
    }

    fn damaged(&self, shard: u64, why: &str) -> Problem {
        let message = format!("{}: {why}", self.path.join(part_name(shard)).display());
        Problem::new("damaged", message, "remove the file and run the sweep again: it is computed anew")
    }
}
