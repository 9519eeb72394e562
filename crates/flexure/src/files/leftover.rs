//! Temporary files of runs that were killed: known by their names, and by nobody holding them.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile};

const BEFORE: &str = ".flexure-";
const AFTER: &str = ".tmp";

/// Random characters in a name.
const RANDOM: usize = 6;

/// A process of this number may be another one after so long.
const OLD: Duration = Duration::from_hours(1);

/// The temporary files of this process, those that have another name by now among them.
static OWN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes what this process has not finished writing: for a process that is about to end.
pub fn remove_unfinished() {
    for path in OWN.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        // What was finished has another name.
        let _ = fs::remove_file(path);
    }
}

/// A temporary file in `folder`, `.flexure-`, the number of the process, six random characters, `.tmp`, locked as long as it is open.
pub(crate) fn create(folder: &Path) -> std::io::Result<NamedTempFile> {
    let before = format!("{BEFORE}{}-", std::process::id());
    let mut builder = Builder::new();
    builder.prefix(&before).suffix(AFTER).rand_bytes(RANDOM);
    // As for any new file, before the umask: temporary files are private otherwise.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder)?;
    // Where there are no locks, nothing is ever removed either.
    let _ = file.as_file().try_lock();
    OWN.lock().unwrap_or_else(PoisonError::into_inner).push(file.path().to_owned());
    Ok(file)
}

/// Removes from `folder` what runs that were killed left there. Nobody is told of what cannot be removed.
pub(crate) fn remove(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let Some(process) = entry.file_name().to_str().and_then(process) else { continue };
        if is_abandoned(&entry.path(), process) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process in the name of a temporary file.
fn process(name: &str) -> Option<u32> {
    let (process, random) = name.strip_prefix(BEFORE)?.strip_suffix(AFTER)?.split_once('-')?;
    let ours = random.len() == RANDOM && random.bytes().all(|byte| byte.is_ascii_alphanumeric());
    // `parse` takes a sign.
    if ours && process.bytes().all(|byte| byte.is_ascii_digit()) { process.parse().ok() } else { None }
}

/// Whether the file at `path` is held by no program and its process is gone.
///
/// A lock goes with its program, on other machines and in other containers too; between creation and lock, the process
/// tells. Where processes cannot be seen, or the number is in use again, age does.
fn is_abandoned(path: &Path, process: u32) -> bool {
    let Ok(what) = fs::symlink_metadata(path) else { return false };
    if !what.is_file() {
        return false;
    }
    let processes = Path::new("/proc");
    let gone = processes.join("self").exists() && !processes.join(process.to_string()).exists();
    let old = what.modified().ok().and_then(|time| time.elapsed().ok()).is_some_and(|age| age > OLD);
    if !(gone || old) {
        return false;
    }
    match File::open(path).map(|file| file.try_lock()) {
        Ok(Ok(())) => true,
        Ok(Err(TryLockError::WouldBlock | TryLockError::Error(_))) | Err(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};
    use std::time::SystemTime;

    use super::{OLD, create, process, remove};

    /// No process has this number: the largest is 2²² on Linux.
    const NOBODY: u32 = u32::MAX;

    #[test]
    fn names_of_ours() {
        assert_eq!(process(".flexure-12-aB3dE6.tmp"), Some(12));
        for other in [
            ".flexure-12-aB3dE6",
            "flexure-12-aB3dE6.tmp",
            ".flexure-12-aB3dE.tmp",
            ".flexure-+12-aB3dE6.tmp",
            ".flexure--aB3dE6.tmp",
            ".flexure-12-aB/dE6.tmp",
            ".tmpaB3dE6",
            "arm.toml",
        ] {
            assert_eq!(process(other), None, "{other}");
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn only_what_nobody_holds_goes() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str| File::create(at(name)).unwrap();
        let [killed, held] = ["aaaaaa", "bbbbbb"].map(|random| format!(".flexure-{NOBODY}-{random}.tmp"));
        drop(write(&killed));
        let holder = write(&held);
        holder.lock().unwrap();
        let (us, before) = (std::process::id(), SystemTime::now() - 2 * OLD);
        let [recent, aged] = ["cccccc", "dddddd"].map(|random| format!(".flexure-{us}-{random}.tmp"));
        drop(write(&recent));
        write(&aged).set_modified(before).unwrap();
        let kept = [".tmpaaaaaa", "arm.toml", &format!(".flexure-{NOBODY}-eeeeee.toml")].map(|name| {
            write(name).set_modified(before).unwrap();
            name.to_owned()
        });
        fs::create_dir(at(&format!(".flexure-{NOBODY}-ffffff.tmp"))).unwrap();
        let open = create(folder.path()).unwrap();
        remove(folder.path());
        assert!(!at(&killed).exists() && !at(&aged).exists());
        assert!(at(&held).exists() && at(&recent).exists() && open.path().exists());
        assert!(
            kept.iter().all(|name| at(name).exists())
                && at(&format!(".flexure-{NOBODY}-ffffff.tmp")).exists()
        );
        drop(holder);
        remove(folder.path());
        assert!(!at(&held).exists());
    }
}
