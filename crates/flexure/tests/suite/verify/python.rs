//! The second checker, in Python, says the same of every certificate and every mutant.
//!
//! Set `FLEXURE_OFFLINE=1` to leave the test out where mpmath cannot be had.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use super::mutants::all;
use super::{CERTIFICATES, tree_with_a_rod};
use crate::common::python;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tools/check_certificate.py");

/// An interpreter that has mpmath; none offline without it.
static INTERPRETER: LazyLock<Option<PathBuf>> = LazyLock::new(|| python::with("mpmath", "mpmath==1.3.0"));

/// Exit code and lines for these texts, a file each.
fn checked(interpreter: &Path, texts: &[impl AsRef<[u8]>]) -> (Option<i32>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<_> = (0..texts.len()).map(|i| folder.path().join(format!("{i}.json"))).collect();
    for (file, text) in files.iter().zip(texts) {
        std::fs::write(file, text).unwrap();
    }
    let names = files.iter().map(|file| file.to_str().unwrap());
    let output = python::run(interpreter, &[SCRIPT].into_iter().chain(names).collect::<Vec<_>>()).unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<_> = said.lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), texts.len(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    (output.status.code(), lines)
}

/// The exit code that a line stands for.
fn code(line: &str) -> i32 {
    if line.contains(".json: proved: ") {
        0
    } else if line.contains(".json: does not hold: ") {
        1
    } else {
        assert!(line.contains(".json: not a certificate: "), "{line}");
        2
    }
}

/// What the second checker says of each text, as an exit code; none where it cannot be run.
pub fn codes(texts: &[impl AsRef<[u8]>]) -> Option<Vec<i32>> {
    let (_, lines) = checked(INTERPRETER.as_deref()?, texts);
    Some(lines.iter().map(|line| code(line)).collect())
}

#[test]
fn the_second_checker_agrees_on_certificates_and_on_every_mutant() {
    let Some(python) = INTERPRETER.as_deref() else {
        println!("left out: FLEXURE_OFFLINE is set and python3 has no mpmath");
        return;
    };
    let (exit, lines) = checked(python, &CERTIFICATES.map(|(_, text)| text));
    assert_eq!(exit, Some(0), "{lines:#?}");
    assert!(
        lines[4].contains("contraction 0.295981115 1/s, convergence 9.950547537 1/s, checked in"),
        "{}",
        lines[4]
    );
    let (exit, lines) = checked(python, &[&tree_with_a_rod()]);
    assert_eq!(exit, Some(0), "{lines:#?}");
    let mutants = all();
    let texts: Vec<_> = mutants.iter().map(|mutant| mutant.text.as_str()).collect();
    for (mutants, texts) in mutants.chunks(500).zip(texts.chunks(500)) {
        let (exit, lines) = checked(python, texts);
        assert_eq!(exit, lines.iter().map(|line| code(line)).max());
        for (mutant, line) in mutants.iter().zip(&lines) {
            assert_eq!(code(line), mutant.code(), "{}: {line}", mutant.name);
        }
    }
    println!("{} mutants", mutants.len());
}

#[test]
fn the_second_checker_is_not_impressed_by_what_is_no_certificate() {
    let Some(python) = INTERPRETER.as_deref() else { return };
    let text = CERTIFICATES[0].1;
    let twice = text.replacen("\"version\": 1", "\"version\": 1, \"version\": 1", 1);
    let real = text.replacen("\"version\": 1", "\"version\": 1.0", 1);
    let truth = text.replacen("\"version\": 1", "\"version\": true", 1);
    let infinite = text.replacen("\"1.61\"", "\"1e400\"", 1);
    let (deep, many) = ("[".repeat(100_000), "9".repeat(100_000));
    let huge = text.replacen("\"1.61\"", &format!("\"{many}\""), 1);
    let joints = text.replacen("\"joints\": 1", &format!("\"joints\": {many}"), 1);
    let texts = ["", "null", "[]", "{}", "\"x\"", &twice, &real, &truth, &infinite, &deep, &huge, &joints];
    let (exit, lines) = checked(python, &texts);
    assert_eq!(exit, Some(2));
    assert!(lines.iter().all(|line| code(line) == 2), "{lines:#?}");
}
