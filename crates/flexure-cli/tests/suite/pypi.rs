//! What tests fetch from PyPI, into folders of their own under the target folder.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;

/// Whether tests that need PyPI are left out: `FLEXURE_OFFLINE=1` where it is out of reach.
pub fn is_out_of_reach() -> bool {
    let offline = std::env::var_os("FLEXURE_OFFLINE").is_some();
    if offline {
        println!("left out: FLEXURE_OFFLINE is set");
    }
    offline
}

pub fn run(program: &Path, arguments: &[&str]) -> Output {
    Command::new(program)
        .args(arguments)
        .env_remove("PYTHONPATH")
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}", program.display()))
}

/// Runs a program that has to succeed.
fn must(program: &Path, arguments: &[&str], help: &str) {
    let Output { status, stdout, stderr } = run(program, arguments);
    let (stdout, stderr) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    assert!(status.success(), "{} {arguments:?}: {help}\n{stdout}{stderr}", program.display());
}

const NO_PYTHON: &str = "Python 3.11 or newer with venv is needed (on Debian: apt-get install python3-venv)";
const NO_PYPI: &str = "PyPI is needed; FLEXURE_OFFLINE=1 leaves this test out";

/// The interpreter of the environment `name` with what the file at `wanted` asks for, made where there is none yet.
pub fn environment(name: &str, wanted: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let (python, done) = (folder.join("bin/python"), folder.join("requirements.txt"));
    let requirements = std::fs::read(wanted).unwrap();
    if std::fs::read(&done).ok() == Some(requirements.clone()) {
        return python;
    }
    must(Path::new("python3"), &["-m", "venv", "--clear", folder.to_str().unwrap()], NO_PYTHON);
    must(
        &python,
        &["-m", "pip", "install", "--quiet", "--no-compile", "--disable-pip-version-check", "-r", wanted],
        NO_PYPI,
    );
    std::fs::write(&done, requirements).unwrap();
    python
}

/// One test at a time fetches.
static FETCHING: Mutex<()> = Mutex::new(());

/// The unpacked wheel of a `package`, `name==version`, for the interpreter of `tag`, as `cp311`, or for any.
pub fn wheel(package: &str, tag: Option<&str>) -> PathBuf {
    let _alone = FETCHING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let top = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wheels");
    let folder = top.join(package);
    if folder.join("done").is_file() {
        return folder;
    }
    let pip = top.join("pip");
    must(Path::new("python3"), &["-m", "venv", "--clear", pip.to_str().unwrap()], NO_PYTHON);
    let python = pip.join("bin/python");
    let (fetched, unpacked) = (top.join("fetched"), folder.to_str().unwrap());
    let _ = std::fs::remove_dir_all(&fetched);
    let mut download = vec![
        "-m",
        "pip",
        "download",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        "--only-binary=:all:",
    ];
    let version = tag.map(|tag| tag.trim_start_matches("cp"));
    if let Some(version) = version {
        download.extend(["--python-version", version, "--platform", "manylinux2014_x86_64"]);
    }
    must(&python, &[&download[..], &["--dest", fetched.to_str().unwrap(), package]].concat(), NO_PYPI);
    let wheel = std::fs::read_dir(&fetched).unwrap().next().expect("a wheel").unwrap().path();
    must(&python, &["-m", "zipfile", "-e", wheel.to_str().unwrap(), unpacked], "a wheel is a zip archive");
    std::fs::remove_dir_all(&fetched).unwrap();
    std::fs::write(folder.join("done"), "").unwrap();
    folder
}
