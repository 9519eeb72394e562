//! `flexure check`: are these files good?

use flexure::feasible::{self, Usage};
use flexure::files::{Assumption, Problem, Problems, Reading};
use flexure::report::{joint_table, usage_table};
use flexure::robot::{JointRow, overview, supported};
use flexure::sampled::{Sampled, not_looked_at, probe};
use flexure::scenario::{self, Checked, Scenario};
use flexure::simulate::preload;
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
    content: Option<Content>,
    warnings: Vec<Complaint>,
    errors: Vec<Complaint>,
    /// Limits that the reference of a good file exceeds, and that its loop is unstable.
    #[serde(skip)]
    exceeded: Vec<Problem>,
}

/// What is in a good file.
#[derive(Serialize)]
struct Content {
    kind: &'static str,
    name: String,
    joints: usize,
    assumptions: usize,
    /// Numbers that no source vouches for.
    assumed: Vec<Assumed>,
    /// The joints, for a robot file.
    #[serde(skip_serializing_if = "Option::is_none")]
    robot: Option<Vec<JointRow>>,
    /// What the reference uses of the limits, for a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<Along>,
    /// Gains that the file leaves to the starting rule, as `[controller]` of a scenario that gives them.
    #[serde(skip_serializing_if = "Option::is_none")]
    starting_gains: Option<String>,
    /// Whether the loop is stable that holds its torque for a control period, for a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    sampled: Option<Sampled>,
}

/// What the reference of a scenario does.
#[derive(Serialize)]
struct Along {
    /// Names of the joints.
    #[serde(skip)]
    joints: Vec<String>,
    /// Whether its clock goes at a speed of its own.
    #[serde(skip)]
    scaled: bool,
    /// Seconds of the reference per second of the run.
    speed: f64,
    /// What it uses of the robot's limits.
    usage: Vec<Usage>,
}

/// A number that no source vouches for.
#[derive(Serialize)]
struct Assumed {
    key: String,
    value: String,
    note: String,
}

pub fn check(files: &[String], reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    let verdicts: Vec<_> = files.iter().map(|file| verdict(file, reading, json)).collect();
    if json {
        print::json(&verdicts)?;
    } else {
        verdicts.iter().try_for_each(show)?;
    }
    let bad = verdicts.iter().filter(|verdict| !verdict.ok && verdict.exceeded.is_empty()).count();
    match bad {
        0 => match verdicts.into_iter().flat_map(|verdict| verdict.exceeded).collect::<Vec<_>>() {
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

/// What is in a file, on the terminal.
fn show(verdict: &Verdict) -> Result<(), Failure> {
    let Some(content) = &verdict.content else { return Ok(()) };
    let Content { kind, name, joints, assumptions, assumed, robot, reference, starting_gains, sampled } =
        content;
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
    Ok(())
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn verdict(file: &str, reading: Reading<'_>, json: bool) -> Verdict {
    let Found { content, warnings, exceeded } = match content(file, reading) {
        Ok(found) => found,
        Err(problems) => return bad(file, &problems, json),
    };
    if !json {
        say(&warnings);
    }
    Verdict {
        file: file.to_owned(),
        ok: exceeded.is_empty(),
        content: Some(content),
        warnings: warnings.iter().map(Complaint::from).collect(),
        errors: exceeded.iter().map(Complaint::from).collect(),
        exceeded,
    }
}

/// What is in a file that this program can use, what is suspicious in it, and which limits its reference exceeds.
struct Found {
    content: Content,
    warnings: Vec<Problem>,
    exceeded: Vec<Problem>,
}

fn content(file: &str, reading: Reading<'_>) -> Result<Found, Problems> {
    match scenario::check(file, reading)? {
        Checked::Robot(robot) => {
            let rows = overview(&robot)?;
            let assumed = assumed(&robot.assumptions());
            let (joints, assumptions, name) = (rows.len(), assumed.len(), robot.name);
            let content = Content {
                kind: "robot",
                name,
                joints,
                assumptions,
                assumed,
                robot: Some(rows),
                reference: None,
                starting_gains: None,
                sampled: None,
            };
            Ok(Found { content, warnings: robot.warnings, exceeded: Vec::new() })
        }
        Checked::Scenario(scenario) => {
            supported(&scenario.robot)?;
            let reference = along(&scenario)?;
            let sampled = probe(&scenario)?;
            let starting_gains = scenario.has_starting_gains().then(|| scenario.controller.to_toml());
            let unstable = sampled.as_ref().and_then(|sampled| sampled.problem(&scenario));
            let beyond = feasible::exceeded(&scenario, &reference.usage);
            let exceeded = unstable.into_iter().chain(beyond).collect();
            let unknown = not_looked_at(&scenario).map(|words| {
                let help = "a longer control_period or less delay; `flexure run` shows what the loop does";
                scenario.places.problem("control_period", "sampled", words, help).warning()
            });
            let warnings =
                scenario.warnings.iter().cloned().chain(preload(&scenario)?).chain(unknown).collect();
            let assumed = assumed(&scenario.assumptions);
            let (joints, assumptions, name) = (scenario.robot.joint_count(), assumed.len(), scenario.name);
            let content = Content {
                kind: "scenario",
                name,
                joints,
                assumptions,
                assumed,
                robot: None,
                reference: Some(reference),
                starting_gains,
                sampled,
            };
            Ok(Found { content, warnings, exceeded })
        }
    }
}

fn along(scenario: &Scenario) -> Result<Along, Problems> {
    Ok(Along {
        joints: scenario.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
        scaled: scenario.time_scaling.is_some(),
        speed: feasible::speed(scenario)?,
        usage: feasible::usage(scenario)?,
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
    let complaints = |problems: Vec<&Problem>| problems.into_iter().map(Complaint::from).collect();
    Verdict {
        file: file.to_owned(),
        ok: false,
        content: None,
        warnings: complaints(warnings),
        errors: complaints(errors),
        exceeded: Vec::new(),
    }
}
