//! `flexure check`: are these files good?

use flexure::io::{self, Assumption, Checked, Problem, Problems};
use flexure::overview::{JointRow, overview};
use flexure::registry::supported;
use flexure::report::joint_table;
use serde::Serialize;

use super::print;
use crate::failure::{Failure, say};

/// What is said of a file.
#[derive(Serialize)]
struct Verdict {
    file: String,
    ok: bool,
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    content: Option<Content>,
    warnings: Vec<Complaint>,
    errors: Vec<Complaint>,
}

/// What is in a good file.
#[derive(Serialize)]
struct Content {
    kind: &'static str,
    name: String,
    joints: usize,
    assumptions: usize,
    /// What is assumed.
    assumed: Vec<Assumed>,
    /// Of a robot file.
    #[serde(skip_serializing_if = "Option::is_none")]
    robot: Option<Vec<JointRow>>,
}

/// A number that no source vouches for.
#[derive(Serialize)]
struct Assumed {
    key: String,
    value: String,
    note: String,
}

#[derive(Serialize)]
struct Complaint {
    message: String,
    hint: String,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
}

pub fn check(files: &[String], json: bool) -> Result<(), Failure> {
    let verdicts: Vec<_> = files.iter().map(|file| verdict(file, json)).collect();
    if json {
        print::json(&verdicts)?;
    } else {
        for verdict in &verdicts {
            if let Some(Content { kind, name, joints, assumptions, assumed, robot }) = &verdict.content {
                print::line(&format!(
                    "{}: {kind} {name}, {}, {}, {}",
                    verdict.file,
                    counted(*joints, "joint"),
                    counted(*assumptions, "assumption"),
                    counted(verdict.warnings.len(), "warning"),
                ))?;
                if let Some(rows) = robot {
                    print::line(&joint_table(rows))?;
                    for Assumed { key, value, note } in assumed {
                        print::line(&format!("assumed: {key} = {value}: {note}"))?;
                    }
                }
            }
        }
    }
    match verdicts.iter().filter(|verdict| !verdict.ok).count() {
        0 => Ok(()),
        // Of one file everything has been said.
        1 if files.len() == 1 => Err(Failure::Input(Vec::new())),
        bad => Err(Failure::input(
            "check",
            format!("{bad} of {} cannot be used", counted(files.len(), "file")),
            "each file's problems are listed above",
        )),
    }
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn verdict(file: &str, json: bool) -> Verdict {
    let (content, complaints) = match content(file) {
        Ok(found) => found,
        Err(problems) => return bad(file, &problems, json),
    };
    if !json {
        say(&complaints);
    }
    let warnings = complaints.iter().map(complaint).collect();
    Verdict { file: file.to_owned(), ok: true, content, warnings, errors: Vec::new() }
}

/// What is in the file, if this program can use it, and what is suspicious in it.
fn content(file: &str) -> Result<(Option<Content>, Vec<Problem>), Problems> {
    Ok(match io::check(file)? {
        Checked::Robot(robot) => {
            let rows = overview(&robot)?;
            let assumed = assumed(&robot.assumptions());
            let (joints, assumptions, name) = (rows.len(), assumed.len(), robot.name);
            let content = Content { kind: "robot", name, joints, assumptions, assumed, robot: Some(rows) };
            (Some(content), robot.warnings)
        }
        Checked::Scenario(scenario) => {
            supported(&scenario.robot)?;
            let assumed = assumed(&scenario.assumptions);
            let (joints, assumptions, name) = (scenario.robot.joint_count(), assumed.len(), scenario.name);
            let content = Content { kind: "scenario", name, joints, assumptions, assumed, robot: None };
            (Some(content), scenario.warnings)
        }
    })
}

fn assumed(assumptions: &[Assumption]) -> Vec<Assumed> {
    let listed = |Assumption { key, value, note, .. }: &Assumption| Assumed {
        key: key.clone(),
        value: value.clone(),
        note: note.clone(),
    };
    assumptions.iter().map(listed).collect()
}

fn bad(file: &str, problems: &Problems, json: bool) -> Verdict {
    if !json {
        say(problems.iter());
    }
    let (warnings, errors): (Vec<_>, Vec<_>) = problems.iter().partition(|problem| problem.is_warning());
    let complaints = |problems: Vec<&Problem>| problems.into_iter().map(complaint).collect();
    Verdict {
        file: file.to_owned(),
        ok: false,
        content: None,
        warnings: complaints(warnings),
        errors: complaints(errors),
    }
}

fn complaint(problem: &Problem) -> Complaint {
    let (line, column) = problem.line_column().unzip();
    Complaint {
        message: problem.to_string(),
        hint: problem.hint().to_owned(),
        file: problem.file().map(str::to_owned),
        line,
        column,
    }
}
