//! Suites: one binary a crate, every file in it compiled, and every `cargo test` of pages, comments and tools runs something.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::root;

const CRATES: [&str; 3] = ["flexure-core", "flexure", "flexure-cli"];

/// `path` itself or the files below it, sorted.
fn files(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_path_buf()];
    }
    let mut entries: Vec<_> = fs::read_dir(path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        .map(|entry| entry.expect("readable").path())
        .collect();
    entries.sort();
    entries.iter().flat_map(|path| files(path)).collect()
}

fn suite(krate: &str) -> PathBuf {
    root().join("crates").join(krate).join("tests/suite")
}

/// The path of the module in a file: empty for the suite itself.
fn module(suite: &Path, file: &Path) -> Vec<String> {
    let path = file.strip_prefix(suite).expect("below the suite").with_extension("");
    let mut parts: Vec<_> = path.iter().map(|part| part.to_str().expect("UTF-8").to_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod" || last == "main") {
        parts.pop();
    }
    parts
}

/// The tests of a crate's suite as `module::name`.
fn tests(krate: &str) -> Vec<String> {
    let suite = suite(krate);
    let mut tests = Vec::new();
    for file in files(&suite) {
        let (module, text) = (module(&suite, &file), fs::read_to_string(&file).expect("UTF-8"));
        for (at, _) in text.match_indices("#[test]\n") {
            let name = text[at..].split("fn ").nth(1).and_then(|rest| rest.split('(').next());
            tests.push([&module[..], &[name.expect("a function").to_owned()]].concat().join("::"));
        }
    }
    tests
}

/// Whether a filter in a target of a crate runs a test.
fn runs(krate: &str, target: &str, filter: &str) -> bool {
    target == "suite" && CRATES.contains(&krate) && tests(krate).iter().any(|test| test.contains(filter))
}

/// Text with its lines joined and without the marks of comments, so that commands may be wrapped.
fn joined(text: &str) -> String {
    text.lines().map(|line| line.trim_start_matches([' ', '/', '!', '#'])).collect::<Vec<_>>().join(" ")
}

/// Crate, target and filter of every command with `--test`.
fn commands(text: &str) -> Vec<[String; 3]> {
    let text = joined(text);
    let command = |(at, _): (usize, &str)| {
        let words: Vec<_> =
            text[at..].split(['`', '"', '#']).next().unwrap_or_default().split_whitespace().collect();
        let after = |name: &str, k: usize| {
            let at = words.iter().position(|&word| word == name)?;
            words.get(at + k).map(|&word| word.to_owned())
        };
        let filter = after("--test", 2).filter(|word| !word.starts_with('-'));
        Some([after("-p", 1).unwrap_or_default(), after("--test", 1)?, filter.unwrap_or_default()])
    };
    text.match_indices("cargo test ").filter_map(command).collect()
}

#[test]
fn commands_run_tests() {
    let places = ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md", ".ci", "docs", "tools", "crates"];
    let mut count = 0;
    for file in places.iter().flat_map(|place| files(&root().join(place))) {
        let Ok(text) = fs::read_to_string(&file) else { continue };
        for [krate, target, filter] in commands(&text) {
            count += 1;
            assert!(runs(&krate, &target, &filter), "{}: {krate} {target} {filter}", file.display());
        }
    }
    assert!(count >= 7, "{count} commands");
}

#[test]
fn commands_that_run_nothing_are_missed() {
    assert!(runs("flexure-cli", "suite", "pinocchio") && !runs("flexure-core", "suite", "pinocchio"));
    assert!(runs("flexure", "suite", "verify::python::") && !runs("flexure", "suite", "python::verify::"));
    assert!(!runs("flexure", "schema", "") && !runs("", "suite", ""));
    let wrapped = "//! once (`cargo test --release -p flexure --test\n//! suite a::b`), twice: `cargo test --release --workspace`";
    assert_eq!(commands(wrapped), [["flexure", "suite", "a::b"].map(str::to_owned)]);
}

/// Rust has no word for a file that nobody declares: its tests would not run. One beside the suite would be another binary.
#[test]
fn every_file_is_a_module() {
    for krate in CRATES {
        let suite = suite(krate);
        let beside = fs::read_dir(suite.parent().expect("tests")).expect("readable");
        for path in beside.map(|entry| entry.expect("readable").path()) {
            let another = path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").is_file();
            // More than the compiler survives beside the others.
            let apart =
                ["capacity", "laws"].iter().any(|name| path.ends_with(format!("flexure-core/tests/{name}")));
            assert!(!another || path == suite || apart, "{} is not in the suite", path.display());
        }
        for file in files(&suite) {
            let module = module(&suite, &file);
            let Some((name, parents)) = module.split_last() else { continue };
            let parent = suite.join(parents.join("/"));
            let text =
                ["main.rs", "mod.rs"].iter().find_map(|name| fs::read_to_string(parent.join(name)).ok());
            let declared = text.is_some_and(|text| {
                text.lines().any(|line| line.trim_start_matches("pub ") == format!("mod {name};"))
            });
            assert!(declared, "{} is no module", file.display());
        }
    }
}

/// Paths of tests in the recipes are files.
#[test]
fn named_files_exist() {
    let recipes = fs::read_to_string(root().join("CONTRIBUTING.md")).expect("CONTRIBUTING.md");
    let paths: Vec<_> = recipes
        .split('`')
        .filter(|span| span.contains("tests/") && span.strip_suffix(".rs").is_some())
        .collect();
    assert!(!paths.is_empty(), "no recipe names a test");
    for path in paths {
        let exists = CRATES.iter().any(|krate| root().join("crates").join(krate).join(path).is_file())
            || root().join(path).is_file();
        assert!(exists, "CONTRIBUTING.md names {path}");
    }
}
