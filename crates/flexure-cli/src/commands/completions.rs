//! `flexure completions`: what a shell needs to complete the command's words.

use clap_complete::{Shell, generate};
use serde::Serialize;

use super::print;
use crate::failure::Failure;
use crate::grammar;

/// A script as a document.
#[derive(Serialize)]
struct Completions {
    shell: String,
    script: String,
}

pub fn completions(shell: Shell, json: bool) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(shell, &mut grammar::command(), "flexure", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    if json { print::json(&Completions { shell: shell.to_string(), script }) } else { print::text(&script) }
}
