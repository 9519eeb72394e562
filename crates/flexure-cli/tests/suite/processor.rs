//! Builds of the program for several sets of instructions, beside each other.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// A folder with a copy of the program, and files beside it that stand for other builds and say so.
fn folder(builds: &[(&str, bool)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(env!("CARGO_BIN_EXE_flexure"), folder.path().join("flexure")).expect("a copy");
    for (set, runs) in builds {
        let file = folder.path().join(format!("flexure-{set}"));
        fs::write(&file, format!("#!/bin/sh\necho {set} $*\nexit 7\n")).expect("written");
        let mode = if *runs { 0o755 } else { 0o644 };
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).expect("made a program");
    }
    folder
}

fn list(folder: &Path, at_most: Option<&str>) -> Output {
    let mut command = Command::new(folder.join("flexure"));
    command.args(["list", "robots"]);
    if let Some(set) = at_most {
        command.env("FLEXURE_INSTRUCTIONS", set);
    }
    command.output().expect("it runs")
}

fn says(output: &Output, what: &str) -> bool {
    String::from_utf8_lossy(&output.stdout).contains(what)
}

/// The program that tests are of is built for AVX2: where the processor has AVX-512, that build goes on, with the same arguments and its exit code;
/// no build for less does.
#[test]
fn the_build_for_the_most_instructions_goes_on() {
    let folder = folder(&[("x86-64-v3", true), ("x86-64-v4", true)]);
    let free = list(folder.path(), None);
    let held = list(folder.path(), Some("x86-64-v3"));
    assert!(held.status.success() && says(&held, "quanser-2dof"), "{held:?}");
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512vl") && is_x86_feature_detected!("avx512bw") {
        assert_eq!(String::from_utf8_lossy(&free.stdout), "x86-64-v4 list robots\n");
        assert_eq!(free.status.code(), Some(7));
        return;
    }
    assert!(free.status.success() && says(&free, "quanser-2dof"), "{free:?}");
}

/// What lies there and does not run is named, and the work is done.
#[test]
fn a_build_that_does_not_run_is_named() {
    let folder = folder(&[("x86-64-v4", false)]);
    let output = list(folder.path(), None);
    assert!(output.status.success() && says(&output, "quanser-2dof"), "{output:?}");
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512vl") && is_x86_feature_detected!("avx512bw") {
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(error.contains("flexure-x86-64-v4 does not run (Permission denied"), "{error}");
    }
}

/// A set that does not exist is named with those that do; nothing runs.
#[test]
fn a_set_that_is_unknown_is_refused() {
    let folder = folder(&[]);
    for set in ["avx2", "", "x86-64-v5"] {
        let output = list(folder.path(), Some(set));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{output:?}");
        assert!(error.contains(&format!("FLEXURE_INSTRUCTIONS is '{set}', must be one of")), "{error}");
    }
}
