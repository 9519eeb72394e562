//! `flexure check`: are these files good?

use std::path::{Path, PathBuf};

use flexure::check::{Along, Assumed, Findings};
use flexure::files::{Problem, Reading, create_folder, prepare, prepare_for};
use flexure::report::{joint_table, response_figure, stem, usage_table, write_figure};
use serde::Serialize;

use super::print;
use crate::complaint::Complaint;
use crate::failure::{Failure, say};

/// What is said of a file.
#[derive(Serialize)]
struct Verdict {
    file: String,
    ok: bool,
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    content: Option<Findings>,
    warnings: Vec<Complaint>,
    errors: Vec<Complaint>,
    /// Figures that were drawn; not there without `--figure`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<PathBuf>,
}

impl Verdict {
    /// Limits that the reference of a good file exceeds, and that its loop is unstable.
    fn exceeded(&self) -> &[Problem] {
        self.content.as_ref().map_or(&[], |content| &content.exceeded)
    }
}

pub fn check(
    files: &[String],
    figure: Option<&Path>,
    reading: Reading<'_>,
    json: bool,
) -> Result<(), Failure> {
    figure.map_or(Ok(()), prepare)?;
    let mut verdicts: Vec<_> = files.iter().map(|file| verdict(file, reading, json)).collect();
    if let Some(folder) = figure.filter(|_| verdicts.iter().all(|verdict| verdict.content.is_some())) {
        draw(&mut verdicts, folder)?;
    }
    if json {
        print::json(&verdicts)?;
    } else {
        verdicts.iter().try_for_each(show)?;
    }
    let bad = verdicts.iter().filter(|verdict| verdict.content.is_none()).count();
    match bad {
        0 => match verdicts.iter().flat_map(Verdict::exceeded).cloned().collect::<Vec<_>>() {
            none if none.is_empty() => Ok(()),
            exceeded => Err(Failure::No(exceeded.into_iter().map(Into::into).collect())),
        },
        // Of one file everything has been said.
        1 if files.len() == 1 => Err(Failure::Input(Vec::new())),
        bad => Err(Failure::input(
            "check",
            format!("{bad} of {} cannot be used", counted(files.len(), "file")),
            "each file's problems are listed above",
        )),
    }
}

/// Draws how the joints of each robot answer over frequency; robots of one name have numbers behind it.
fn draw(verdicts: &mut [Verdict], folder: &Path) -> Result<(), Failure> {
    let mut names: Vec<String> = Vec::new();
    for Findings { robot_name, .. } in verdicts.iter().filter_map(|verdict| verdict.content.as_ref()) {
        let numbered = (2..).map(|number| format!("{robot_name}-{number}"));
        let mut candidates = std::iter::once(robot_name.clone()).chain(numbered);
        names.extend(candidates.find(|name| !names.contains(name)));
    }
    let name = |robot: &String| stem(robot, "response");
    let files =
        names.iter().flat_map(|robot| ["svg", "png"].map(|ending| format!("{}.{ending}", name(robot))));
    prepare_for(folder, files)?;
    create_folder(folder)?;
    for (verdict, robot) in verdicts.iter_mut().zip(&names) {
        let Some(Findings { robot_name, rows, .. }) = &verdict.content else { continue };
        verdict.files = write_figure(folder, &name(robot), &response_figure(robot_name, rows))?.to_vec();
    }
    Ok(())
}

/// What is in a file, on the terminal.
fn show(verdict: &Verdict) -> Result<(), Failure> {
    let Some(content) = &verdict.content else { return Ok(()) };
    let Findings {
        kind, name, joints, assumptions, assumed, robot, reference, starting_gains, sampled, ..
    } = content;
    print::line(&format!(
        "{}: {kind} {name}, {}, {}, {}",
        verdict.file,
        counted(*joints, "joint"),
        counted(*assumptions, "assumption"),
        counted(verdict.warnings.len(), "warning"),
    ))?;
    if let Some(rows) = robot {
        print::line(&joint_table(rows, print::columns()))?;
        for Assumed { key, value, note } in assumed {
            print::line(&format!("assumed: {key} = {value}: {note}"))?;
        }
    }
    if let Some(Along { joints, scaled, speed, usage }) = reference {
        if *scaled {
            print::line(&format!("the reference is run along at {speed:.5} of its own speed"))?;
        }
        if !usage.is_empty() {
            print::line(&usage_table(joints, usage, print::columns()))?;
        }
    }
    if let Some(gains) = starting_gains {
        print::line(&format!("gains by the starting rule:\n{gains}"))?;
    }
    if let Some(sampled) = sampled {
        print::line(&sampled.line())?;
    }
    print::wrote(&verdict.files)
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn verdict(file: &str, reading: Reading<'_>, json: bool) -> Verdict {
    match Findings::of_file(file, reading) {
        Ok(content) => {
            if !json {
                say(&content.warnings);
            }
            Verdict {
                file: file.to_owned(),
                ok: content.exceeded.is_empty(),
                warnings: content.warnings.iter().map(Complaint::from).collect(),
                errors: content.exceeded.iter().map(Complaint::from).collect(),
                content: Some(content),
                files: Vec::new(),
            }
        }
        Err(problems) => {
            if !json {
                say(problems.iter());
            }
            let (warnings, errors): (Vec<_>, Vec<_>) =
                problems.iter().partition(|problem| problem.is_warning());
            let complaints = |problems: Vec<&Problem>| problems.into_iter().map(Complaint::from).collect();
            Verdict {
                file: file.to_owned(),
                ok: false,
                content: None,
                files: Vec::new(),
                warnings: complaints(warnings),
                errors: complaints(errors),
            }
        }
    }
}
