//! Readers that go away, and streams that take nothing.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

use crate::command::{Outcome, Place};

/// Enough states that their answers fill any pipe.
fn many_states() -> String {
    "{\"q_l\": [0, 0], \"q_m\": [0, 0], \"dq_l\": [0, 0], \"dq_m\": [0, 0]}\n".repeat(5000)
}

#[test]
fn a_reader_that_leaves_after_a_line_is_no_error() {
    let place = Place::new();
    place.write("states.jsonl", many_states());
    for json in [&[][..], &["--json"]] {
        let args = [&["eval", "two-link-tanh", "--states", "states.jsonl"], json].concat();
        let mut child = place.command(&args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert!(!line.is_empty());
        let outcome = Outcome::from(child.wait_with_output().unwrap());
        assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    }
}

#[test]
fn a_message_that_nobody_reads_changes_no_exit_code() {
    let place = Place::new();
    let mut child = place.command(&["run", "none.toml"]).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_behind_stdout_is_said() {
    let place = Place::new();
    let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = place.command(&["list"]).stdout(full).output().unwrap();
    Outcome::from(output).refused(&["cannot write to stdout"]);
}
