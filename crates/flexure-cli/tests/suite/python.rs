//! The Python package: its wheel is built, put into an environment of the test's own, and what is claimed of it is run by pytest; its
//! types are held against it.
//!
//! The wheel is of the profile and the features that everything else is tested with, so that it shares the library. Set
//! `FLEXURE_OFFLINE=1` to leave the test out where PyPI is out of reach.

use std::path::Path;
use std::process::Command;

use crate::pypi::{environment, is_out_of_reach};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
const TESTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../flexure-python/tests");

/// Runs a program in the root of the repository; it has to succeed.
fn must(program: &Path, arguments: &[&str]) -> String {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(ROOT)
        .env("FLEXURE", env!("CARGO_BIN_EXE_flexure"))
        .env_remove("PYTHONPATH");
    let output = command.output().unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    let text =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{} {arguments:?}:\n{text}", program.display());
    text
}

#[test]
fn the_wheel_does_what_is_claimed() {
    if is_out_of_reach() {
        return;
    }
    let python = environment("python", &format!("{TESTS}/requirements.txt"));
    let (tmp, bin) = (Path::new(env!("CARGO_TARGET_TMPDIR")), python.parent().unwrap());
    let (target, wheels) = (tmp.parent().unwrap(), tmp.join("flexure-wheel"));
    let _ = std::fs::remove_dir_all(&wheels);
    let [target, out] = [target, &wheels].map(|path| path.to_str().unwrap());
    let interpreter = python.to_str().unwrap();
    must(
        &bin.join("maturin"),
        &[
            "build",
            "--quiet",
            "--release",
            "--features",
            "as-tested",
            "--target-dir",
            target,
            "--out",
            out,
            "-i",
            interpreter,
        ],
    );
    let wheel = std::fs::read_dir(&wheels).unwrap().next().expect("a wheel").unwrap().path();
    let install =
        ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--force-reinstall"];
    must(&python, &[&install[..], &[wheel.to_str().unwrap()]].concat());
    println!("{}", must(&python, &["-m", "pytest", "--quiet", "-p", "no:cacheprovider", TESTS]));
    must(&python, &["-m", "mypy.stubtest", "flexure", "--mypy-config-file", "pyproject.toml"]);
    must(
        &python,
        &[
            "-m",
            "mypy",
            "--cache-dir",
            "/dev/null",
            "--config-file",
            "pyproject.toml",
            "crates/flexure-python/python",
        ],
    );
}
