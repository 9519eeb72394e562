//! Pages that name code name code that exists; the files that the README shows load.

use std::fs;
use std::path::Path;

use flexure::robot::load_robot;
use flexure::scenario::load_scenario;

use crate::common::root;

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The text of every Rust file at or below `path`.
fn sources(path: &Path) -> String {
    if path.is_file() {
        return fs::read_to_string(path).expect("readable");
    }
    let mut entries: Vec<_> =
        fs::read_dir(path).into_iter().flatten().map(|entry| entry.expect("readable").path()).collect();
    entries.sort();
    entries.retain(|path| path.is_dir() || path.extension().is_some_and(|e| e == "rs"));
    entries.iter().map(|path| sources(path)).collect()
}

/// `name` as a file `name.rs` or a folder.
fn module(folder: &Path, name: &str) -> String {
    sources(&folder.join(name)) + &sources_if_file(&folder.join(format!("{name}.rs")))
}

fn sources_if_file(path: &Path) -> String {
    if path.is_file() { sources(path) } else { String::new() }
}

/// Whether `text` says `before` + `name` and the name ends there.
fn declares(text: &str, before: &str, name: &str) -> bool {
    let pattern = format!("{before}{name}");
    text.match_indices(&pattern).any(|(at, _)| {
        let next = text[at + pattern.len()..].chars().next();
        !next.is_some_and(|c| c.is_alphanumeric() || c == '_')
    })
}

/// `module::Type::function` of `flexure_core`, or `flexure::…`.
fn function_exists(path: &str) -> bool {
    let (krate, path) =
        path.strip_prefix("flexure::").map_or(("flexure-core", path), |path| ("flexure", path));
    let mut parts = path.split("::");
    let name = parts.next().unwrap_or_default();
    let text = module(&root().join("crates").join(krate).join("src"), name);
    let rest: Vec<_> = parts.collect();
    let item = |name: &str| {
        ["pub mod ", "pub struct ", "pub enum ", "pub trait ", "pub type ", "pub fn ", "    fn ", "    pub "]
            .iter()
            .any(|kind| declares(&text, kind, name))
    };
    !text.is_empty() && !rest.is_empty() && rest.iter().all(|name| item(name))
}

/// `file::function` in the `tests` folder of either crate.
fn test_exists(path: &str) -> bool {
    let Some((file, name)) = path.split_once("::") else { return false };
    ["flexure-core/tests/suite", "flexure-core/tests/laws", "flexure/tests/suite"].iter().any(|folder| {
        let text = module(&root().join("crates").join(folder), file);
        declares(&text, "#[test]\nfn ", name)
    })
}

/// The code spans of a line.
fn spans(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// The cells of every row of the tables whose heading has `title` as its column `column`.
fn column<'a>(page: &'a str, title: &str, column: usize) -> Vec<&'a str> {
    let cell = |line: &'a str| line.split(" | ").nth(column).map(|cell| cell.trim_matches([' ', '|']));
    let mut cells = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        let content = cell(line).filter(|_| line.starts_with('|'));
        match content {
            None => inside = false,
            Some(heading) if heading == title => inside = true,
            Some(content) if inside && !content.starts_with("---") => cells.push(content),
            Some(_) => {}
        }
    }
    cells
}

#[test]
fn named_functions_and_tests_exist() {
    let (equations, errata) = (page("docs/equations.md"), page("docs/errata.md"));
    let functions = column(&equations, "function", 2);
    let tests = [column(&equations, "test", 3), column(&errata, "test", 5)].concat();
    assert!(functions.len() > 30 && tests.len() > 47, "{} and {}", functions.len(), tests.len());
    for name in functions.into_iter().flat_map(spans) {
        assert!(function_exists(name), "docs/equations.md names {name}");
    }
    for name in tests.into_iter().flat_map(spans) {
        assert!(test_exists(name), "docs/equations.md or docs/errata.md name {name}");
    }
}

#[test]
fn names_that_are_gone_are_missed() {
    assert!(function_exists("model::Fjr::hamiltonian") && !function_exists("model::Fjr::hamilton"));
    assert!(!function_exists("model::Robot::hamiltonian") && !function_exists("hamiltonian"));
    assert!(test_exists("errata::a_measure_is_a_one_sided_limit") && !test_exists("errata::a_measure"));
}

/// Every regression test of a slip stands in the table of slips.
#[test]
fn every_slip_test_is_in_the_table() {
    let errata = page("docs/errata.md");
    let tests = sources(&root().join("crates/flexure/tests/suite/errata.rs"));
    for (_, rest) in tests.match_indices("#[test]\nfn ").map(|(at, text)| (at, &tests[at + text.len()..])) {
        let name = rest.split('(').next().unwrap_or_default();
        assert!(errata.contains(&format!("`errata::{name}`")), "{name} is not in docs/errata.md");
    }
}

/// The other people's crates that a manifest names under `[section]`.
fn dependencies(manifest: &str, section: &str) -> Vec<String> {
    let lines = manifest.lines().skip_while(|line| *line != section).skip(1);
    let entries = lines
        .take_while(|line| !line.starts_with('['))
        .filter(|line| !line.contains("path = ") && !line.contains(".workspace"));
    let names = entries.filter_map(|line| line.split_once(" = ").map(|(name, _)| name.to_owned()));
    names.collect()
}

/// Who adds a dependency says what it is for and what it costs.
#[test]
fn every_dependency_has_its_line() {
    let listed = page("docs/dependencies.md");
    let mut count = 0;
    for folder in ["core-math", "flexure-core", "flexure", "flexure-cli"] {
        let manifest = page(&format!("crates/{folder}/Cargo.toml"));
        for section in ["[dependencies]", "[build-dependencies]", "[dev-dependencies]"] {
            for name in dependencies(&manifest, section) {
                assert!(listed.contains(&format!("| `{name}` |")), "{name} is not in docs/dependencies.md");
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}

/// The README's TOML blocks, each under the file name in its first line.
#[test]
fn the_files_of_the_readme_load() {
    let readme = page("README.md");
    let folder = tempfile::tempdir().expect("a folder");
    let blocks: Vec<_> = readme
        .split("```toml\n")
        .skip(1)
        .map(|block| block.split("```").next().unwrap_or_default())
        .collect();
    assert_eq!(blocks.len(), 2);
    for block in blocks {
        let name = block.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a file name");
        fs::write(folder.path().join(name), block).expect("written");
    }
    let path = |name: &str| folder.path().join(name).display().to_string();
    let robot = load_robot(&path("my-arm.toml")).expect("a good robot");
    assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
    let scenario = load_scenario(&path("my-test.toml")).expect("a good scenario");
    assert!(scenario.warnings.is_empty(), "{:?}", scenario.warnings);
}

/// Every example of CONTRIBUTING.md, under the path in its first line, stands like that in the file.
#[test]
fn the_recipes_quote_what_is_compiled() {
    let contributing = page("CONTRIBUTING.md");
    let mut quoted = 0;
    for block in contributing.split("```rust\n// ").skip(1) {
        let (path, rest) = block.split_once('\n').expect("a path in the first line");
        let (code, _) = rest.split_once("```").expect("an end");
        assert!(page(path).contains(code), "{path} is not what CONTRIBUTING.md quotes");
        quoted += 1;
    }
    assert!(quoted >= 7, "{quoted} examples");
}
