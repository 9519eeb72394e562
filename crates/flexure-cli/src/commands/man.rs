//! `flexure man`: the manual pages.

use std::io;
use std::path::{Path, PathBuf};

use clap::Command;
use clap_mangen::Man;
use flexure::files::{prepare, write_atomic};
use serde::Serialize;

use super::print;
use crate::failure::Failure;
use crate::grammar;

/// The page of the program, and where pages were written.
#[derive(Serialize)]
struct Pages {
    page: String,
    files: Vec<PathBuf>,
}

pub fn man(folder: Option<&Path>, json: bool) -> Result<(), Failure> {
    let mut program = grammar::command();
    program.build();
    let page = page(&program)?;
    let Some(folder) = folder else {
        return if json { print::json(&Pages { page, files: Vec::new() }) } else { print::text(&page) };
    };
    prepare(folder)?;
    let commands = program.get_subcommands().filter(|command| command.get_name() != "help");
    let mut files = Vec::new();
    for command in std::iter::once(&program).chain(commands) {
        let name = command.get_display_name().unwrap_or(command.get_name());
        let path = folder.join(format!("{name}.1"));
        let page = self::page(command)?;
        write_atomic(&path, |out| out.write_all(page.as_bytes()))?;
        files.push(path);
    }
    if json {
        return print::json(&Pages { page, files });
    }
    print::wrote(&files)
}

/// The page of a command, as troff.
fn page(command: &Command) -> Result<String, io::Error> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let source = format!("flexure {}", env!("CARGO_PKG_VERSION"));
    let page = Man::new(command.clone()).title(name.to_uppercase()).source(source).manual("Flexure");
    let mut text = Vec::new();
    page.render(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    // A page without a date has an empty one, and what comes last are exit codes and examples.
    Ok(text.replacen(" 1  \"", " 1 \"\" \"", 1).replacen(".SH EXTRA", ".SH NOTES", 1))
}
