//! Python with what a checker needs: taken from the interpreter if it is there, else from PyPI into a virtual environment under the target folder.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use super::root;

/// What comes of the program; none if there is no such program.
pub fn run(program: &Path, arguments: &[&str]) -> Option<Output> {
    Command::new(program).args(arguments).env_remove("PYTHONPATH").output().ok()
}

fn succeeds(program: &Path, arguments: &[&str]) -> bool {
    run(program, arguments).is_some_and(|output| output.status.success())
}

/// Exit code and words of the checker `script`, which python-flint is enough for, on a file with `text`, so many of whose parts are followed; none where that cannot be had.
pub fn checked(script: &str, text: &str, sample: usize) -> Option<(i32, String)> {
    static INTERPRETER: LazyLock<Option<PathBuf>> = LazyLock::new(|| with("flint", "python-flint==0.9.0"));
    let interpreter = INTERPRETER.as_deref()?;
    let place = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(&place, text).unwrap();
    let script = root().join("tools").join(script);
    let options = [script.to_str().unwrap(), "--sample", &sample.to_string(), place.path().to_str().unwrap()];
    let output = run(interpreter, &options).unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    Some((output.status.code().unwrap(), said))
}

/// An interpreter that can import `module`, which the `package` of PyPI has; none if it cannot and `FLEXURE_OFFLINE` is set. To be called once a process: tests side by
/// side wait for the one that makes it.
pub fn with(module: &str, package: &str) -> Option<PathBuf> {
    let python = PathBuf::from("python3");
    let import = format!("import {module}");
    if succeeds(&python, &["-c", &import]) {
        return Some(python);
    }
    if std::env::var_os("FLEXURE_OFFLINE").is_some() {
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(module);
    let own = folder.join("bin/python");
    if !succeeds(&own, &["-c", &import]) {
        let made = succeeds(&python, &["-m", "venv", "--clear", folder.to_str().unwrap()]);
        assert!(made, "Python 3.11 or newer with venv is needed (on Debian: apt-get install python3-venv)");
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", package];
        assert!(succeeds(&own, &install), "PyPI is needed; FLEXURE_OFFLINE=1 leaves this test out");
    }
    Some(own)
}
